"""The figures of docs/ghosts.md."""
from svg import Panel, legend, of_figure, picture, text

COLOURS = {"moving": "c0", "stationary": "c5", "type 1": "c1", "type 2": "c2", "clutter": "c4", "unknown": "c5"}
REACH = {"x": (-75.0, 75.0), "y": (-32.0, 32.0)}  # m


def dot(panel, point, css, radius):
    return f'<circle class="f{css}" cx="{panel.x(point[0]):.1f}" cy="{panel.y(point[1]):.1f}" r="{radius}"/>'


def inside(point):
    return all(low <= value <= high for value, (low, high) in zip(point, REACH.values()))


def clipped(points):
    """The part of a straight line inside the picture; empty if there is none."""
    (x0, y0), (x1, y1) = points
    begin, end = 0.0, 1.0
    for start, length, (low, high) in ((x0, x1 - x0, REACH["x"]), (y0, y1 - y0, REACH["y"])):
        if abs(length) < 1e-9:
            if not low <= start <= high:
                return []
            continue
        enter, leave = sorted(((low - start) / length, (high - start) / length))
        begin, end = max(begin, enter), min(end, leave)
    if begin >= end:
        return []
    # Rounding may move an end beyond the edge by the last digit, and a panel does not draw such points.
    return [tuple(min(max(value, low), high) for value, (low, high) in
                  zip((x0 + s * (x1 - x0), y0 + s * (y1 - y0)), REACH.values())) for s in (begin, end)]


def marks(panel, points, css, is_correct):
    """Dots of detections; those classified wrongly have a ring."""
    parts = []
    for point in filter(inside, map(tuple, points)):
        parts.append(dot(panel, point, css, 1.6 if css == "c5" else 2.8))
        if not is_correct:
            parts.append(f'<circle class="l a" cx="{panel.x(point[0]):.1f}" cy="{panel.y(point[1]):.1f}" r="5"/>')
    return parts


def plan(curves):
    """View from above: true provenance of the detections, and their classification by each method."""
    views = [("truth", "mirror", "Truth, with the true mirrors (dashed)"),
             ("mirror", "mirror", "Classified by the mirror method, with its estimated reflectors; ring: classified wrongly"),
             ("published", "published", "Classified by the published method, with its estimated reflectors; ring: classified wrongly")]
    parts = [text(20, 24, "highway_multipath: one cycle of four radars from above, m. Ego vehicle at (0, 0), driving to the right", "t"),
             legend([(COLOURS[k] + " own", k) for k in ("moving", "stationary", "type 1", "type 2", "clutter")], 20, 46, 840)]
    top = 90
    for view, method, title in views:
        panel = Panel((50, top, 820, 350), REACH["x"], REACH["y"], title)
        mine = [c for c in curves if c["panel"].split("|")[0] == method]
        for c in mine:
            line = clipped(c["points"]) if c["label"] in ("mirror", "reflector") else []
            if line and c["label"] == ("mirror" if view == "truth" else "reflector"):
                panel.line(line, "c3 d own" if view == "truth" else "c3 own")
            if c["label"] == "object" and all(map(inside, c["points"])):
                panel.line(c["points"], "a")
        panel.line([(-1.0, -0.9), (3.8, -0.9), (3.8, 0.9), (-1.0, 0.9), (-1.0, -0.9)], "a own")
        for c in mine:
            truth = c["panel"].partition("|")[2]
            if truth:
                label = c["label"]
                panel.parts += marks(panel, c["points"], COLOURS[truth if view == "truth" else label],
                                     view == "truth" or truth == label)
        parts += panel.parts
        top += 410
    return picture(890, top - 20, parts)


SOURCES_CSS = {"Le Ba Thanh 2023": "c5", "published": "c2", "mirror": "c0"}
NAMES = {"Le Ba Thanh 2023": "published method, figures of Le Ba Thanh (2023)", "published": "published method, measured here",
         "mirror": "mirror method, measured here"}


def compare_panel(box, title, rows):
    """One group of bars per row."""
    left, top, width, height = box
    panel = Panel(box, (0.0, 100.0), (0.0, 1.0), title)
    # Rows are names, not numbers.
    panel.parts = [p for p in panel.parts if 'text-anchor="end"' not in p]
    y = top + 5
    for what, values in rows.items():
        first = y
        for source, css in SOURCES_CSS.items():
            if source not in values:
                continue
            panel.parts.append(f'<rect class="f{css}" x="{left}" y="{y}" width="{panel.x(values[source]) - left:.1f}" height="10"/>'
                               + text(left + width + 36, y + 9, f"{values[source]:.1f}", "s", "end"))
            y += 12
        panel.parts.append(text(left - 8, (first + y) / 2 + 3, what, "", "end"))
        panel.parts.append(f'<path class="bar" d="M{panel.x(values["bar"]):.1f} {first}V{y - 2}"/>')
        y += 10
    return panel.parts


def compare(curves):
    """One panel per scenario, one group of bars per truth and classification; a red mark is the required value."""
    groups = {}
    for c in curves:
        scenario, what = c["panel"].split("|")
        percent = c["points"][0][1]
        if percent is not None:
            groups.setdefault(scenario, {}).setdefault(what, {})[c["label"]] = percent
    # Ghost types that do not occur in a scenario have a required value only: they are not drawn.
    groups = {name: {what: v for what, v in rows.items() if "mirror" in v} for name, rows in groups.items()}
    parts = [text(20, 24, "Truth → classification, % of each truth, median over drives. Red: required of the mirror method", "t"),
             legend([(css + " own", NAMES[source]) for source, css in SOURCES_CSS.items()], 20, 46, 840)]
    heights = {name: sum(12 * sum(source in v for source in SOURCES_CSS) + 10 for v in rows.values()) for name, rows in groups.items()}
    top = 90
    if "highway_multipath" in groups:
        height = heights["highway_multipath"]
        parts += compare_panel((190, top, 640, height), "highway_multipath", groups["highway_multipath"])
        top += height + 55
    others = sorted(name for name in groups if name != "highway_multipath")
    for i in range(0, len(others), 2):
        pair = others[i:i + 2]
        for column, name in enumerate(pair):
            parts += compare_panel((125 + 440 * column, top, 265, heights[name]), name, groups[name])
        top += max(heights[name] for name in pair) + 55
    return picture(890, top - 20, parts)


def reliability(curves):
    """Reliability diagram: true share of ghosts and clutter against ghost_probability; calibrated on the diagonal."""
    parts = [text(20, 24, "Reliability of ghost_probability: true share of ghosts and clutter, %", "t"),
             legend([("c2", NAMES["published"]), ("c0 own", NAMES["mirror"]), ("bar", "perfectly calibrated")], 20, 46, 840)]
    for i, name in enumerate(dict.fromkeys(c["panel"] for c in curves)):
        panel = Panel((70 + 420 * i, 90, 340, 340), (0.0, 100.0), (0.0, 100.0), name, "ghost_probability, %")
        panel.parts.append(f'<path class="bar" d="M{panel.x(0)} {panel.y(0)}L{panel.x(100)} {panel.y(100)}"/>')
        for c in curves:
            if c["panel"] != name:
                continue
            css = SOURCES_CSS[c["label"]]
            if c["label"] == "mirror":
                panel.line(c["points"], css + " own")
            panel.parts += [dot(panel, p, css, 3.2) for p in c["points"]]
        parts += panel.parts
    return picture(890, 480, parts)


def draw_all(curves, folder):
    """Draws the figures that have curves."""
    folder.mkdir(exist_ok=True)
    for name, draw in {"plan": plan, "compare": compare, "reliability": reliability}.items():
        mine = of_figure(curves, name)
        if mine:
            (folder / f"ghosts_{name}.svg").write_text(draw(mine))
