"""The figures of docs/alignment.md."""
from svg import Panel, legend, of_figure, picture, text

METHODS = ["boresight", "nls", "tls", "nelder_mead", "azimuth_1d", "steepest_descent", "boresight_planar"]
NAMES = {"boresight": "Boresight", "boresight_planar": "Boresight, planar model", "nls": "damped least squares", "tls": "total least squares",
         "nelder_mead": "Nelder–Mead", "azimuth_1d": "1-D reference", "steepest_descent": "steepest descent"}


def css_of(method):
    """Boresight's own methods are drawn thicker; the one that only reproduces the published tables is dashed."""
    if method == "boresight_planar":
        return "c0 own d"
    return f"c{METHODS.index(method)}" + (" own" if method == "boresight" else "")


def convergence(curves, title):
    titles = {"k_v": "k_v", "α": "yaw α, °", "β": "pitch β, °", "γ": "roll γ, °"}
    parts = [text(20, 24, title, "t")]
    present = [m for m in METHODS if any(c["label"] == m for c in curves)]
    parts.append(legend([(css_of(m), NAMES[m]) for m in present], 20, 46, 840))
    for i, (name, panel_title) in enumerate(titles.items()):
        mine = [c for c in curves if c["panel"] == name]
        y_range = (1e-6, 2e-2) if name == "k_v" else (1e-3, 5.0)
        last = max(x for c in mine for x, _ in c["points"])
        panel = Panel((70 + 430 * (i % 2), 110 + 270 * (i // 2), 350, 200), (1, last), y_range,
                      "|error| of " + panel_title, "scans per radar", True, True)
        for c in sorted(mine, key=lambda c: -METHODS.index(c["label"])):
            panel.line(c["points"], css_of(c["label"]))
        parts += panel.parts
    return picture(880, 640, parts)


def residuals(curves):
    order = [("uncorrected", "c5", "uncorrected"), ("nelder_mead", "c3", "Nelder–Mead"),
             ("boresight", "c0 own", "Boresight"), ("boresight_planar", "c1 d", "Boresight, planar model")]
    present = [(css, label, c) for key, css, label in order for c in curves if c["label"] == key]
    top = max(y for _, _, c in present for _, y in c["points"])
    parts = [text(20, 24, "Range-rate residual of stationary detections, published set-up", "t"),
             legend([(css, label) for css, label, _ in present], 20, 46, 840)]
    panel = Panel((70, 90, 770, 250), (-0.6, 0.6), (0.0, 1.05 * top), "density, s/m", "residual, m/s")
    for css, _, curve in present:
        panel.line(curve["points"], css)
    return picture(880, 390, parts + panel.parts)


def step_change(curves):
    parts = [text(20, 24, "Step change of one radar: its median error about the axis of the change, °", "t"),
             legend([("c0 own", "clean drives"), ("c1", "disturbed drives")], 20, 46, 840)]
    panels = [p for p in ("1° yaw", "2° pitch", "0.5° yaw", "2° roll") if any(c["panel"] == p for c in curves)]
    for i, name in enumerate(panels):
        mine = [c for c in curves if c["panel"] == name]
        top = max(y for c in mine for _, y in c["points"] if y is not None)
        panel = Panel((70 + 430 * (i % 2), 90 + 250 * (i // 2), 350, 180), (-5.0, 29.0), (0.0, 1.1 * top), name,
                      "seconds since the step change")
        for c in mine:
            panel.line(c["points"], "c0 own" if c["label"] == "clean" else "c1")
        parts += panel.parts
    return picture(880, 100 + 250 * ((len(panels) + 1) // 2), parts)


def consistency(curves):
    kinds = list(dict.fromkeys(c["label"] for c in curves))
    axes = ["k_v", "yaw", "pitch", "roll"]
    height = 22 * len(kinds)
    parts = [text(20, 24, "Consistency of the stated σ by kind of drive; green: required range; values beyond are drawn at the edge", "t"),
             legend([(f"c{i}", name) for i, name in enumerate(axes)], 20, 46, 840)]
    nees = Panel((170, 90, 320, height), (0.05, 8.0), (0.0, float(len(kinds))), "NEES", "", True, False)
    cover = Panel((530, 90, 320, height), (70.0, 100.0), (0.0, float(len(kinds))), "true values inside the 95 % interval, %")
    for panel, low, high in ((nees, 0.5, 1.5), (cover, 90.0, 99.0)):
        # Rows are kinds of drive, without a numeric axis.
        panel.parts = [p for p in panel.parts if 'text-anchor="end"' not in p]
        panel.band(low, high, vertical=True)
        if panel is nees:
            for value in (0.05, 0.2, 0.5, 2.0, 4.0, 8.0):
                panel.parts.append(text(panel.x(value), panel.top + height + 15, f"{value:g}", "s", "middle"))
    for row, kind in enumerate(kinds):
        y = 90 + 22 * row + 14
        parts.append(text(160, y + 2, kind, "", "end"))
        for c in curves:
            if c["label"] != kind:
                continue
            i = axes.index(c["panel"])
            (value, covered), = c["points"]
            for panel, v in ((nees, value), (cover, covered)):
                at = y - 8 + 4 * i
                panel.parts.append(f'<circle class="fc{i}" cx="{panel.x(v):.1f}" cy="{at}" r="3.6"/>')
    return picture(880, 90 + height + 30, parts + nees.parts + cover.parts)


def roll(curves):
    parts = [text(20, 24, "Roll about the vehicle's x axis in the city: error of the worst radar, median over seeds, °", "t"),
             legend([("c0 own", "front radars"), ("c2", "rear radars")], 20, 46, 840)]
    last = max(x for c in curves for x, _ in c["points"])
    panel = Panel((70, 90, 770, 240), (0.0, last), (0.05, 5.0), "|error|, °", "seconds of driving", False, True)
    for c in curves:
        panel.line(c["points"], "c0 own" if c["label"] == "front" else "c2")
    panel.horizontal(0.7, "required after 600 s, rear radars: 0.7°")
    # Below its line: the curve of the rear radars is above it.
    y = panel.y(0.3)
    panel.parts.append(f'<path class="bar" d="M{panel.left} {y:.1f}h{panel.width}"/>' +
                       text(panel.left + panel.width, y + 13, "required after 600 s, front radars: 0.3°", "s", "end"))
    return picture(880, 380, parts + panel.parts)


def draw_all(curves, folder):
    """Draws every figure for which there are curves."""
    folder.mkdir(exist_ok=True)
    drawings = {
        "published": lambda c: convergence(c, "Published set-up, truth: planar roll model (10)(11)"),
        "published_exact": lambda c: convergence(c, "Published set-up, truth: a rotation"),
        "residuals": residuals, "step_change": step_change, "consistency": consistency, "roll": roll,
    }
    for name, draw in drawings.items():
        mine = of_figure(curves, name)
        if mine:
            (folder / f"alignment_{name}.svg").write_text(draw(mine))
