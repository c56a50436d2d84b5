# SPDX-License-Identifier: MIT OR Apache-2.0
"""Tests that each design of formal/designs.txt is in a proof, and that a design uses each word of the list."""
import pathlib
import re
import unittest

FORMAL = pathlib.Path(__file__).resolve().parents[3] / "formal"


class ProofTests(unittest.TestCase):
    def setUp(self):
        text = (FORMAL / "designs.txt").read_text(encoding="utf-8")
        lines = [line.split() for line in text.splitlines() if line and not line.startswith("#")]
        self.settings = {name: settings for name, *settings in lines}

    def test_each_design_is_a_task_of_a_proof(self):
        proofs = "\n".join(path.read_text(encoding="utf-8") for path in FORMAL.glob("*.sby"))
        tasks = {line.split()[0] for section in re.findall(r"^\[tasks\]\n(.*?)(?=^\[)", proofs, re.M | re.S) for line in section.splitlines() if line}
        designs = {name for name in self.settings if not name.startswith("@")}
        self.assertGreater(len(designs), 30)
        self.assertEqual(designs - tasks, set(), "no proof has these designs of formal/designs.txt")

    def test_each_word_is_used(self):
        used = " ".join(word for settings in self.settings.values() for word in settings)
        words = {name for name in self.settings if name.startswith("@")}
        self.assertEqual({word for word in words if not re.search(rf"{word}\b", used)}, set(), "no design of formal/designs.txt uses these words")


if __name__ == "__main__":
    unittest.main()
