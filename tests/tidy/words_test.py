#!/usr/bin/env python3
"""The word list finds home-made words in prose, and only there; sentences are counted as a reader would."""
import pathlib
import unittest

import words


def found(name, text):
    path = pathlib.Path(name)
    return list(words.findings_of_words(path, text)) + list(words.findings_of_sentences(path, text))


class Words(unittest.TestCase):
    def assert_found(self, name, text, what):
        result = found(name, text)
        self.assertEqual(len(result), 1, result)
        self.assertIn(what, result[0])

    def test_comment(self):
        self.assert_found("services/s/a.cpp", "int a;  // the radar is crooked\n", "a.cpp:1: 'crooked'")

    def test_string(self):
        self.assert_found("services/s/a.cpp", 'int f();\nauto t = "a knock was seen";\n', "a.cpp:2: 'knock'")

    def test_raw_string(self):
        self.assert_found("services/s/a.cpp", 'auto t = R"(one\ntold)";\n', "a.cpp:2: 'told'")

    def test_identifiers_and_includes_are_free(self):
        self.assertEqual(found("services/s/a.cpp", '#include "s/told.hpp"\nint told = knock();\n'), [])

    def test_python_comment_and_string(self):
        self.assert_found("tests/a.py", "x = 1  # left out\n", "'left out'")
        self.assert_found("tests/a.py", 'x = "left out"\n', "'left out'")

    def test_configuration(self):
        self.assert_found("config/a.toml", "a = 1  # as told\n", "a.toml:1: 'told'")

    def test_allowed_company(self):
        self.assertEqual(found("docs/a.md", "The wheel speed and a mirror image.\n"), [])
        self.assert_found("docs/a.md", "An image.\n", "'image'")

    def test_former_names_of_sources(self):
        self.assert_found("docs/a.md", "See Report A.\n", "'Report A'")
        self.assertEqual(found("docs/a.md", "They report a fault.\n"), [])
        self.assertEqual(found("docs/bibliography.md", "Report A is a thesis.\n"), [])

    def test_rooms_to_be_rewritten_are_left_alone(self):
        self.assertEqual(found("services/ghost_filter/core/a.cpp", "// told\n"), [])

    def test_long_sentence(self):
        self.assert_found("docs/a.md", "Word " * 41 + "end.\n", "42 words")
        self.assertEqual(found("docs/a.md", "Word " * 39 + "end. " + "Word " * 39 + "end.\n"), [])

    def test_a_long_sentence_over_lines_and_in_a_list(self):
        self.assert_found("docs/a.md", "- " + "word\n  " * 41 + "end.\n", "42 words")

    def test_tables_and_code_are_no_sentences(self):
        self.assertEqual(found("docs/a.md", "| " + "word " * 60 + "|\n```\n" + "word " * 60 + "\n```\n"), [])

    def test_opening(self):
        self.assert_found("docs/a.md", "Nor is this one read.\n", "opens with 'Nor'")


if __name__ == "__main__":
    unittest.main()
