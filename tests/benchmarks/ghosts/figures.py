"""The figures of docs/ghosts.md."""
from svg import Panel, legend, of_figure, picture, text

CSS = {"without": "c2", "perfect": "c3", "chain": "c0", "published": "c5"}
NAMES = {"without": "without tracks", "perfect": "perfect tracks", "chain": "tracks of the chain", "published": "published method"}
RATIOS = (0.02, 5.0)
ROW = 18  # height of a scenario


def dot(x, y, css, radius=3.2):
    return f'<circle class="f{css}" cx="{x:.1f}" cy="{y:.1f}" r="{radius}"/>'


def panels(curves):
    return list(dict.fromkeys(c["panel"] for c in curves))


def reliability(curves):
    """Share of real detections against the stated probability; calibrated on the diagonal."""
    names = panels(curves)
    width = 80 + 300 * len(names)
    parts = [text(20, 24, "Reliability of the probability of `moving`: real ones among the moving detections, %", "t"),
             legend([(CSS[lane], NAMES[lane]) for lane in CSS if lane != "published"] + [("bar", "perfectly calibrated")], 20, 46,
                    width - 40)]
    for i, name in enumerate(names):
        panel = Panel((60 + 300 * i, 100, 240, 240), (0.0, 100.0), (0.0, 100.0), name, "probability, %")
        panel.parts.append(f'<path class="bar" d="M{panel.x(0):.1f} {panel.y(0):.1f}L{panel.x(100):.1f} {panel.y(100):.1f}"/>')
        for c in curves:
            if c["panel"] == name:
                panel.line(c["points"], CSS[c["label"]])
                panel.parts += [dot(panel.x(x), panel.y(y), CSS[c["label"]]) for x, y in c["points"]]
        parts += panel.parts
    return picture(width, 390, parts)


def brier(curves):
    """Brier score over that of the base rate: a row per scenario, a panel per radar profile."""
    names = panels(curves)
    values = {}
    for c in curves:
        scenario, lane = c["label"].split("|")
        values.setdefault(scenario, {})[c["panel"], lane] = c["points"][0][1]
    height = ROW * len(values)
    width = 170 + 250 * len(names)
    parts = [text(20, 24, "Brier score over that of the base rate, by scenario (logarithmic)", "t"),
             legend([(CSS[lane], NAMES[lane]) for lane in CSS] + [("bar", "base rate")], 20, 46, width - 40)]
    for i, name in enumerate(names):
        panel = Panel((150 + 250 * i, 100, 220, height), RATIOS, (0.0, 1.0), name, "ratio", log_x=True)
        # Rows are names, not numbers.
        panel.parts = [part for part in panel.parts if ('text-anchor="end"' not in part or "ratio" in part)
                       and not (part.startswith('<path class="g"') and f'h{panel.width}"' in part)]
        panel.parts.append(f'<path class="bar" d="M{panel.x(1.0):.1f} 100v{height}"/>')
        for k, (scenario, of) in enumerate(values.items()):
            y = 100 + ROW * (k + 0.5)
            if i == 0:
                parts.append(text(142, y + 4, scenario, "", "end"))
            panel.parts.append(f'<path class="g" d="M{panel.left} {y:.1f}h{panel.width}"/>')
            panel.parts += [dot(panel.x(of[name, lane]), y, CSS[lane]) for lane in CSS if of.get((name, lane)) is not None]
        parts += panel.parts
    return picture(width, 100 + height + 50, parts)


def draw_all(curves, folder):
    """Draws the figures that have curves; yields their names."""
    folder.mkdir(exist_ok=True)
    for name, draw in {"reliability": reliability, "brier": brier}.items():
        mine = of_figure(curves, name)
        if mine:
            (folder / f"ghosts_{name}.svg").write_text(draw(mine))
            yield name
