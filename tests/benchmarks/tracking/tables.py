"""The tables of docs/tracking.md."""
import re

from results import BASELINES, DEFAULT, PERFECT, TRACKERS, UNFILTERED, ratio_of_means

EVERY = (*TRACKERS, *BASELINES)
NOT_MEASURED, DOES_NOT_APPLY = "not measured", "—"
CLASSES = ("car", "truck", "two_wheeler", "pedestrian")
CLASS_NAMES = {"car": "cars", "truck": "trucks", "two_wheeler": "two-wheelers", "pedestrian": "pedestrians"}
FALSE_TRACKS = ("1", "2", "4")
CAR_ERRORS = {"length m": "length, m", "heading of moving cars °": "heading, °", "along m": "position along, m", "across m": "position across, m"}
SCENARIO_GROUPS = ("recorded", "resampled", "hard_highway", "made")
EFFECT_GROUPS = ("weak_car", "side_lobes", "wide_rms")
LIKELY, SURE, CONFIRMED = "existence ≥ 0.5", "existence ≥ 0.9", "confirmed"


def markdown(header, rows):
    lines = [header, ["---"] * len(header), *rows]
    return "".join("| " + " | ".join(cell.replace("|", "\\|") for cell in line) + " |\n" for line in lines)


def with_minus(text):
    """Negative numbers with the sign of a minus."""
    return re.sub(r"(?<![\w–])-(?=\d)", "−", text)


def cell(row, column):
    return with_minus(row[column]) if row else NOT_MEASURED


def of_errors(name):
    """Which tracks errors are judged on."""
    return CONFIRMED if name in BASELINES else LIKELY


def drive_rows(drives):
    """Rows of the table of all trackers: title, and a cell for each tracker."""
    scope = drives.whole

    def line(title, text_of):
        return [title, *(text_of(name) if name in drives.trackers else NOT_MEASURED for name in EVERY)]

    def tracked(name, wanted):
        row = drives.row("curve", scope, tracker=name, **{"false tracks": wanted})
        if row is None:
            row = drives.row("equal", scope, tracker=name, **{"false tracks": wanted})
        return f"{row.get('tracked %') or row['all %']} at {float(row['reached']):.2f}"

    def fixed(name, rule):
        row = drives.row("fixed", scope, tracker=name, tracks=rule)
        return f"{row['all %']} / {row['false tracks']} / {row['duplicates']}" if row else DOES_NOT_APPLY

    def at_an_object(name):
        found = [bar["shown"].partition(" %")[0] for bar in drives.bars
                 if bar["tracker"] == name and bar["scope"] == scope and bar["group"] == "existence"]
        return " / ".join(found) if found else DOES_NOT_APPLY

    def inside(name, of):
        row = drives.row("ellipse", scope, tracker=name, **{"class": of})
        return row["inside %"] if row else NOT_MEASURED

    def time(name):
        row = drives.row("times", scope, tracker=name)
        return f"{row['median']} / {row['largest']}" if row else DOES_NOT_APPLY if name in BASELINES else NOT_MEASURED

    yield from (line(f"time tracked with up to {n} false {'track' if n == '1' else 'tracks'} at a time, %", lambda name, n=n: tracked(name, n)) for n in FALSE_TRACKS)
    yield from (line(f"{rule}: time tracked % / false tracks / duplicates", lambda name, rule=rule: fixed(name, rule))
                for rule in (LIKELY, SURE, CONFIRMED))
    yield line("entries with existence ≥ 0.9 / ≥ 0.5 that are at an object, %", at_an_object)
    yield from (line(f"{CLASS_NAMES[of]}: position errors in the 95 % ellipse, %", lambda name, of=of: inside(name, of)) for of in CLASSES)
    yield from (line(f"cars within 50 m, rms error: {title}",
                     lambda name, c=column: cell(drives.row("cars", scope, tracker=name), c)) for column, title in CAR_ERRORS.items())
    yield line("CPU time of a scan, ms: median / largest of the drives' means", time)


def scenario_rows(results):
    """The same of the scenarios; the baselines need detections of radars."""

    def line(title, rows, text_of):
        found = {row["tracker"]: text_of(row) for row in rows}
        return [title, *(DOES_NOT_APPLY if name in BASELINES else found.get(name, NOT_MEASURED) for name in EVERY)]

    def ratio(row):
        means = ratio_of_means(row, 0)
        return row["ratio squared"] + (f", means {means:.3f}" if means else "")

    for group in SCENARIO_GROUPS:
        rows = results.tables.get(group)
        if rows is None:
            yield line(f"GOSPA over the oracle's, {group}", [], str)
            continue
        for scenario in dict.fromkeys(row["scenario"] for row in rows):
            mine = [row for row in rows if row["scenario"] == scenario]
            yield line(f"GOSPA over the oracle's, {group}: {scenario}", mine, ratio)
    rows = results.tables.get("split_merge", [])
    first = rows[:1] and rows[0]["scenario"]
    yield line("five targets that merge and split: GOSPA, true base / lost targets", [r for r in rows if r["scenario"] == first],
               lambda row: f"{row['GOSPA squared / true'].partition(' / ')[2]} / {row['lost targets']}")
    recorded = results.tables.get("recorded", [])
    last = recorded[-1:] and recorded[-1]["scenario"]
    yield line(f"CPU time of a scan, ms: mean / worst{f', recorded: {last}' if last else ''}",
               [row for row in recorded if row["scenario"] == last], lambda row: row["CPU mean / worst ms"])
    largest = {row["tracker"]: row for row in results.tables.get("growth", [])}
    yield line("CPU time of a scan with 500 measurements, ms", largest.values(), lambda row: row["CPU mean ms"])


def all_trackers(results):
    rows = []
    if results.drives:
        rows += [["**drives**", *[""] * len(EVERY)], *drive_rows(results.drives)]
    if results.tables:
        rows += [["**scenarios**", *[""] * len(EVERY)], *scenario_rows(results)]
    return markdown(["figure", *(f"`{name}`" if name in TRACKERS else name for name in EVERY)], rows)


def differences(drives):
    rows = []
    for scope in (*drives.scopes, *([drives.whole] if drives.whole not in drives.scopes else [])):
        for name in TRACKERS:
            for wanted in FALSE_TRACKS:
                mine = {row["class"]: row for row in drives.rows("differences", scope, tracker=name, **{"false tracks": wanted})}
                if mine:
                    rows.append([scope, f"`{name}`", wanted, *(cell(mine.get(of), "difference") for of in ("all", *CLASSES))])
    counts = {row["class"]: row["objects"] for row in drives.rows("differences", drives.whole, tracker=TRACKERS[0])}
    header = ["radars", "tracker", "false tracks", *(f"{of} ({counts.get(of, '0')})" for of in ("all", *CLASSES))]
    return ("*Time tracked, difference to the better baseline at the same number of false tracks at a time, points (95 % interval, "
            "paired). In parentheses of the title: number of objects.*\n\n" + markdown(header, rows))


def origins(drives):
    rows = []
    for rule in (LIKELY, SURE, CONFIRMED):
        for name, of in ((UNFILTERED, "none"), (DEFAULT, "ghost filter"), (PERFECT, "true")):
            row = drives.row("fixed", drives.whole, tracker=name, tracks=rule)
            if row:
                rows.append([rule, of, row["false tracks"], row["all %"],
                             *(row[f"{of} %"] for of in CLASSES)])
    times = [(name, drives.row("times", drives.whole, tracker=name)) for name in (DEFAULT, PERFECT)]
    lines = [f"{'true origins' if name == PERFECT else 'ghost filter'}: mean {row['mean']}, p99 {row['p99']}"
             for name, row in times if row and "p99" in row]
    return (f"*`{DEFAULT}`, {len(drives.names)} drives.*\n\n"
            + markdown(["tracks", "origins", "false tracks", "time tracked %", *(f"{CLASS_NAMES[of]} %" for of in CLASSES)], rows)
            + (f"\nCPU time of a scan, ms, over all scans: {'; '.join(lines)}.\n" if lines else ""))


def errors(drives):
    rows = []
    for scope in (*drives.scopes, *([drives.whole] if drives.whole not in drives.scopes else [])):
        for name in EVERY:
            car = drives.row("cars", scope, tracker=name)
            ellipse = {row["class"]: row for row in drives.rows("ellipse", scope, tracker=name)}
            if car or ellipse:
                rows.append([scope, name, *(cell(ellipse.get(of), "inside %") for of in CLASSES),
                             *(cell(car, column) for column in CAR_ERRORS)])
    return markdown(["radars", "tracker", *(f"{CLASS_NAMES[of]} in ellipse %" for of in CLASSES), *CAR_ERRORS.values()], rows)


def scenarios(results):
    """The tables of all groups that have GOSPA, as one."""
    columns = ["scenario", "tracker", "runs", "GOSPA squared / true", "oracle", "ratio squared", "ratio true", "reference", "lost targets",
               "CPU mean / worst ms"]
    rows = [[group, *(row.get(column, DOES_NOT_APPLY) for column in columns)]
            for group in (*SCENARIO_GROUPS, "split_merge") for row in results.tables.get(group, [])]
    return markdown(["group", *columns], rows)


def growth(results):
    rows = results.tables["growth"]
    return markdown(list(rows[0]), [list(row.values()) for row in rows])


def short(value):
    return "—" if value is None else f"{value:.3g}" if abs(value) < 999.5 else f"{value:.0f}"


def limit(bar):
    low, high = bar["low"], bar["high"]
    return f"≤ {short(high)}" if low is None else f"≥ {short(low)}" if high is None else f"{short(low)}–{short(high)}"


def effects(results):
    rows = []
    for bar in results.bars:
        if bar["group"] in EFFECT_GROUPS:
            unit = " " + bar["unit"] if bar["unit"] else ""
            # No figure: there was no such track.
            shown = "never" if bar["figure"] is None else short(bar["figure"]) + unit
            rows.append([bar["what"], bar["how"], shown, "—" if bar["pass"] is None else limit(bar) + unit, result(bar["pass"])])
    return markdown(["figure", "tracks", "measured", "required", "result"], rows)


def result(is_met):
    return {True: "met", False: "**missed**", None: "—"}[is_met]


def all_bars(results):
    """(group, tracker, what, shown, required, whether it is met) of every bar of the default tracker on all drives, and of every
    other benchmark."""
    of_drives = []
    for drives in (results.drives, results.perfect):
        of_drives += [bar for bar in drives.bars if bar["scope"] == drives.whole] if drives else []
    seen = set()
    for bar in of_drives:
        key = (bar["tracker"], bar["what"])
        if bar["tracker"] in (DEFAULT, PERFECT) and key not in seen and (bar["tracker"] == PERFECT or bar in results.drives.bars):
            seen.add(key)
            yield "drives: " + bar["group"], bar["tracker"], bar["what"], bar["shown"], bar["limit"], bar["met"]
    for bar in results.bars:
        if bar["pass"] is not None:
            unit = " " + bar["unit"] if bar["unit"] else ""
            shown = "never" if bar["figure"] is None else short(bar["figure"]) + unit
            is_effect = bar["group"] in EFFECT_GROUPS
            yield ("effects: " if is_effect else "scenarios: ") + bar["group"], "", bar["what"], shown, limit(bar) + unit, bar["pass"]


def bars(results):
    rows, last = [], None
    for group, tracker, what, shown, required, is_met in all_bars(results):
        rows.append(["" if group == last else group, f"{what}, {tracker} origins" if tracker == PERFECT else what, with_minus(shown), required,
                     result(is_met)])
        last = group
    return markdown(["group", "figure", "measured", "required", "result"], rows)


def verdict(results):
    judged = [is_met for *_, is_met in all_bars(results)]
    return f"{sum(judged)} of {len(judged)} bars are met.\n"
