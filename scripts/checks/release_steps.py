#!/usr/bin/env python3
# SPDX-License-Identifier: MIT OR Apache-2.0
"""Prints the steps of scripts/release.sh whose sources have changed, by the table in CONTRIBUTING.md.

    scripts/checks/release_steps.py [BASE]

Sources are compared with those of the commit BASE; without BASE, with those of the last run of each step in docs/data/release-runs.csv. A
step without a recorded run counts as changed.
"""
import csv
import pathlib
import re
import subprocess
import sys

ROOT = pathlib.Path(__file__).resolve().parents[2]
HEADING = "## Parts of a release run"
RECORD = ROOT / "docs/data/release-runs.csv"


def read_table(text):
    """Returns the rows of the table in the text of CONTRIBUTING.md: paths from the root, and steps."""
    section = text.split(f"{HEADING}\n", 1)[1].split("\n## ", 1)[0]
    rows = re.findall(r"(?m)^\| (`.*) \| (.*) \|$", section)
    return [(re.findall(r"`([^`]+)`", paths), re.findall(r"`([^`]+)`", steps)) for paths, steps in rows]


def is_within(file, path):
    """Returns whether a file is the one of this path or in the folder of this path, which ends with a slash."""
    return file == path or (path.endswith("/") and file.startswith(path))


def steps_of(files, table):
    """Returns the steps that a change of these files concerns, in the order of the table."""
    concerned = [steps for paths, steps in table if any(is_within(file, path) for file in files for path in paths)]
    return list(dict.fromkeys(step for steps in concerned for step in steps))


def changed_files(base):
    """Returns the files that differ between a commit and HEAD."""
    command = ["git", "-C", str(ROOT), "diff", "--name-only", "--no-renames", base, "HEAD", "--"]
    result = subprocess.run(command, capture_output=True, text=True)
    if result.returncode != 0:
        sys.exit(f"release: there is no commit {base} to compare with: {result.stderr.strip()}")
    return result.stdout.splitlines()


def main():
    if len(sys.argv) > 2:
        sys.exit("release: --changed takes one commit at most")
    table = read_table((ROOT / "CONTRIBUTING.md").read_text(encoding="utf-8"))
    if len(sys.argv) == 2:
        print(*steps_of(changed_files(sys.argv[1]), table))
        return
    with RECORD.open(newline="", encoding="utf-8") as record:
        last_run = {row["step"]: row["commit"] for row in csv.DictReader(record)}
    files = {commit: changed_files(commit) for commit in set(last_run.values())}
    every_step = list(dict.fromkeys(step for _, steps in table for step in steps))
    print(*(step for step in every_step if step not in last_run or step in steps_of(files[last_run[step]], table)))


if __name__ == "__main__":
    main()
