"""What the benchmarks of trackers wrote with --json, from all files of a folder."""
import json
import pathlib
import re

ROOT = pathlib.Path(__file__).resolve().parents[3]
DEFAULT = re.search(r'^tracker = "(\w+)"', (ROOT / "config/services/tracker.toml").read_text(), re.M)[1]
PERFECT = "perfect"  # the default tracker with the true origins of the detections
UNFILTERED = "unfiltered"  # the default tracker without what the ghost filter says
TRACKERS = (DEFAULT, *(name for name in ("pmbm", "phd") if name != DEFAULT))
BASELINES = ("baseline 1+", "baseline 2+")
POOLED = "pooled"
NUMBER = re.compile(r"-?\d+(?:\.\d+)?(?:e[+-]?\d+)?")

# A column that only this kind of table of tracking_drives has.
KINDS = {"equal": "score", "curve": "tracked %", "differences": "difference", "fixed": "tracks", "reliability": "mean existence",
         "ellipse": "inside %", "cars": "along m", "times": "largest"}


def numbers(text):
    """All numbers of a cell: a figure, or a figure with the ends of its interval."""
    return [float(n) for n in NUMBER.findall(text)]


def estimate(text):
    """(figure, low, high) of a cell; None if it has no figure. Without an interval, the ends are the figure."""
    found = numbers(text)
    return (found + found[:1] * 2)[:3] if found else None


def ratio_of_means(row, base):
    """GOSPA over the oracle's, both means over all runs, of a row of tracking_scenarios. base: 0 squared, 1 true. None for one run: it is
    the ratio itself."""
    own, oracle = numbers(row["GOSPA squared / true"]), numbers(row["oracle"])
    return own[base] / oracle[base] if len(own) == 2 and len(oracle) == 2 and row["runs"] != "1" else None


class Drives:
    """Files of tracking_drives about the same drives, as one: {(kind, scope): [row by column]}."""

    def __init__(self, names):
        self.names, self.tables, self.bars = names, {}, []

    def take(self, content):
        for table in content["tables"]:
            kind = next((k for k, column in KINDS.items() if column in table["header"]), None)
            scope, _, rest = table["caption"].removeprefix("[").partition("] ")
            rows = [dict(zip(table["header"], row)) for row in table["rows"]]
            if kind == "reliability":
                rows = [{"tracker": rest.partition(":")[0], **row} for row in rows]
            mine = self.tables.setdefault((kind, scope), [])
            mine += self.new_rows(rows, {row["tracker"] for row in mine})
        self.bars += self.new_rows(content["bars"], {bar["tracker"] for bar in self.bars})

    @staticmethod
    def new_rows(rows, known):
        """Those of trackers that are not known yet. "default" is the tracker of the shipped configuration."""
        has_default = any(row["tracker"] == "default" for row in rows)
        rows = [row for row in rows if not (has_default and row["tracker"] == DEFAULT)]
        rows = [{**row, "tracker": DEFAULT if row["tracker"] == "default" else row["tracker"]} for row in rows]
        return [row for row in rows if row["tracker"] not in known]

    @property
    def scopes(self):
        """Radar profiles."""
        return [s for s in dict.fromkeys(scope for _, scope in self.tables) if s != POOLED]

    @property
    def whole(self):
        """The scope of all drives."""
        return POOLED if ("equal", POOLED) in self.tables else self.scopes[0]

    def rows(self, kind, scope, **wanted):
        return [row for row in self.tables.get((kind, scope), []) if all(row[k] == v for k, v in wanted.items())]

    def row(self, kind, scope, **wanted):
        return next(iter(self.rows(kind, scope, **wanted)), None)

    @property
    def trackers(self):
        return list(dict.fromkeys(row["tracker"] for row in self.tables.get(("equal", self.whole), [])))


class Results:
    """drives: those with the most trackers. perfect: those with perfect origins. Either may be None. bars, tables, curves: of
    the other benchmarks, which write them in one form."""

    def __init__(self, folder):
        by_drives, self.bars, self.tables, self.curves = {}, [], {}, []
        for file in sorted(folder.rglob("*.json")):
            content = json.loads(file.read_text())
            if not isinstance(content, dict):
                continue
            if "drives" in content and "tables" in content:
                by_drives.setdefault(tuple(content["drives"]), Drives(content["drives"])).take(content)
            elif "curves" in content:
                self.bars += content["bars"]
                self.curves += content["curves"]
                for table in content["tables"]:
                    self.tables[table["name"]] = [dict(zip(table["header"], row)) for row in table["rows"]]
        judged = [d for d in by_drives.values() if d.tables]
        self.drives = max(judged, key=lambda d: (len(set(TRACKERS) & set(d.trackers)), len(d.names)), default=None)
        with_perfect = [d for d in judged if PERFECT in d.trackers]
        self.perfect = self.drives if self.drives in with_perfect else next(iter(with_perfect), None)

    def missing(self):
        """What a whole report needs and no file has."""
        if self.drives is None:
            yield "tracking_drives: no result"
        else:
            absent = [name for name in (*TRACKERS, *BASELINES) if name not in self.drives.trackers]
            yield from (f"tracking_drives: no tracker {name} on the same drives" for name in absent)
            if ("curve", self.drives.whole) not in self.drives.tables:
                yield "tracking_drives: no curve of the time tracked; points without intervals instead"
        if self.perfect is None:
            yield "tracking_drives: no tracker perfect"
        for name in ("recorded", "resampled", "hard_highway", "split_merge", "made", "growth"):
            if name not in self.tables:
                yield f"tracking_scenarios: no group {name}"
        if not any(bar["group"] == "weak_car" for bar in self.bars):
            yield "tracking_effects: no result"
