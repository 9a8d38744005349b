"""SVG pictures for documents: black on white, plain style classes only, so that every viewer and converter can show them."""
import math

COLOURS = {"c0": "#1f5fbf", "c1": "#c23b4e", "c2": "#d9820f", "c3": "#2e8b57", "c4": "#7d4fa8", "c5": "#7a7a7a"}

# t: title, s: small text, bg: background, g: grid, a: axis, l: line, own: emphasised line, bar: required value,
# ok: range of accepted values, d: dashed; c0 … c5: line colour, fc0 … fc5: fill colour.
STYLE = ("<style>text{font-family:Arial,Helvetica,sans-serif;font-size:12px;fill:#333}.t{font-weight:bold}"
         ".s{font-size:11px;fill:#555}.bg{fill:#fff}.g{stroke:#e3e3e3}.a{stroke:#999}.l{fill:none;stroke-width:1.5}"
         ".own{stroke-width:2.6}.bar{stroke:#b00020;stroke-dasharray:5 4}.ok{fill:#2e8b57;opacity:0.13}"
         ".d{stroke-dasharray:5 3}" + "".join(f".{k}{{stroke:{v}}}.f{k}{{fill:{v}}}" for k, v in COLOURS.items()) +
         "</style>")


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
    """Axes at a position of the picture; values are clipped to the axes."""

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
    """Entries are (css, label); the legend wraps at `width`."""
    parts, x, y = [], left, top
    for css, label in entries:
        needed = 40 + 7.5 * len(label)
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
