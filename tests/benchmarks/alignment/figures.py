"""The figures of docs/alignment.md: SVG that stands alone and follows the reader's light or dark theme."""
import math

METHODS = ["boresight", "nls", "tls", "nelder_mead", "azimuth_1d", "steepest_descent", "boresight_planar"]
NAMES = {"boresight": "Boresight", "boresight_planar": "Boresight, planar rows", "nls": "damped least squares", "tls": "total least squares",
         "nelder_mead": "Nelder–Mead", "azimuth_1d": "1-D reference", "steepest_descent": "steepest descent"}
LIGHT = {"c0": "#1f5fbf", "c1": "#c23b4e", "c2": "#d9820f", "c3": "#2e8b57", "c4": "#7d4fa8", "c5": "#7a7a7a"}
DARK = {"c0": "#6ea8ff", "c1": "#ff8595", "c2": "#ffb454", "c3": "#6fd09b", "c4": "#c79bf2", "c5": "#a8a8a8"}


def css_of(method):
    """Boresight's own stand out; what reproduces the tables only is dashed."""
    if method == "boresight_planar":
        return "c0 own d"
    return f"c{METHODS.index(method)}" + (" own" if method == "boresight" else "")


def rules(colours):
    return "".join(f".{k}{{stroke:{v}}}.f{k}{{fill:{v}}}" for k, v in colours.items())


STYLE = ("<style>text{font:12px system-ui,sans-serif;fill:#333}.t{font-weight:600}.s{font-size:11px;fill:#666}"
         ".bg{fill:#fff}.g{stroke:#e3e3e3}.a{stroke:#999}.l{fill:none;stroke-width:1.5}.own{stroke-width:2.6}"
         ".bar{stroke:#b00020;stroke-dasharray:5 4}.ok{fill:#2e8b57;opacity:.13}.d{stroke-dasharray:5 3}" + rules(LIGHT) +
         "@media(prefers-color-scheme:dark){text{fill:#ddd}.s{fill:#aaa}.bg{fill:#15181c}.g{stroke:#2c3138}"
         ".a{stroke:#777}.bar{stroke:#ff7b8a}.ok{fill:#6fd09b;opacity:.16}" + rules(DARK) + "}</style>")


def escape(text):
    return text.replace("&", "&amp;").replace("<", "&lt;").replace(">", "&gt;")


def text(x, y, what, css="", anchor="start"):
    return f'<text x="{x:.1f}" y="{y:.1f}" class="{css}" text-anchor="{anchor}">{escape(what)}</text>'


def tick_text(value, logarithmic):
    if not logarithmic:
        return f"{value:g}"
    power = round(math.log10(value))
    if -3 <= power <= 4:
        return f"{value:g}"
    return "10" + str(power).translate(str.maketrans("-0123456789", "⁻⁰¹²³⁴⁵⁶⁷⁸⁹"))


class Panel:
    """Axes at a place of the picture; values are clipped to them."""

    def __init__(self, box, x_range, y_range, title, x_label="", log_x=False, log_y=False):
        self.left, self.top, self.width, self.height = box
        self.x_range, self.y_range, self.log_x, self.log_y = x_range, y_range, log_x, log_y
        self.parts = [text(self.left, self.top - 8, title, "t")]
        for value in self.ticks(x_range, log_x):
            x = self.x(value)
            self.parts.append(f'<path class="g" d="M{x:.1f} {self.top}v{self.height}"/>')
            self.parts.append(text(x, self.top + self.height + 15, tick_text(value, log_x), "s", "middle"))
        for value in self.ticks(y_range, log_y):
            y = self.y(value)
            self.parts.append(f'<path class="g" d="M{self.left} {y:.1f}h{self.width}"/>')
            self.parts.append(text(self.left - 6, y + 4, tick_text(value, log_y), "s", "end"))
        self.parts.append(f'<path class="a" fill="none" d="M{self.left} {self.top}v{self.height}h{self.width}"/>')
        if x_label:
            self.parts.append(text(self.left + self.width, self.top + self.height + 30, x_label, "s", "end"))

    @staticmethod
    def ticks(limits, logarithmic):
        low, high = limits
        if logarithmic:
            first, last = math.ceil(math.log10(low) - 1e-9), math.floor(math.log10(high) + 1e-9)
            step = 1 if last - first <= 5 else 2
            return [10.0 ** p for p in range(first, last + 1, step)]
        raw = (high - low) / 5
        unit = 10 ** math.floor(math.log10(raw))
        step = next(m * unit for m in (1, 2, 5, 10) if m * unit >= raw)
        return [round(k * step, 10) for k in range(math.ceil(low / step - 1e-9), math.floor(high / step + 1e-9) + 1)]

    @staticmethod
    def share(value, limits, logarithmic):
        low, high = limits
        if logarithmic:
            value, low, high = math.log10(max(value, 1e-12)), math.log10(low), math.log10(high)
        return min(1.0, max(0.0, (value - low) / (high - low)))

    def x(self, value):
        return self.left + self.width * self.share(value, self.x_range, self.log_x)

    def y(self, value):
        return self.top + self.height * (1 - self.share(value, self.y_range, self.log_y))

    def line(self, points, css):
        kept = [(x, y) for x, y in points if x is not None and y is not None and
                self.x_range[0] <= x <= self.x_range[1]]
        if kept:
            path = "L".join(f"{self.x(x):.1f} {self.y(y):.1f}" for x, y in kept)
            self.parts.append(f'<path class="l {css}" d="M{path}"/>')

    def horizontal(self, value, label):
        y = self.y(value)
        self.parts.append(f'<path class="bar" d="M{self.left} {y:.1f}h{self.width}"/>')
        self.parts.append(text(self.left + self.width, y - 4, label, "s", "end"))

    def band(self, low, high, vertical=False):
        if vertical:
            x = self.x(low)
            self.parts.append(f'<rect class="ok" x="{x:.1f}" y="{self.top}" width="{self.x(high) - x:.1f}" '
                              f'height="{self.height}"/>')
        else:
            y = self.y(high)
            self.parts.append(f'<rect class="ok" x="{self.left}" y="{y:.1f}" width="{self.width}" '
                              f'height="{self.y(low) - y:.1f}"/>')


def legend(entries, left, top, width):
    """Of (css, label); wraps."""
    parts, x, y = [], left, top
    for css, label in entries:
        needed = 34 + 7 * len(label)
        if x + needed > left + width:
            x, y = left, y + 18
        parts.append(f'<path class="l {css}" d="M{x} {y - 4}h22"/>' + text(x + 28, y, label))
        x += needed
    return "".join(parts)


def picture(width, height, parts):
    return (f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 {width} {height}" width="{width}" height="{height}">'
            f'{STYLE}<rect class="bg" width="{width}" height="{height}"/>{"".join(parts)}</svg>\n')


def of_figure(curves, name):
    return [c for c in curves if c["figure"] == name]


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
                      "|error| of " + panel_title, "scans of a radar", True, True)
        for c in sorted(mine, key=lambda c: -METHODS.index(c["label"])):
            panel.line(c["points"], css_of(c["label"]))
        parts += panel.parts
    return picture(880, 640, parts)


def residuals(curves):
    order = [("uncorrected", "c5", "uncorrected"), ("nelder_mead", "c3", "Nelder–Mead"),
             ("boresight", "c0 own", "Boresight"), ("boresight_planar", "c1 d", "Boresight, planar rows")]
    present = [(css, label, c) for key, css, label in order for c in curves if c["label"] == key]
    top = max(y for _, _, c in present for _, y in c["points"])
    parts = [text(20, 24, "Residual of the range rate of stationary detections, published set-up", "t"),
             legend([(css, label) for css, label, _ in present], 20, 46, 840)]
    panel = Panel((70, 90, 770, 250), (-0.6, 0.6), (0.0, 1.05 * top), "density, s/m", "residual, m/s")
    for css, _, curve in present:
        panel.line(curve["points"], css)
    return picture(880, 390, parts + panel.parts)


def knock(curves):
    parts = [text(20, 24, "Median error of the knocked radar about the axis of the knock, °", "t"),
             legend([("c0 own", "clean drives"), ("c1", "disturbed drives")], 20, 46, 840)]
    panels = [p for p in ("1° yaw", "2° pitch", "0.5° yaw", "2° roll") if any(c["panel"] == p for c in curves)]
    for i, name in enumerate(panels):
        mine = [c for c in curves if c["panel"] == name]
        top = max(y for c in mine for _, y in c["points"] if y is not None)
        panel = Panel((70 + 430 * (i % 2), 90 + 250 * (i // 2), 350, 180), (-5.0, 29.0), (0.0, 1.1 * top), name,
                      "seconds since the knock")
        for c in mine:
            panel.line(c["points"], "c0 own" if c["label"] == "clean" else "c1")
        parts += panel.parts
    return picture(880, 100 + 250 * ((len(panels) + 1) // 2), parts)


def honesty(curves):
    kinds = list(dict.fromkeys(c["label"] for c in curves))
    axes = ["k_v", "yaw", "pitch", "roll"]
    height = 22 * len(kinds)
    parts = [text(20, 24, "Honesty of the covariance, by kind of drive; green: as asked; what lies beyond is drawn at the edge", "t"),
             legend([(f"c{i}", name) for i, name in enumerate(axes)], 20, 46, 840)]
    nees = Panel((170, 90, 320, height), (0.25, 8.0), (0.0, float(len(kinds))), "NEES", "", True, False)
    cover = Panel((530, 90, 320, height), (70.0, 100.0), (0.0, float(len(kinds))), "true values in 95 % intervals, %")
    for panel, low, high in ((nees, 0.7, 1.5), (cover, 90.0, 99.0)):
        # Rows are kinds, not numbers.
        panel.parts = [p for p in panel.parts if 'text-anchor="end"' not in p]
        panel.band(low, high, vertical=True)
        if panel is nees:
            for value in (0.25, 0.5, 2.0, 4.0, 8.0):
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
    parts = [text(20, 24, "Roll about the vehicle's axis in the city: error of the worst radar, median over seeds, °", "t"),
             legend([("c0 own", "front radars"), ("c2", "rear radars")], 20, 46, 840)]
    last = max(x for c in curves for x, _ in c["points"])
    panel = Panel((70, 90, 770, 240), (0.0, last), (0.05, 5.0), "|error|, °", "s of the drive", False, True)
    for c in curves:
        panel.line(c["points"], "c0 own" if c["label"] == "front" else "c2")
    panel.horizontal(0.3, "asked after 600 s, front: 0.3°")
    panel.horizontal(0.7, "rear: 0.7°")
    return picture(880, 380, parts + panel.parts)


def false_alarms(curves):
    parts = [text(20, 24, "Without a knock: largest deviation of two blocks in a row in a minute of a radar", "t"),
             legend([("c0 own", "clean drives"), ("c1", "disturbed drives")], 20, 46, 840)]
    panel = Panel((70, 90, 770, 240), (0.0, 1.1), (1e-4, 1.0), "share of minutes beyond",
                  "over what a suspicion needs", False, True)
    for c in curves:
        panel.line([p for p in c["points"] if p[1] > 0], "c0 own" if c["label"] == "clean" else "c1")
    x = panel.x(1.0)
    panel.parts.append(f'<path class="bar" d="M{x:.1f} 90v240"/>' + text(x - 6, 104, "suspicion", "s", "end"))
    return picture(880, 380, parts + panel.parts)


def draw_all(curves, folder):
    """Draws those of which there are curves."""
    folder.mkdir(exist_ok=True)
    drawings = {
        "published": lambda c: convergence(c, "The published set-up, truth by the planar roll model (10)(11)"),
        "published_exact": lambda c: convergence(c, "The published set-up, truth a rotation"),
        "residuals": residuals, "knock": knock, "honesty": honesty, "roll": roll, "false_alarms": false_alarms,
    }
    for name, draw in drawings.items():
        mine = of_figure(curves, name)
        if mine:
            (folder / f"alignment_{name}.svg").write_text(draw(mine))
