"""The report of the trackers, on made results."""
import json
import pathlib
import re
import sys
import tempfile
import unittest
import xml.etree.ElementTree

ROOM = pathlib.Path(__file__).resolve().parents[1]
sys.path[:0] = [str(ROOM.parent / "common"), str(ROOM)]
import document  # noqa: E402
import figures  # noqa: E402
import results as read  # noqa: E402
import tables  # noqa: E402


def table(scope, caption, header, rows):
    return {"group": "tracked", "name": "any", "caption": f"[{scope}] {caption}", "header": header, "rows": rows}


def drives(trackers, names=("series_77ghz/junction_7_15s",), with_curve=True):
    """What tracking_drives writes, with one row for each tracker."""
    scope, content = "series_77ghz", []
    content.append(table(scope, "equal", ["tracker", "false tracks", "reached", "duplicates", "score", "all %"],
                         [[name, n, "0.90", "0.10", "≥ 0.5", "60.0"] for n in ("1", "2", "4") for name in trackers]))
    if with_curve:
        content.append(table(scope, "curve", ["tracker", "false tracks", "reached", "tracked %"],
                             [[name, n, "0.900", "61.0 (50.0 … 70.0)"] for n in ("1", "2", "4") for name in trackers]))
    content.append(table(scope, "difference", ["tracker", "false tracks", "class", "objects", "difference"],
                         [[name, "1", of, "3", "-1.0 (-2.0 … 0.5)"] for of in ("all", "car") for name in trackers]))
    for name in trackers:
        content.append(table(scope, f"{name}: existence", ["existence", "entries", "mean existence", "at an object %"],
                             [["0.0 … 0.1", "90", "0.050", "4.0"], ["0.9 … 1.0", "0", "—", "—"]]))
    return {"drives": list(names), "bars": [], "tables": content}


def read_all(*contents):
    with tempfile.TemporaryDirectory() as name:
        for i, content in enumerate(contents):
            (pathlib.Path(name) / f"{i}.json").write_text(json.dumps(content))
        return read.Results(pathlib.Path(name))


class ReportTest(unittest.TestCase):
    def test_the_default_tracker_has_its_name(self):
        self.assertEqual(read_all(drives(["default", "phd"])).drives.trackers, [read.DEFAULT, "phd"])

    def test_files_about_the_same_drives_are_joined(self):
        results = read_all(drives(["default"]), drives(["phd"]))
        self.assertEqual(set(results.drives.trackers), {read.DEFAULT, "phd"})
        others = read_all(drives(["default"]), drives(["phd"], ("series_77ghz/junction_8_15s",)))
        self.assertEqual(len(others.drives.trackers), 1)

    def test_a_missing_tracker_is_named(self):
        results = read_all(drives(["default", "baseline 1+"]))
        missing = " ".join(results.missing())
        for what in ("tracker phd", "tracker baseline 2+", "perfect", "group recorded", "tracking_effects"):
            self.assertIn(what, missing)
        self.assertIn("not measured", tables.all_trackers(results))

    def test_negative_numbers_have_the_sign_of_a_minus(self):
        self.assertIn("−1.0 (−2.0 … 0.5)", tables.differences(read_all(drives(["default"])).drives))
        self.assertEqual(tables.with_minus("xia_c30-2, 1.0–2.0, -3"), "xia_c30-2, 1.0–2.0, −3")

    def test_the_ratio_of_means_shows_a_bad_seed(self):
        row = {"GOSPA squared / true": "3.000 / 2.000", "oracle": "1.500 / 1.600", "runs": "8"}
        self.assertEqual(read.ratio_of_means(row, 0), 2.0)
        self.assertEqual(read.ratio_of_means(row, 1), 1.25)
        self.assertIsNone(read.ratio_of_means({**row, "runs": "1"}, 0))
        self.assertIsNone(read.ratio_of_means({**row, "oracle": "—"}, 0))

    def test_figures_are_drawn_of_what_there_is(self):
        for with_curve in (True, False):
            results = read_all(drives(["default", "phd"], with_curve=with_curve))
            with tempfile.TemporaryDirectory() as name:
                drawn = list(figures.draw_all(results, pathlib.Path(name)))
                self.assertEqual(drawn, ["false_tracks", "existence", "errors"])
                for file in pathlib.Path(name).iterdir():
                    xml.etree.ElementTree.parse(file)

    def test_the_page_shows_every_table_and_figure(self):
        page = (read.ROOT / "docs" / "tracking.md").read_text()
        marks = {name for name, _ in document.REGION.findall(page)}
        script = (ROOM / "report").read_text()
        self.assertEqual(marks, {a or b for a, b in re.findall(r'"(\w+)": (?:tables\.|measured)|regions\["(\w+)"\]', script)})
        for name in re.findall(r'"(\w+)", lambda: ', (ROOM / "figures.py").read_text()):
            self.assertIn(f"figures/tracking_{name}.svg", page)


if __name__ == "__main__":
    unittest.main()
