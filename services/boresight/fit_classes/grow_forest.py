#!/usr/bin/env python3
"""Grows the forest of the tracker's classes and writes config/services/object_forest.csv.

    services/boresight/fit_classes/grow_forest.py --seed 5000 --drives 40 --scenario-drives 5

Simulates drives of random traffic and of the shipped scenarios by `boresight fit-classes`, for both measured radar
profiles. Of each five seeds, three grow the trees, one gives the exponent, and one judges. Rewrites the generated part
of the tracker's README with the confusion matrices of the judged seeds. Needs scikit-learn (Debian: python3-sklearn).
"""
import argparse
import csv
import pathlib
import subprocess
import sys
from concurrent.futures import ThreadPoolExecutor

import numpy as np
from sklearn.ensemble import RandomForestClassifier

ROOT = pathlib.Path(__file__).resolve().parents[3]
TABLE = ROOT / "config/services/object_forest.csv"
README = ROOT / "services/tracker/README.md"
BEGIN, END = "<!-- begin of the generated part: grow_forest.py -->", "<!-- end of the generated part -->"

CLASSES = ("pedestrian", "two_wheeler", "car", "van", "truck")
PROFILES = ("series_77ghz", "can_cluster")
# Shares of the classes in training. Vans are few on roads, and no class of the bar.
PRIOR = np.array([0.23, 0.23, 0.23, 0.08, 0.23])
TREES, LEAVES, LEAST_TRACKS = 40, 48, 4  # choice: size of the table, and how little a leaf may rest on
SMOOTHING = 1.0      # tracks of the prior that each leaf counts beside its own (Laplace)
NO_HEIGHT_SHARE = 0.5  # of tracks whose height is withheld, as most radars measure none
HEIGHTS = ("height_m", "volume_m3")
LEAST_AGE_S = 1.0    # of judged tracks
LEAST_TRUE_SHARE = 0.8  # of a track's rows at one object: others are no examples
DRIVES_A_CALL, DURATION_S = 10, 20
GROW, CALIBRATE, JUDGE = (0, 1, 2), (3,), (4,)  # seed modulo 5


def simulate(arguments, folder):
    """Tables of features, one for each call of the command. Those that are there are used again."""
    calls = []
    for profile in PROFILES:
        for begin in range(0, arguments.drives, DRIVES_A_CALL):
            calls.append(("random", profile, arguments.seed + begin, min(DRIVES_A_CALL, arguments.drives - begin)))
    names = sorted(file.stem for file in (ROOT / "config/scenarios").glob("*.toml")
                   if "[[body]]" in file.read_text(encoding="utf-8"))
    for name in names if arguments.scenario_drives > 0 else ():
        calls += [(name, profile, arguments.seed, arguments.scenario_drives) for profile in PROFILES]

    def call(of):
        out = folder / ("_".join(map(str, of)) + ".csv")
        if not out.exists():
            scenario, profile, seed, drives = map(str, of)
            subprocess.run([arguments.boresight, "fit-classes", "--vehicle", "demo", "--config", ROOT / "config",
                            "--scenarios", scenario, "--profiles", profile, "--seed", seed, "--drives", drives,
                            "--duration", str(DURATION_S), "--out", out,
                            *(["--tracker", arguments.tracker] if arguments.tracker else [])], check=True)
        return out
    with ThreadPoolExecutor(arguments.jobs) as pool:
        return list(pool.map(call, calls))


class Tracks:
    """Rows of features, each of one track at one time."""

    def __init__(self, files):
        self.numbers, rows = {}, []
        for file in files:
            with open(file, encoding="utf-8") as text:
                lines = []
                for line in text:
                    if line.startswith("# "):
                        key, value = line[2:].strip().split("=")
                        self.numbers[key] = value
                    else:
                        lines.append(line)
            rows += list(csv.DictReader(lines))
        meta = ("profile", "scenario", "seed", "track", "object", "class", "age_s", "detections")
        self.names = [name for name in rows[0] if name not in meta]
        self.features = np.array([[float(row[name] or "nan") for name in self.names] for row in rows])
        self.label = np.array([CLASSES.index(row["class"]) for row in rows])
        self.age = np.array([float(row["age_s"]) for row in rows])
        self.profile = np.array([row["profile"] for row in rows])
        self.is_random = np.array([row["scenario"] == "random" for row in rows])
        self.seed = np.array([int(row["seed"]) for row in rows])
        keys = [(row["profile"], row["scenario"], row["seed"], row["track"]) for row in rows]
        index = {key: i for i, key in enumerate(dict.fromkeys(keys))}
        self.track = np.array([index[key] for key in keys])
        self.keep_pure(np.array([int(row["object"]) for row in rows]))

    def keep_pure(self, objects):
        """Keeps tracks that are at one object for most of their life, and of these the rows at that object."""
        keep = np.zeros(len(self.track), bool)
        for track in np.unique(self.track):
            rows = np.flatnonzero(self.track == track)
            values, counts = np.unique(objects[rows], return_counts=True)
            if counts.max() >= LEAST_TRUE_SHARE * len(rows):
                keep[rows[objects[rows] == values[counts.argmax()]]] = True
        self.take(keep)

    def take(self, rows):
        for name in ("features", "label", "age", "profile", "is_random", "seed", "track"):
            setattr(self, name, getattr(self, name)[rows])

    def of(self, remainders, least_age_s=0.0):
        return np.isin(self.seed % 5, remainders) & (self.age > least_age_s)

    def weights(self, rows, prior):
        """Each track counts once, each class by its share in the prior."""
        weight = np.zeros(len(self.label))
        weight[rows] = 1.0 / np.bincount(self.track[rows])[self.track[rows]]
        for k, share in enumerate(prior):
            of_class = rows & (self.label == k)
            if weight[of_class].sum() > 0.0:
                weight[of_class] *= share / weight[of_class].sum()
        return weight

    def withhold_heights(self):
        random = np.random.default_rng(1)
        withheld = random.uniform(size=self.track.max() + 1) < NO_HEIGHT_SHARE
        for name in HEIGHTS:
            self.features[withheld[self.track], self.names.index(name)] = np.nan


def grow(tracks):
    """Trees, and the value of each feature where it is not known."""
    rows = tracks.of(GROW, 0.25)
    with np.errstate(all="ignore"):
        missing = np.array([np.nanmedian(column) if np.isfinite(column).any() else 0.0 for column in tracks.features[rows].T])
    missing = np.array([float(f"{value:.5g}") for value in missing])
    known = np.where(np.isfinite(tracks.features), tracks.features, missing)
    weight = tracks.weights(rows, PRIOR)
    number = len(np.unique(tracks.track[rows]))
    forest = RandomForestClassifier(TREES, max_leaf_nodes=LEAVES, max_features=6, random_state=1, n_jobs=1,
                                    min_weight_fraction_leaf=LEAST_TRACKS / number)
    forest.fit(known[rows].astype(np.float32), tracks.label[rows], weight[rows] * number)
    return forest, missing, known


def leaf_shares(values, tracks_in_leaf):
    """Thousandths of each class, drawn to the prior by SMOOTHING tracks; they sum to 1000."""
    shares = values / values.sum() * tracks_in_leaf + SMOOTHING * PRIOR
    thousandths = np.floor(1000.0 * shares / shares.sum()).astype(int)
    thousandths[np.argmax(shares)] += 1000 - thousandths.sum()
    return thousandths


class Table:
    """The trees as the product reads them, and their probabilities as the product computes them."""

    def __init__(self, forest, missing, numbers):
        self.missing, self.numbers, self.exponent = missing, numbers, 1.0
        self.forest = forest
        self.leaves = []
        for tree in (each.tree_ for each in forest.estimators_):
            self.leaves.append({node: leaf_shares(tree.value[node][0], tree.weighted_n_node_samples[node])
                                for node in range(tree.node_count) if tree.children_left[node] < 0})

    def mean(self, known):
        sums = np.zeros((len(known), len(CLASSES)))
        for leaves, nodes in zip(self.leaves, self.forest.apply(known.astype(np.float32)).T):
            table = np.zeros((max(leaves) + 1, len(CLASSES)))
            for node, shares in leaves.items():
                table[node] = shares / 1000.0
            sums += table[nodes]
        return sums / len(self.leaves)

    def probabilities(self, known):
        p = np.maximum(self.mean(known), 1e-9) ** self.exponent
        return p / p.sum(axis=1, keepdims=True)

    def calibrate(self, known, label, weight):
        """The exponent of the largest likelihood."""
        mean = np.maximum(self.mean(known), 1e-9)

        def loss(exponent):
            p = mean ** exponent
            p /= p.sum(axis=1, keepdims=True)
            return -(weight * np.log(p[np.arange(len(label)), label])).sum()
        candidates = np.round(np.arange(0.5, 4.0, 0.05), 2)
        self.exponent = float(candidates[np.argmin([loss(each) for each in candidates])])

    def text(self, names, comment):
        lines = [f"# {line}" for line in comment]
        lines += ["version,1", "classes," + ",".join(CLASSES), "prior," + ",".join(f"{1000.0 * share:.0f}" for share in PRIOR)]
        for key, value in {**self.numbers, "exponent": f"{self.exponent:g}"}.items():
            lines.append(f"number,{key},{value}")
        lines += [f"feature,{name},{value:.5g}" for name, value in zip(names, self.missing)]
        for each, leaves in zip(self.forest.estimators_, self.leaves):
            tree = each.tree_
            lines.append("tree")
            stack = [0]
            while stack:
                node = stack.pop()
                if node in leaves:
                    lines.append("leaf," + ",".join(map(str, leaves[node])))
                    continue
                lines.append(f"split,{tree.feature[node]},{tree.threshold[node]:.5g}")
                stack += [tree.children_right[node], tree.children_left[node]]
        return "\n".join(lines + ["end"]) + "\n"


def confusion(tracks, probabilities, rows):
    """Share of the rows of each class that each class is reported for, in percent; vans are shown, but not judged."""
    weight = tracks.weights(rows, np.ones(len(CLASSES)))
    reported = probabilities.argmax(axis=1)
    matrix = np.array([[weight[rows & (tracks.label == a) & (reported == b)].sum() for b in range(len(CLASSES))]
                       for a in range(len(CLASSES))])
    return 100.0 * matrix / np.maximum(matrix.sum(axis=1, keepdims=True), 1e-12)


def balanced_accuracy(matrix):
    return np.mean([matrix[k, k] for k in range(len(CLASSES)) if CLASSES[k] != "van"]) / 100.0


def calibration_error(tracks, probabilities, rows):
    """Largest and mean difference of stated and true shares over bins of 0.1 with at least 2 % of the weight."""
    weight = tracks.weights(rows, PRIOR)
    p = probabilities[rows].ravel()
    hit = (tracks.label[rows][:, None] == np.arange(len(CLASSES))).ravel()
    w = np.repeat(weight[rows], len(CLASSES))
    bins = np.minimum((p * 10).astype(int), 9)
    errors, weights = [], []
    for b in range(10):
        total = w[bins == b].sum()
        if total >= 0.02 * w.sum():
            errors.append(abs((w * p)[bins == b].sum() - (w * hit)[bins == b].sum()) / total)
            weights.append(total)
    return max(errors), float(np.average(errors, weights=weights))


def report(tracks, probabilities, command):
    lines = [BEGIN, "", f"`{command}`; drives of the judged seeds (remainder 4 by 5), tracks older than 1 s of the tracker "
             "`pmbm`. Shares in % of each track's time, mean over tracks.", ""]
    for profile in (each for each in PROFILES if (tracks.profile == each).any()):
        rows = tracks.of(JUDGE, LEAST_AGE_S) & (tracks.profile == profile)
        for kind, some in (("random traffic", rows & tracks.is_random), ("shipped scenarios", rows & ~tracks.is_random)):
            if not some.any():
                continue
            matrix = confusion(tracks, probabilities, some)
            largest, mean = calibration_error(tracks, probabilities, some)
            lines += [f"`{profile}`, {kind}: balanced accuracy {balanced_accuracy(matrix):.2f} without vans; calibration "
                      f"error at most {largest:.2f}, mean {mean:.2f}.", ""]
        matrix = confusion(tracks, probabilities, rows)
        lines += ["Both:", "",
                  "| true \\ reported | " + " | ".join(CLASSES) + " | tracks |", "|---" * (len(CLASSES) + 2) + "|"]
        for k, name in enumerate(CLASSES):
            count = len(np.unique(tracks.track[rows & (tracks.label == k)]))
            lines.append(f"| {name} | " + " | ".join(f"{share:.0f}" for share in matrix[k]) + f" | {count} |")
        lines.append("")
    return "\n".join(lines + [END])


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--boresight", default=ROOT / "build/bin/boresight", help="the program")
    parser.add_argument("--seed", type=int, default=5000, help="seed of the first drive; never one that judges")
    parser.add_argument("--drives", type=int, default=40, help="of random traffic, for each profile")
    parser.add_argument("--scenario-drives", type=int, default=5, help="of each shipped scenario and profile")
    parser.add_argument("--tracker", default="", help="whose tracks are used; default: that of tracker.toml")
    parser.add_argument("--jobs", type=int, default=2, help="drives at a time")
    parser.add_argument("--folder", type=pathlib.Path, default=pathlib.Path("features"), help="for the tables of features; those that are there are used again")
    parser.add_argument("--dry-run", action="store_true", help="print the report, write nothing")
    arguments = parser.parse_args()
    arguments.folder.mkdir(parents=True, exist_ok=True)
    tracks = Tracks(simulate(arguments, arguments.folder))
    tracks.withhold_heights()
    forest, missing, known = grow(tracks)
    table = Table(forest, missing, tracks.numbers)
    rows = tracks.of(CALIBRATE, LEAST_AGE_S)
    table.calibrate(known[rows], tracks.label[rows], tracks.weights(rows, PRIOR)[rows])
    probabilities = table.probabilities(known)
    command = (f"grow_forest.py --seed {arguments.seed} --drives {arguments.drives} "
               f"--scenario-drives {arguments.scenario_drives}")
    text = report(tracks, probabilities, command)
    print(text)
    order = np.argsort(forest.feature_importances_)[::-1]
    print("importance:", ", ".join(f"{tracks.names[i]} {forest.feature_importances_[i]:.3f}" for i in order))
    if arguments.dry_run:
        return 0
    commit = subprocess.run(["git", "rev-parse", "--short", "HEAD"], cwd=ROOT, capture_output=True, text=True, check=False)
    comment = ["Decision forest of the tracker's classes, grown by services/boresight/fit_classes/grow_forest.py.",
               "Do not edit: the numbers belong to the trees.",
               f"Command: {command}", f"Commit: {commit.stdout.strip()}", f"Profiles: {', '.join(PROFILES)}",
               f"Rows of features: {len(tracks.label)} of {len(np.unique(tracks.track))} tracks"]
    TABLE.write_text(table.text(tracks.names, comment), encoding="utf-8")
    readme = README.read_text(encoding="utf-8")
    if BEGIN in readme:
        before, rest = readme.split(BEGIN, 1)
        README.write_text(before + text + rest.split(END, 1)[1], encoding="utf-8")
    return 0


if __name__ == "__main__":
    sys.exit(main())
