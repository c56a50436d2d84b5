# SPDX-License-Identifier: MIT OR Apache-2.0
"""Tests of the parts of workflow/ that need no Snakemake: names of clips, plans, and tables of many folders."""
import json
import os
import sys
import tempfile
import unittest
from pathlib import Path

sys.path.insert(0, os.path.join(os.path.dirname(__file__), "..", "..", "..", "workflow"))

import tables  # noqa: E402
import units  # noqa: E402
from clips import files, names  # noqa: E402


class Workflow(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = Path(folder.name)

    def write(self, name, text):
        path = self.folder / name
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_text(text)
        return str(path)

    def test_clips_have_names_that_are_folders(self):
        clips = ["a/street.mp4", "scene:street", "b/street.mp4", "x/*.png", "photos/", "a b.mkv"]
        self.assertEqual(list(names(clips)), ["street", "street-2", "street-3", "_", "photos", "a_b"])
        self.assertEqual(names(clips)["street-3"], "b/street.mp4")

    def test_a_name_that_looks_numbered_is_kept_apart(self):
        clips = ["street-2.mp4", "a/street.mp4", "b/street.mp4"]
        self.assertEqual(names(clips), {"street-2": clips[0], "street": clips[1], "street-3": clips[2]})

    def test_only_what_is_there_is_waited_for(self):
        clip = self.write("a.mp4", "")
        self.assertEqual(files([clip, None, "scene:street", "designs", str(self.folder)]), [clip, str(self.folder)])

    def test_a_plan_that_changes_is_read_again(self):
        line = '{"unit":"1f","inputs":["a b.mp4"]}'
        plan = self.write("plan.jsonl", line + "\n")
        os.utime(plan, ns=(1, 1))
        self.assertEqual(units.read(plan), {"1f": {"unit": "1f", "inputs": ["a b.mp4"], "line": line}})
        self.write("plan.jsonl", "")
        os.utime(plan, ns=(2, 2))
        self.assertEqual(units.read(plan), {})

    def test_rows_of_a_study_are_those_of_one_run(self):
        one = self.write("one/size.csv", "# program\n# one: 3 frames\nclip,share\none,0.5\n")
        two = self.write("two/size.csv", '# program\n# two: 4 frames\nclip,share\n"two, #1",0.25\n')
        out = self.folder / "size.csv"
        tables.rows(out, "size", *(str(Path(table).parent) for table in (one, two)))
        expected = '# program\n# one: 3 frames\n# two: 4 frames\nclip,share\none,0.5\n"two, #1",0.25\n'
        self.assertEqual(out.read_text(), expected)

    def test_rows_of_different_tables_are_refused(self):
        for name, column in [("one", "share"), ("two", "count")]:
            self.write(f"{name}/size.csv", f"# program\nclip,{column}\n{name},1\n")
        with self.assertRaisesRegex(SystemExit, "two.*other columns"):
            tables.rows(self.folder / "size.csv", "size", str(self.folder / "one"), str(self.folder / "two"))
        self.assertFalse((self.folder / "size.csv").exists())

    def test_totals_have_no_times_and_no_lists(self):
        for name, error in [("one", None), ("two", {"largest": 0.5})]:
            summary = {"frames": 3, "macs": {"needed": 1.5, "seconds": 2}, "layers": [1], "seconds_per_frame": 9, "error": error}
            self.write(f"{name}/inference.json", json.dumps(summary))
        out = self.folder / "infer.csv"
        tables.totals(out, str(self.folder / "one"), str(self.folder / "two"))
        self.assertEqual(out.read_text(), "clip,frames,macs.needed,error.largest\none,3,1.5,\ntwo,3,1.5,0.5\n")


if __name__ == "__main__":
    unittest.main()
