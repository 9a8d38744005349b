#!/usr/bin/env python3
"""Each rule of tidy.py finds what it is for, and finds nothing in a sound tree."""
import pathlib
import tempfile
import unittest

import tidy

SOUND = {
    "interfaces/messages/a.hpp": "struct A {\n  float range_m;\n  float inlier_ratio;\n};\n",
    "services/s/core/core.hpp": '#include <cmath>\n\n#include "interfaces/messages/a.hpp"\n',
    "services/s/main.cpp": "#include <chrono>\n",
    "services/s/README.md": "s\n",
    "services/s/CMakeLists.txt": "\n",
}


class Tidy(unittest.TestCase):
    def found(self, extra):
        with tempfile.TemporaryDirectory() as folder:
            for name, text in {**SOUND, **extra}.items():
                path = pathlib.Path(folder, name)
                path.parent.mkdir(parents=True, exist_ok=True)
                if text is not None:
                    path.write_text(text)
            return tidy.violations(folder)

    def assert_found(self, extra, words):
        found = self.found(extra)
        self.assertEqual(len(found), 1, found)
        self.assertIn(words, found[0])

    def test_sound_tree(self):
        self.assertEqual(self.found({}), [])

    def test_top_level(self):
        self.assert_found({"misc/x.md": "x\n"}, "top level")

    def test_direct_impurity(self):
        self.assert_found({"services/s/core/x.hpp": "#include <chrono>\n"}, "includes chrono")

    def test_impurity_through_a_header(self):
        self.assert_found({"services/s/core/x.hpp": '#include "services/s/clock.hpp"\n',
                           "services/s/clock.hpp": "#include <iceoryx_posh/x.hpp>\n"}, "clock.hpp includes iceoryx")

    def test_unit(self):
        self.assert_found({"interfaces/messages/b.hpp": "struct B {\n  float range;\n};\n"}, "'range' names no unit")

    def test_unit_in_a_column(self):
        self.assert_found({"interfaces/messages/b.hpp": "struct B {\n  DetectionColumn<float> angle;\n};\n"}, "'angle'")

    def test_unfinished(self):
        self.assert_found({"docs/x.md": "TO" + "DO: later\n"}, "unfinished")

    def test_merge_conflict(self):
        self.assert_found({"docs/x.md": "<" * 7 + " HEAD\n"}, "merge conflict")

    def test_machine_path(self):
        self.assert_found({"docs/x.md": "see /" + "work/main\n"}, "one machine")

    def test_long_file(self):
        self.assert_found({"services/s/x.sh": "\n" * 501}, "501 lines")

    def test_room_without_core(self):
        self.assert_found({"services/t/main.cpp": "int main() {}\n", "services/t/CMakeLists.txt": "\n",
                           "services/t/README.md": "t\n"}, "no core/")

    def test_room_without_readme(self):
        self.assert_found({"services/t/main.cpp": "int main() {}\n", "services/t/CMakeLists.txt": "\n",
                           "services/t/core/t.hpp": "\n"}, "no README.md")


if __name__ == "__main__":
    unittest.main()
