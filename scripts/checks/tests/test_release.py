# SPDX-License-Identifier: MIT OR Apache-2.0
"""Tests that scripts/release.sh lets every test take its lists whole, and chooses none by a name."""
import pathlib
import re
import shlex
import unittest

RELEASE = pathlib.Path(__file__).resolve().parents[2] / "release.sh"
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


if __name__ == "__main__":
    unittest.main()
