"""The report and the fit of the ghost filter benchmark, on made results."""
import importlib.machinery
import importlib.util
import json
import pathlib
import sys
import tempfile
import unittest
import xml.etree.ElementTree

ROOM = pathlib.Path(__file__).resolve().parents[1]
sys.path[:0] = [str(ROOM.parent / "common"), str(ROOM)]
import document  # noqa: E402
import figures  # noqa: E402
import results as read  # noqa: E402


def script(name):
    loader = importlib.machinery.SourceFileLoader(name, str(ROOM / name))
    module = importlib.util.module_from_spec(importlib.util.spec_from_loader(name, loader))
    loader.exec_module(module)
    return module


PROBABILITIES = {"name": "profile_ideal", "caption": "any", "header": ["figure", "all drives", "95 % interval", "median drive", "bar", "result"],
                 "rows": [["Brier", "0.500", "0.400–0.600", "0.5", "≤ 0.6", "met"], ["calibration", "0.090", "0.080–0.100", "0.1", "≤ 0.05", "missed"],
                          ["ambiguous", "—", "—", "—", "≥ 0.85", "no data"], ["published", "1.5", "1–2", "1.5", "—", "—"]]}
CELLS = {"name": "highway_cells", "caption": "any", "header": ["truth → label", "Le Ba Thanh 2023", "evidence", "bar", "result"],
         "rows": [["moving → moving", "97.71", "90.00", "≥ 97.71", "missed"]]}
CURVES = [{"figure": "reliability", "panel": "ideal", "label": "chain", "points": [[5, 4], [95, 97]]},
          {"figure": "brier", "panel": "ideal", "label": "tunnel|chain", "points": [[0, 0.2]]},
          {"figure": "brier", "panel": "ideal", "label": "tunnel|published", "points": [[0, None]]}]


class Report(unittest.TestCase):
    def test_verdict_counts_and_names_the_missed_bars(self):
        text = read.verdict([PROBABILITIES, CELLS])
        self.assertTrue(text.startswith("1 of 3 bars met, 1 without data. Missed:\n\n"), text)
        self.assertIn("- profile_ideal: calibration 0.090 (≤ 0.05)\n", text)
        self.assertIn("- highway_cells: moving → moving 90.00 (≥ 97.71)\n", text)
        self.assertEqual(read.verdict([{**CELLS, "rows": []}]), "0 of 0 bars met, 0 without data.\n")

    def test_files_of_all_programs_are_joined(self):
        with tempfile.TemporaryDirectory() as name:
            folder = pathlib.Path(name)
            for i, table in enumerate((PROBABILITIES, CELLS)):
                (folder / f"{i}.json").write_text(json.dumps({"tables": [table], "curves": CURVES[i:i + 1]}))
                (folder / f"{i}.md").write_text(f"<!-- begin: {table['name']} -->\nbody\n<!-- end: {table['name']} -->\n")
            results = read.Results(folder)
        self.assertEqual(results.regions, {"profile_ideal": "body\n", "highway_cells": "body\n"})
        self.assertEqual([len(results.tables), len(results.curves)], [2, 2])

    def test_figures_are_drawn(self):
        with tempfile.TemporaryDirectory() as name:
            drawn = list(figures.draw_all(CURVES, pathlib.Path(name)))
            self.assertEqual(drawn, ["reliability", "brier"])
            for each in drawn:
                xml.etree.ElementTree.parse(pathlib.Path(name) / f"ghosts_{each}.svg")
            self.assertEqual(list(figures.draw_all([], pathlib.Path(name))), [])

    def test_the_page_has_a_place_for_each_table(self):
        marks = {name for name, _ in document.REGION.findall((document.ROOT / "docs" / "ghosts.md").read_text())}
        profiles = ("series_77ghz", "can_cluster", "ideal")
        wanted = {f"{table}_{profile}" for table in ("profile", "others", "scenarios") for profile in profiles}
        wanted |= {"origins", "highway_published", "highway_evidence", "highway_scene", "highway_cells", "ablation", "cost", "cost_bars",
                   "measured", "verdict"}
        self.assertEqual(marks, wanted)


class Fit(unittest.TestCase):
    def test_weights_at_the_end_of_a_profile_are_replaced(self):
        with_weights = script("fit").with_weights
        profile = "name = \"any\"\n\n# Weights of the evidence\n[evidence]\nold = 1\n"
        self.assertEqual(with_weights(profile, "[evidence]\nnew = 2\n"),
                         "name = \"any\"\n\n# Weights of the evidence\n[evidence]\nnew = 2\n")
        self.assertEqual(with_weights("name = \"any\"\n", "[evidence]\n"), "name = \"any\"\n\n# Weights of the evidence\n[evidence]\n")


if __name__ == "__main__":
    unittest.main()
