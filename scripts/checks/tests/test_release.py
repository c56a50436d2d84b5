# SPDX-License-Identifier: MIT OR Apache-2.0
"""Tests that scripts/release.sh lets every test take its lists whole, and chooses none by a name, and that the table of its steps in
CONTRIBUTING.md is complete."""
import pathlib
import re
import shlex
import subprocess
import sys
import unittest

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1]))
from release_steps import ROOT, is_within, read_table, steps_of  # noqa: E402

RELEASE = ROOT / "scripts/release.sh"
ALLOWED = ["--workspace", "--locked", "--", "--include-ignored"]


def test_choices(text):
    """Returns the words in calls of `cargo test` with FOVEATE_WHOLE that choose tests; None without such a call."""
    calls = re.findall(r"(?m)^[^#\n]*FOVEATE_WHOLE=1 cargo test(.*)$", text)
    words = [[word for word in shlex.split(call) if word not in ALLOWED] for call in calls]
    return words if calls else None


class Release(unittest.TestCase):
    def test_every_test_takes_its_lists_whole(self):
        self.assertEqual(test_choices(RELEASE.read_text(encoding="utf-8")), [[]])

    def test_a_choice_is_found(self):
        for line, words in [
            ("FOVEATE_WHOLE=1 cargo test --workspace --locked -- planted", [["planted"]]),
            ("FOVEATE_WHOLE=1 cargo test --locked --package foveate-emit", [["--package", "foveate-emit"]]),
            ("# FOVEATE_WHOLE=1 cargo test planted", None), ("cargo test --workspace", None),
        ]:
            self.assertEqual(test_choices(line), words, line)


class Steps(unittest.TestCase):
    def setUp(self):
        self.table = read_table((ROOT / "CONTRIBUTING.md").read_text(encoding="utf-8"))

    def test_every_step_is_in_the_table_and_every_word_is_a_step(self):
        listed = subprocess.run([str(RELEASE), "--list"], check=True, capture_output=True, text=True).stdout.split()
        self.assertEqual(sorted({step for _, steps in self.table for step in steps}), sorted(listed))

    def test_every_tracked_file_has_a_row_and_every_path_is_one_of_a_file(self):
        files = subprocess.run(["git", "-C", str(ROOT), "ls-files"], check=True, capture_output=True, text=True).stdout.splitlines()
        paths = [path for paths, _ in self.table for path in paths]
        self.assertEqual([file for file in files if not any(is_within(file, path) for path in paths)], [])
        self.assertEqual([path for path in paths if not any(is_within(file, path) for file in files)], [])

    def test_a_changed_file_names_the_steps_of_its_rows(self):
        table = [(["rtl/", "a.py"], ["lint", "cosim"]), (["docs/"], ["documents"]), (["rtl/core/"], ["lint", "formal"])]
        self.assertEqual(steps_of(["rtl/core/x.v"], table), ["lint", "cosim", "formal"])
        self.assertEqual(steps_of(["docs/a.md", "a.python"], table), ["documents"])
        self.assertEqual(steps_of(["rtl", "other.py"], table), [])


if __name__ == "__main__":
    unittest.main()
