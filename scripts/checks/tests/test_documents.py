# SPDX-License-Identifier: MIT OR Apache-2.0
"""Tests that scripts/checks/snippets.py notices a page that cannot be pasted or shows something else, and names page and line."""
import os
import pathlib
import sys
import tempfile
import textwrap
import unittest
from unittest import mock

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parent.parent))

from documents import compare, left_out, pages
from documents import run as running
from documents.pages import PageError
from documents.run import LeftOut, PageRun, check_table, read_pages

PAGE = "docs/page.md"


def run(page, table=(), **options):
    """Runs the text of a page in a new folder."""
    steps = pages.steps(PAGE, page)
    check_table({PAGE: steps}, table, {})
    with tempfile.TemporaryDirectory() as folder:
        return PageRun(PAGE, table, **options).run(steps, folder, dict(os.environ))


class Pages(unittest.TestCase):
    def refused(self, place, message, page, table=(), **options):
        with self.assertRaises(PageError) as refused:
            run(page, table, **options)
        self.assertTrue(str(refused.exception).startswith(f"{PAGE}:{place}: "), refused.exception)
        self.assertIn(message, str(refused.exception))

    def test_a_page_is_pasted_into_one_shell(self):
        count = run(textwrap.dedent("""\
            # Title
                mkdir folder && cd folder
                name=value    # kept
                for number in 1 2
                do
                    echo $number >> "$name"
                done

            It prints

                wc -l \\
                    < value

            ```text
            2
            ```
            ```sh
            # nothing
            pwd | sed 's,.*/,,'
            ```
            ```text
            folder
            ```
            ```text
            $ printf 'a\\nb\\n'
            a
            b
            $ printf 'a\\n%s\\n' \\
                c
            ...
            c
            ```
            ```python
            print("one", "two", sep="\\n")
            ```

            ```text
            one
            two
            ```
            ```toml
            no = "command"
            ```
            * An item

                of two paragraphs.
            """))
        self.assertEqual((count.commands, count.outputs, count.blocks, count.left_out), (7, 5, 1, 0))

    def test_a_wrong_number_is_found(self):
        self.refused(6, "`2 b` is shown, but the command prints `3 b`", textwrap.dedent("""\
            # Title

            ```text
            $ printf '1 a\\n3 b\\n'
            1 a
            2 b
            ```
            """))

    def test_lines_too_many_or_too_few_are_found(self):
        self.refused(4, "prints more behind this line: `b`", "    printf 'a\\nb\\n'\n\n```text\na\n```\n")
        self.refused(5, "`b` is shown, but the command does not print this line", "    echo a\n\n```text\na\nb\n```\n")
        self.refused(2, "prints more behind this line: `a`", "```text\n$ echo a\n$ true\n```\n")

    def test_a_command_that_fails_is_found(self):
        self.refused(3, "this fails with exit code 3:\n(exit 3)", "# Title\n    true\n    (exit 3)\n")
        self.refused(2, "this fails with exit code 1:\nassert False", "```python\nassert False\n```\n")
        self.refused(1, "this fails with exit code 2:\nfor it is", "    for it is (no command)\n")
        self.refused(2, "is shown to fail, but ends with exit code 0", "```text\n$ echo foveate: no\nfoveate: no\n```\n")
        self.assertEqual(run("```text\n$ echo foveate: no; (exit 2)\nfoveate: no\n```\n").outputs, 1)

    def test_a_command_that_does_not_end_is_found(self):
        with mock.patch.object(running, "SECONDS", 0.2):
            self.refused(1, "this has not ended after 0.2 s", "    sleep 60\n")
        self.refused(1, "this ends the shell", "    exit 0\n")

    def test_a_block_that_nobody_runs_is_found(self):
        self.refused(2, "no command stands before this block of text", "```text\n| a drawing |\n```\n")
        self.refused(1, "a block of `rust` is of no kind that is known", "```rust\nfn main() {}\n```\n")
        self.refused(1, "a block of `` is of no kind that is known", "```\nfoveate\n```\n")
        self.refused(1, "this block has no end", "```sh\ntrue\n")

    def test_what_is_left_out_has_an_entry(self):
        table = [LeftOut(PAGE, "false", "it fails"), LeftOut(PAGE, "true", "a minute", is_long=True)]
        page = "    false\n    true\n"
        self.assertEqual((run(page, table).left_out, run(page, table, whole=True).left_out), (2, 1))
        self.refused(0, "nothing begins with `false` there", "    true\n", table[:1])
        with self.assertRaisesRegex(PageError, "docs/other.md:0: nothing begins with `false`"):
            run(page, [LeftOut("docs/other.md", "false", "it fails")])
        with self.assertRaisesRegex(PageError, "docs/other.md:0: there is no such page"):
            check_table({}, [], {"docs/other.md": "gone"})

    def test_figures_of_another_tool_are_not_compared(self):
        page = "```text\n$ echo 2\n1\n```\n"
        self.refused(3, "prints `2`", page)
        self.assertEqual(run(page, is_compared=lambda command: not command.startswith("echo ")).outputs, 0)


class Comparison(unittest.TestCase):
    def test_only_what_a_machine_changes_may_differ(self):
        for shown, printed, same in [
            ("seed 1; 0.0 s vectors, 0.9 s build, 0.0 s run", "seed 1; 0.1 s vectors, 12.0 s build, 3.4 s run", True),
            ("seed 1; 0.0 s vectors, 0.9 s build, 0.0 s run", "seed 2; 0.0 s vectors, 0.9 s build, 0.0 s run", False),
            ("Verilator 5.006 2023-01-22 rev (Debian 5.006-3), seed 1", "Verilator 5.020 2024-01-01 rev (Debian 5.020-1), seed 1", True),
            ("time       0.89 ms per frame, 0.04 ms of it for masks", "time       8.29 ms per frame, 2.24 ms of it for masks", True),
            ("time 1.00 ms per frame, 0.04 ms of it for masks; whole 3.22 ms; faster than that as long as at most 41.0 % of the blocks are computed",
             "time 1.00 ms per frame, 0.04 ms of it for masks; whole 9.99 ms", True),
            ("on eyeriss: 1.52 ms and 0.219 mJ per frame", "on eyeriss: 1.53 ms and 0.219 mJ per frame", False),
            ("691,372 frames/s at that clock", "691,373 frames/s at that clock", False),
        ]:
            self.assertEqual(compare.difference([shown], [printed]) is None, same, (shown, printed))

    def test_dots_stand_for_lines(self):
        for shown, printed, line in [
            (["a", "...", "d"], "abcd", None), (["...", "c", "..."], "abcd", None), (["...", "b", "c", "..."], "abcbd", None),
            (["a", "..."], "bc", 0), (["...", "d"], "abc", 1),
            (["...", "c", "a", "..."], "abcbd", 2), (["...", "b", "...", "a", "..."], "ab", 3), (["a", "...", "a"], "a", 2), ([], "", None),
        ]:
            found = compare.difference(shown, list(printed))
            self.assertEqual(found if found is None else found[0], line, (shown, printed))


class Table(unittest.TestCase):
    def test_every_step_that_is_left_out_is_there(self):
        root = pathlib.Path(__file__).resolve().parents[3]
        check_table(read_pages(root, left_out.PAGES), left_out.TABLE, left_out.PAGES)
        self.assertTrue(all(entry.reason for entry in left_out.TABLE))


if __name__ == "__main__":
    unittest.main()
