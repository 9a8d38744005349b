#!/usr/bin/env python3
"""The reader of the documentation's pages: that it finds what it should, and that it can find fault."""
import pathlib
import subprocess
import sys
import tempfile
import unittest

import pages

HERE = pathlib.Path(__file__).resolve().parent


class Steps(unittest.TestCase):
    def test_lines_of_a_shell_block_are_commands(self):
        found = list(pages.steps("text\n```sh\necho one\n# only a comment\n\necho two \\\n  three\n```\n"))
        self.assertEqual([(c.line, c.text) for c in found], [(3, "echo one"), (6, "echo two \\\n  three")])
        self.assertEqual([c.exit_code for c in found], [0, 0])

    def test_an_exit_code_may_be_stated(self):
        self.assertEqual(next(pages.steps("```sh\nfalse  # exit code 1\n```")).exit_code, 1)
        self.assertEqual(next(pages.steps("```console\n$ false  # exit code 3\n```")).exit_code, 3)

    def test_console_blocks_have_output(self):
        found = list(pages.steps("```console\n$ echo one\none\n…\n$ echo two\n```"))
        self.assertEqual([(c.text, c.output) for c in found], [("echo one", ["one", "…"]), ("echo two", [])])

    def test_files_are_written_and_grow(self):
        found = list(pages.steps("<!-- file: a.toml -->\n```toml\nx = 1\n```\n\n<!-- appended to: a.toml -->\n"
                                 "```toml\ny = 2\n```"))
        self.assertEqual([(f.name, f.text, f.appended) for f in found],
                         [("a.toml", "x = 1\n", False), ("a.toml", "y = 2\n", True)])

    def test_blocks_to_read_are_no_commands(self):
        self.assertEqual(list(pages.steps("```text\n$ rm -rf /\n```\n```mermaid\nflowchart\n```")), [])

    def test_what_is_not_executed_has_an_allowed_reason(self):
        page = "<!-- not executed: {} -->\n```sh\nsystemctl start x\n```\n```sh\necho on\n```"
        found = list(pages.steps(page.format("needs systemd")))
        self.assertEqual([c.not_executed for c in found], ["needs systemd", ""])
        with self.assertRaisesRegex(pages.PageError, "no allowed reason"):
            list(pages.steps(page.format("no time")))

    def test_pages_that_hide_commands_are_refused(self):
        for page in ("```\necho\n```", "```bash\necho\n```", "```sh\necho", "```sh\necho \\\n```",
                     "```console\nno prompt\n```", "<!-- file: a -->\ntext\n", "<!-- file: a -->"):
            with self.subTest(page), self.assertRaises(pages.PageError):
                list(pages.steps(page))


class Output(unittest.TestCase):
    PRINTED = ["simulated 5.0 s in 0.1 s", "  drive/radars.pcap", "front_left    900   +0.29°"]

    def test_printed_lines_match_in_order(self):
        self.assertIsNone(pages.missing_output(["simulated 5.0 s in … s", "…", "front_left … +0.29°"], self.PRINTED))
        self.assertIsNone(pages.missing_output(["drive/radars.pcap"], self.PRINTED))

    def test_what_is_not_printed_is_missed(self):
        self.assertEqual(pages.missing_output(["simulated 6.0 s in …"], self.PRINTED), "simulated 6.0 s in …")
        self.assertEqual(pages.missing_output(["drive/radars.pcap", "simulated …"], self.PRINTED), "simulated …")
        self.assertEqual(pages.missing_output(["drive/radars"], self.PRINTED), "drive/radars")


class Messages(unittest.TestCase):
    def test_neighbouring_literals_are_one(self):
        self.assertEqual(pages.literals('#include "a.hpp"\nf("one "\n  "two", x + " \\"three\\"");'),
                         ["one two", ' "three"'])

    def test_messages_are_the_code_of_the_first_column(self):
        page = "| message `a b` | `not this` |\n|---|---|\n| `c …`, `d` | x |\n`nor this`\n"
        self.assertEqual([m for _, m in pages.messages(page)], ["a b", "c …", "d"])

    def test_messages_that_no_program_prints_are_found(self):
        corpus = pages.literals('throw Error(name + ": no gateway listens: " + cause);')
        self.assertIsNone(pages.unknown_fragment("…: no gateway listens: …", corpus))
        self.assertIsNone(pages.unknown_fragment("…: No space left on device", corpus))
        self.assertEqual(pages.unknown_fragment("…: no gateway hears: …", corpus), "no gateway hears")


class Links(unittest.TestCase):
    def test_links_lead_to_files_and_headings(self):
        with tempfile.TemporaryDirectory() as folder:
            root = pathlib.Path(folder)
            (root / "docs").mkdir()
            (root / "README.md").write_text("# One\n## What it costs, all\n")
            (root / "docs/a.md").write_text("[1](../README.md#what-it-costs-all) [2](https://x.org/) [3](#b)\n# b\n"
                                            "[4](no.md)\n[5](../README.md#two)")
            self.assertEqual(list(pages.dead_links(root, "docs/a.md")), [(3, "no.md"), (4, "../README.md#two")])


class Run(unittest.TestCase):
    """The runner on pages of its own: a wrong page fails it."""

    def run_page(self, page):
        with tempfile.TemporaryDirectory() as folder:
            root = pathlib.Path(folder) / "source"
            (root / "config").mkdir(parents=True)
            (root / "page.md").write_text(page, encoding="utf-8")
            result = subprocess.run([sys.executable, HERE / "run.py", root, folder, "page.md"], capture_output=True,
                                    text=True, check=False)
        return result.returncode, result.stdout

    def test_a_true_page_passes(self):
        code, out = self.run_page("<!-- file: a/b -->\n```text\nhello\n```\n```sh\nexport X=1\ncd a\n```\n"
                                  "```console\n$ cat b; echo $X\nhello\n1\n$ exit_code() { return 3; }; exit_code  "
                                  "# exit code 3\n```\n<!-- not executed: needs systemd -->\n```sh\nsystemctl x\n```")
        self.assertEqual(code, 0, out)
        self.assertIn("not executed (needs systemd): systemctl x", out)

    def test_jobs_in_the_background_can_be_ended_and_do_not_stay(self):
        code, out = self.run_page("```sh\nsleep 100 &\nsleep 200 &\nkill %1\n```")
        self.assertEqual(code, 0, out)

    def test_false_pages_fail(self):
        for page, words in (("```sh\nfalse\n```", "exit code 1, the page says 0"),
                            ("```sh\ntrue # exit code 1\n```", "exit code 0, the page says 1"),
                            ("```sh\nno_such_command\n```", "exit code 127"),
                            ("```console\n$ echo one\ntwo\n```", "does not print: two"),
                            ("```sh\nif true\n```", "was not reached"),
                            ("```sh\nexit 0\necho on\n```", "was not reached"),
                            ("no command at all", "no command")):
            with self.subTest(page):
                code, out = self.run_page(page)
                self.assertEqual(code, 1, out)
                self.assertIn(words, out)


if __name__ == "__main__":
    unittest.main()
