"""The figures of docs/tracking.md."""
import math

import tables
from results import BASELINES, DEFAULT, PERFECT, TRACKERS, estimate, numbers, ratio_of_means
from svg import Panel, legend, picture, text

CSS = {"pmbm": "c0", "phd": "c2", PERFECT: "c3", "baseline 1+": "c1", "baseline 2+": "c5"}
NAMES = {"pmbm": "pmbm", "phd": "phd", PERFECT: f"{DEFAULT} with true origins", "baseline 1+": "baseline, 1 detection or more",
         "baseline 2+": "baseline, 2 or more"}
WIDTH = 900


def line_css(name):
    return CSS[name] + (" own" if name == DEFAULT else "") + (" d" if name == PERFECT else "")


def names_in(drives):
    return [name for name in (*TRACKERS, PERFECT, *BASELINES) if name in drives.trackers]


def legend_of(names, *more):
    return legend([(line_css(name), NAMES[name]) for name in names] + list(more), 20, 46, WIDTH - 40)


def dot(x, y, css, radius=3.2):
    return f'<circle class="f{css}" cx="{x:.1f}" cy="{y:.1f}" r="{radius}"/>'


def ring(x, y, css):
    return f'<circle class="{css}" fill="none" cx="{x:.1f}" cy="{y:.1f}" r="5.5"/>'


def whisker(x0, y0, x1, y1, css):
    return f'<path class="{css}" d="M{x0:.1f} {y0:.1f}L{x1:.1f} {y1:.1f}"/>'


LEAST_FALSE_TRACKS = 0.02  # the left edge
WITH_INTERVAL = (0.25, 1.0, 2.0, 4.0)


def curve_of(drives, scope, name):
    """[(false tracks, time tracked, low, high)], without the points at which a tracker has no more false tracks to add. Points left of
    the axis stand at its edge."""
    rows = drives.rows("curve", scope, tracker=name)
    column = "tracked %"
    if not rows:
        rows, column = drives.rows("equal", scope, tracker=name), "all %"
    points = {}
    for row in rows:
        tracked = estimate(row[column])
        if tracked:
            points[max(LEAST_FALSE_TRACKS, float(row["reached"]))] = tracked
    return [(x, *points[x]) for x in sorted(points)]


def false_tracks(drives, perfect):
    """Time tracked over false tracks at a time, a panel for each radar profile."""
    is_same = perfect is None or perfect is drives
    names = [name for name in names_in(drives) if is_same or name != PERFECT]
    scopes = drives.scopes
    curves = {scope: {name: curve_of(drives, scope, name) for name in names} for scope in scopes}
    values = [p for of in curves.values() for c in of.values() for p in c]
    has_intervals = any(low < high for _, _, low, high in values)
    high_x = max([8.0] + [p[0] for p in values])
    low_y = 10.0 * math.floor(min(p[2] for p in values) / 10.0)
    parts = [text(20, 24, "Time tracked over false tracks at a time", "t"),
             legend_of(names, *([("a", "95 % interval over objects")] if has_intervals else []))]
    width = (WIDTH - 60) // len(scopes) - 50
    for i, scope in enumerate(scopes):
        panel = Panel((60 + i * (width + 55), 115, width, 330), (LEAST_FALSE_TRACKS, 1.05 * high_x), (low_y, 100.0), f"{scope}: time tracked, %",
                      "false tracks at a time (logarithmic)", log_x=True)
        for value in (0.02, 0.05, 0.25, 0.5, 2.0, 4.0, 8.0):
            x = panel.x(value)
            panel.parts.append(f'<path class="g" d="M{x:.1f} {panel.top}v{panel.height}"/>'
                               + text(x, panel.top + panel.height + 15, f"{value:g}", "s", "middle"))
        for k, name in enumerate(names):
            # Intervals of trackers at the same number would hide each other.
            shift = 2.5 * (k - (len(names) - 1) / 2)
            points = curves[scope][name]
            panel.line([(p[0], p[1]) for p in points], line_css(name))
            for x, tracked, low, high in points:
                # More intervals would hide the curves.
                if round(x, 2) in WITH_INTERVAL or x == points[-1][0]:
                    panel.parts.append(whisker(panel.x(x) + shift, panel.y(low), panel.x(x) + shift, panel.y(high), CSS[name]))
                panel.parts.append(dot(panel.x(x), panel.y(tracked), CSS[name]))
        parts += panel.parts
    return picture(WIDTH, 490, parts)


def existence(drives):
    """Reliability diagram of the existence."""
    names = [name for name in TRACKERS if name in drives.trackers]
    parts = [text(20, 24, "Existence beside the share of track list entries that are at an object", "t"),
             legend_of(names, ("bar", "perfectly calibrated"))]
    scopes = drives.scopes
    for i, scope in enumerate(scopes):
        panel = Panel((60 + i * 420, 100, 340, 340), (0.0, 1.0), (0.0, 100.0), f"{scope}: at an object, %",
                      "existence, mean of each tenth")
        panel.parts.append(whisker(panel.x(0), panel.y(0), panel.x(1), panel.y(100), "bar"))
        for name in names:
            rows = drives.rows("reliability", scope, tracker=name)
            total = sum(int(row["entries"]) for row in rows) or 1
            points = [(numbers(row["mean existence"]), numbers(row["at an object %"]), int(row["entries"]) / total) for row in rows]
            points = [(x[0], y[0], share) for x, y, share in points if x and y]
            panel.line([(x, y) for x, y, _ in points], line_css(name))
            # The area of a dot is the share of the entries.
            panel.parts += [dot(panel.x(x), panel.y(y), CSS[name], max(2.0, 10.0 * math.sqrt(share))) for x, y, share in points]
        parts += panel.parts
    return picture(WIDTH, 485, parts)


def rows_panel(box, limits, title, x_label, groups, required=None, log_x=False):
    """A panel of names: groups are (name, [(css, (figure, low, high), limit, second figure)]), from the top on; limit and second figure may
    be None. `required`: (low, high) of
    accepted values, either may be None. A value beyond the axis is drawn at its end, with the number."""
    left, top, width, height = box
    panel = Panel(box, limits, (0.0, 1.0), title, log_x=log_x)
    # Rows are names, not numbers.
    panel.parts = [part for part in panel.parts if 'text-anchor="end"' not in part and f'h{width}"/>' not in part or 'class="a"' in part]
    if x_label:
        panel.parts.append(text(left + width, top + height + 30, x_label, "s", "end"))
    if required:
        low, high = (edge if edge is not None else limits[k] for k, edge in enumerate(required))
        panel.band(low, high, vertical=True)
        for edge in required:
            if edge is not None:
                panel.parts.append(whisker(panel.x(edge), top, panel.x(edge), top + height, "bar"))
    step = height / max(1, sum(len(entries) + 1 for _, entries in groups))
    y = top + 0.5 * step
    for i, (name, entries) in enumerate(groups):
        if i:
            panel.parts.append(f'<path class="g" d="M{left} {y:.1f}h{width}"/>')
        panel.parts.append(text(left - 8, y + 0.5 * step * len(entries) + 4, name, "", "end"))
        for css, values, most, second in entries:
            y += step
            if most is not None:
                panel.parts.append(f'<path class="bar" d="M{panel.x(most):.1f} {y - 0.6 * step:.1f}v{1.2 * step:.1f}"/>')
            if values is None:
                panel.parts.append(text(left + 6, y + 4, "not measured", "s"))
                continue
            figure, low, high = values
            panel.parts.append(whisker(panel.x(low), y, panel.x(high), y, css + " l"))
            panel.parts.append(dot(panel.x(figure), y, css, 3.8))
            if second is not None:
                panel.parts.append(ring(panel.x(second), y, css))
            if figure > limits[1]:
                panel.parts.append(text(left + width - 8, y + 4, f"{figure:.3g}", "s", "end"))
        y += step
    return panel.parts


# Required of the default tracker; the benchmark states it in its bars.
REQUIRED_INSIDE = (90.0, 98.0)
CAR_LIMITS = {"length m": 1.0, "heading of moving cars °": 5.0, "along m": 0.6, "across m": 0.35}


def errors(drives):
    """Consistency of the position by class, and errors of cars."""
    names = [name for name in names_in(drives) if name != PERFECT]
    scope = drives.whole
    parts = [text(20, 24, f"Errors of position, box and heading, {len(drives.names)} drives", "t"),
             legend_of(names, ("bar", "required of " + DEFAULT))]

    def values(row, column):
        return estimate(row[column]) if row else None

    groups = []
    for of in tables.CLASSES:
        entries = [(CSS[name], values(drives.row("ellipse", scope, tracker=name, **{"class": of}), "inside %"), None, None)
                   for name in names]
        if any(entry[1] for entry in entries):
            groups.append((tables.CLASS_NAMES[of], entries))
    parts += rows_panel((120, 105, 310, 330), (0.0, 100.0), "position errors in the stated 95 % ellipse, %", "", groups, REQUIRED_INSIDE)
    top = 105
    for column, title in tables.CAR_ERRORS.items():
        entries = [(CSS[name], values(drives.row("cars", scope, tracker=name), column), None, None) for name in names]
        most = CAR_LIMITS[column]
        highest = max([most] + [entry[1][2] for entry in entries if entry[1]])
        what, _, unit = title.partition(", ")
        parts += rows_panel((500, top, 370, 52), (0.0, 1.08 * highest), f"{what} of cars within 50 m: rms error, {unit}", "", [("", entries)],
                            (None, most))
        top += 94
    return picture(WIDTH, 475, parts)


LEAST_RATIO = 0.7
TITLES = {"recorded": "recorded", "resampled": "resampled", "hard_highway": "", "made": "made"}


def gospa_rows(results, column, index):
    """(name, entries) of each scenario with an oracle: the trackers, and the reference code where there is one."""
    required = {}
    for bar in results.bars:
        if "ratio to the oracle" in bar["what"]:
            scenario, _, rest = bar["what"].rpartition(", pmbm: ratio to the oracle, ")
            required[bar["group"], scenario, rest] = bar["high"]
    base = column.removeprefix("ratio ")
    for group, title in TITLES.items():
        rows = results.tables.get(group, [])
        for scenario in dict.fromkeys(row["scenario"] for row in rows):
            entries = []
            for row in (row for row in rows if row["scenario"] == scenario):
                most = required.get((group, scenario, base)) if row["tracker"] == "pmbm" else None
                entries.append((CSS.get(row["tracker"], "c4"), estimate(row[column]), most, ratio_of_means(row, index)))
                reference, oracle = numbers(row["reference"]), numbers(row["oracle"])
                if len(reference) == 2 and len(oracle) == 2:
                    entries.append(("c4" if row["tracker"] == "pmbm" else "c5", [reference[index] / oracle[index]] * 3, None, None))
            name = scenario.partition(" targets")[0] + " targets" if group == "made" else scenario
            yield (f"{title}: {name}" if title else name), entries


def gospa(results):
    """GOSPA over the oracle's."""
    parts = [text(20, 24, "Simulated scenarios: GOSPA of a tracker over that of the oracle. 1: no better tracker can be expected", "t"),
             legend([("c0 own", "pmbm"), ("c2", "phd"), ("c4", "reference PMBM code"), ("c5", "reference PHD code"),
                     ("bar", "required of pmbm")], 20, 46, WIDTH - 40),
             text(20, 64, "Dot: median over the seeds, with its 95 % interval. Ring: ratio of the means over the seeds, which a single bad seed moves", "s")]
    left, width = 200, 300
    bottom = 0
    for k, (column, title) in enumerate((("ratio squared", "squared base distance"), ("ratio true", "true base distance"))):
        groups = list(gospa_rows(results, column, k))
        # Both panels have the same rows; their names stand on the left only.
        height = 13 * sum(len(entries) + 1 for _, entries in groups)
        if k:
            groups = [("", entries) for _, entries in groups]
        box = (left + k * (width + 40), 100, width, height)
        one = box[0] + width * Panel.share(1.0, (LEAST_RATIO, 10.0), True)
        parts.append(whisker(one, box[1], one, box[1] + height, "a"))
        parts += rows_panel(box, (LEAST_RATIO, 10.0), f"ratio, {title}", "ratio (logarithmic)", groups, log_x=True)
        ticks = Panel(box, (LEAST_RATIO, 10.0), (0.0, 1.0), "", log_x=True)
        for value in (1.5, 2.0, 3.0, 5.0):
            x = ticks.x(value)
            parts.append(f'<path class="g" d="M{x:.1f} {box[1]}v{height}"/>' + text(x, box[1] + height + 15, f"{value:g}", "s", "middle"))
        bottom = box[1] + height
    return picture(WIDTH, bottom + 45, parts)


def growth(results):
    curves = [c for c in results.curves if c["figure"] == "tracking_growth"]
    highest = 10.0 ** math.ceil(math.log10(max(y for c in curves for _, y in c["points"])))
    lowest = 10.0 ** math.floor(math.log10(min(y for c in curves for _, y in c["points"])))
    panel = Panel((70, 90, 460, 300), (40.0, 600.0), (lowest, highest), "CPU time of a scan, mean, ms", "measurements in a scan (logarithmic)",
                  log_x=True, log_y=True)
    for value in (50.0, 200.0, 350.0, 500.0):
        x = panel.x(value)
        panel.parts.append(f'<path class="g" d="M{x:.1f} {panel.top}v{panel.height}"/>'
                           + text(x, panel.top + panel.height + 15, f"{value:g}", "s", "middle"))
    for curve in curves:
        panel.line(curve["points"], line_css(curve["label"]))
        panel.parts += [dot(panel.x(x), panel.y(y), CSS[curve["label"]]) for x, y in curve["points"]]
    # Proportional to the measurements, through the first point of the first tracker.
    x, y = curves[0]["points"][0]
    panel.line([(x, y), (500.0, y * 500.0 / x)], "a d")
    parts = [text(20, 24, "Made scenario with 3 to 30 targets: growth of the CPU time", "t"),
             legend([(line_css(c["label"]), c["label"]) for c in curves] + [("a d", "proportional")], 20, 46, 520), *panel.parts]
    return picture(560, 435, parts)


def draw_all(results, folder):
    """Draws the figures that have results; yields their names."""
    wanted = []
    if results.drives:
        wanted += [("false_tracks", lambda: false_tracks(results.drives, results.perfect)),
                   ("existence", lambda: existence(results.drives)), ("errors", lambda: errors(results.drives))]
    if any(group in results.tables for group in TITLES):
        wanted.append(("gospa", lambda: gospa(results)))
    if any(c["figure"] == "tracking_growth" for c in results.curves):
        wanted.append(("growth", lambda: growth(results)))
    for name, draw in wanted:
        (folder / f"tracking_{name}.svg").write_text(draw())
        yield name
