# SPDX-License-Identifier: MIT OR Apache-2.0
"""Tests that scripts/checks/fuzz.py notices each way in which a program may fail, and that its cases can be repeated."""
import pathlib
import sys
import tempfile
import unittest

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parent.parent))

from fuzzing import answer
from fuzzing.answer import Answer, answer_of, run_command
from fuzzing.mutate import mutate
from fuzzing.readers import READERS

REFUSAL = "foveate: `x` is not an image; convert it\n"


class Answers(unittest.TestCase):
    def test_an_answer_is_judged_by_code_and_message(self):
        for code, messages, expected in [
            (0, "", Answer.ACCEPTED), (0, "foveate: warning: x\n", Answer.ACCEPTED), (1, REFUSAL, Answer.PARTIAL), (2, REFUSAL, Answer.REFUSED),
            (2, "", Answer.FAILED), (2, "foveate: warning: x\n", Answer.FAILED), (101, REFUSAL, Answer.FAILED), (-11, "", Answer.FAILED),
            (2, "thread 'main' panicked at src/x.rs\n" + REFUSAL, Answer.FAILED), (0, "memory allocation of 9 bytes failed", Answer.FAILED),
        ]:
            self.assertIs(answer_of(code, messages)[0], expected, (code, messages))

    def test_endless_time_and_memory_fail(self):
        seconds, answer.SECONDS = answer.SECONDS, 1
        self.addCleanup(setattr, answer, "SECONDS", seconds)
        with tempfile.TemporaryDirectory() as folder:
            self.assertIs(run_command(["sleep", "60"], folder)[0], Answer.FAILED)
            greedy = [sys.executable, "-c", "bytearray(8 << 30)"]
            self.assertIs(run_command(greedy, folder)[0], Answer.FAILED)


class Mutations(unittest.TestCase):
    def test_the_seed_decides_alone(self):
        sample = bytes(range(256)) * 8
        self.assertEqual(mutate(sample, "1:png:7", False), mutate(sample, "1:png:7", False))
        self.assertGreater(len({mutate(sample, f"1:png:{number}", False) for number in range(50)}), 45)

    def test_short_files_are_mutated_too(self):
        for sample in (b"", b"1", b"a = 1\n"):
            for number in range(300):
                mutate(sample, number, True)


class Readers(unittest.TestCase):
    def test_names_are_unique(self):
        self.assertEqual(len({reader.name for reader in READERS}), len(READERS))


if __name__ == "__main__":
    unittest.main()
