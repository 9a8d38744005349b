#!/usr/bin/env python3
"""Each rule of citations.py finds what it is for, and finds nothing where all citations resolve."""
import pathlib
import tempfile
import unittest

import citations

SOUND = {
    "docs/bibliography.md": "# B\n| cited as | source |\n|---|---|\n| **Huber 1964** | ISO 8855, arXiv 1812.05752, `docs/a.md` |\n"
                            "| **Steele, Lea and Flood 2014** | |\n| **Ester et al. 1996** | |\n| **Le Ba Thanh 2023** | |\n",
    "docs/algorithms/README.md": "| page | model | equations | numbered as in |\n|---|---|---|---|\n"
                                 "| [x.md](x.md) | m | (A1)–(A3) | this project |\n| [x.md](x.md) | m | (1)–(2) | Le Ba Thanh 2023 |\n",
    "docs/algorithms/x.md": "# X\n```text\na = b   (A1)\nb = c   (A2)\nc = d   (A3)\ne = f   (1)\nf = g   (2)\n```\nSee (A2).\n",
    "docs/a.md": "# A title: it's `code`\n## Twice\n## Twice\n[x](algorithms/x.md#x) [own](#a-title-its-code) [second](#twice-1)\n",
    "s/a.hpp": "// As Huber 1964 and Steele, Lea, Flood (2014) have it; DBSCAN (Ester et\n// al. 1996). Le Ba Thanh 2023, §2 (1)(2);\n"
               "/// see docs/algorithms/x.md\n/// (A1)–(A3). In November 2026, ISO 8855, arXiv 1812.05752.\n",
}


class Citations(unittest.TestCase):
    def found(self, extra):
        with tempfile.TemporaryDirectory() as folder:
            root = pathlib.Path(folder)
            files = {**SOUND, **extra}
            for name, text in files.items():
                (root / name).parent.mkdir(parents=True, exist_ok=True)
                (root / name).write_text(text)
            return list(citations.findings(root, sorted(pathlib.Path(name) for name in files)))

    def assert_found(self, extra, words):
        found = self.found(extra)
        self.assertEqual(len(found), 1, found)
        self.assertIn(words, found[0])

    def test_sound_tree(self):
        self.assertEqual(self.found({}), [])

    def test_author_that_is_not_listed(self):
        self.assert_found({"s/b.cpp": "int a;\n// As Tukey 1977 has it.\n"}, "s/b.cpp:2: 'Tukey 1977'")

    def test_year_that_is_not_listed(self):
        self.assert_found({"config/b.toml": "# (Huber, 1965)\n"}, "'Huber, 1965'")

    def test_second_author_that_is_not_listed(self):
        self.assert_found({"docs/b.md": "Huber and Tukey 1964\n"}, "'Huber and Tukey 1964'")

    def test_et_al_that_is_not_listed(self):
        self.assert_found({"docs/b.md": "as Kellner et al. showed\n"}, "'Kellner et al.'")

    def test_standard_that_is_not_listed(self):
        self.assert_found({"s/b.hpp": "// by AUTOSAR PRS_E2EProtocol\n"}, "'PRS_E2EProtocol'")
        self.assert_found({"s/b.hpp": "// by ISO 9999\n"}, "'ISO 9999'")

    def test_preprint_that_is_not_listed(self):
        self.assert_found({"docs/b.md": "arXiv 2104.02493\n"}, "arXiv 2104.02493")

    def test_page_that_does_not_exist(self):
        self.assert_found({"s/b.hpp": "// docs/algorithms/y.md\n"}, "no docs/algorithms/y.md")

    def test_equation_that_does_not_exist(self):
        self.assert_found({"s/b.hpp": "// docs/algorithms/x.md (A2)–(A4)\n"}, "no equation (A4)")

    def test_equation_on_the_next_line(self):
        self.assert_found({"s/b.hpp": "// docs/algorithms/x.md,\n// (A9)\n"}, "s/b.hpp:1: docs/algorithms/x.md has no equation (A9)")

    def test_equation_of_a_source_that_does_not_exist(self):
        self.assert_found({"s/b.hpp": "// Le Ba Thanh 2023, (1)(3)\n"}, "equation (3) of Le Ba Thanh 2023")

    def test_index_that_lists_too_much(self):
        index = SOUND["docs/algorithms/README.md"].replace("(1)–(2)", "(1)–(3)")
        self.assert_found({"docs/algorithms/README.md": index}, "README.md:4: the index lists (3)")

    def test_equation_that_the_index_does_not_list(self):
        page = SOUND["docs/algorithms/x.md"].replace("   (2)\n", "   (2)\nh = i   (A4)\n")
        self.assert_found({"docs/algorithms/x.md": page}, "(A4) is not listed")

    def test_equation_defined_twice(self):
        page = SOUND["docs/algorithms/x.md"].replace("   (2)\n", "   (2)\nh = i   (A1)\n")
        self.assert_found({"docs/algorithms/x.md": page}, "(A1) is defined twice")

    def test_reference_of_a_page_to_no_equation(self):
        self.assert_found({"docs/algorithms/x.md": SOUND["docs/algorithms/x.md"] + "By (F7).\n"}, "(F7) is defined in no page")

    def test_link_to_no_file(self):
        self.assert_found({"docs/b.md": "[x](figures/none.svg)\n"}, "figures/none.svg: no such file")

    def test_link_to_no_heading(self):
        self.assert_found({"docs/b.md": "[x](a.md#thrice)\n"}, "a.md#thrice: no such heading")

    def test_link_in_code_is_none(self):
        self.assertEqual(self.found({"docs/b.md": "`[x](none.md)`\n```\n[x](none.md)\n```\n[y](https://example.org/none.md)\n"}), [])

    def test_place_that_does_not_exist(self):
        listed = SOUND["docs/bibliography.md"].replace("docs/a.md", "docs/none.md")
        self.assert_found({"docs/bibliography.md": listed}, "docs/none.md does not exist")


if __name__ == "__main__":
    unittest.main()
