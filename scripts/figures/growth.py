#!/usr/bin/env python3
# SPDX-License-Identifier: MIT OR Apache-2.0
"""Measures how the time of an exploration grows with its units: planning, one unit, collecting, and Snakemake's own share. Prints the table of
the guide.

    scripts/figures/growth.py [UNITS...]     by default 10 100 1000 10000

Clips are ten scenes of two frames of 16x16 pixels, so that little is left of a unit but its overhead. Each time is the
shortest of three runs, but the whole runs are done once. `snakemake` must be in PATH for the last columns:
PATH=$(scripts/python_tools.sh --workflow):$PATH scripts/figures/growth.py

FOVEATE    an executable to use instead of a release build
"""
import json
import os
import pathlib
import shutil
import subprocess
import sys
import tempfile
import time

SOURCES = pathlib.Path(__file__).resolve().parents[2]
SCENES = [f"scene:{name}" for name in "street zero max checkerboard hot-pixels ramps flicker fade shake random".split()]
INPUT_OPTIONS = ["--max-frames", "2", "--no-area"]
# Number of designs that measure a clip together.
DESIGNS_PER_UNIT = 16
COLUMNS = [
    "units",
    "plan, s",
    "finished unit by its line, s",
    "by its name, s",
    "all in one run, s",
    "collect, s",
    "Snakemake's plan, s",
    "Snakemake, 2 jobs, s",
]
# Snakemake takes too long with more jobs to be timed here.
MAX_UNITS = 1000


def space(units):
    """Returns a space of designs with this number of units over all clips: levels of the feature, then counts, then levels of the change."""
    designs = units // len(SCENES) * DESIGNS_PER_UNIT
    levels = min(designs, 160)
    counts = min(designs // levels, 50)
    changes = designs // levels // counts
    assert levels * counts * changes == designs, f"{units} units are no grid"
    return f"""[design]
frame.width = 16
frame.height = 16
[vary]
spatial.0.level = {list(range(1, levels + 1))}
temporal.min_count = {list(range(1, counts + 1))}
temporal.level = {list(range(4, 4 + changes))}
"""


def seconds(command, runs=3, **options):
    """Returns the shortest time of a command, and its output."""
    best = float("inf")
    for _ in range(runs):
        start = time.perf_counter()
        result = subprocess.run(command, capture_output=True, text=True, **options)
        best = min(best, time.perf_counter() - start)
        if result.returncode != 0:
            sys.exit(f"{command}: {result.stderr[-2000:] or result.stdout[-2000:]}")
    return best, result.stdout


def snakemake(foveate, units, folder):
    """Times Snakemake: planning with no unit done, and all units with two parallel jobs."""
    if not shutil.which("snakemake"):
        return "-", "-"
    explore = {"space": "space.toml", "options": "--no-area"}
    config = {"foveate": foveate, "clips": SCENES, "options": "--max-frames 2", "explore": explore}
    (folder / "config.json").write_text(json.dumps(config))
    command = ["snakemake", "--snakefile", SOURCES / "workflow/Snakefile", "--configfile", "config.json", "--cores", "2"]
    seconds([*command, "out/plan.jsonl"], 1, cwd=folder)
    planning, _ = seconds([*command, "--dry-run", "--quiet"], 1, cwd=folder)
    working = f"{seconds(command, 1, cwd=folder)[0]:.0f}" if units <= MAX_UNITS else "-"
    return f"{planning:.1f}", working


def measure(foveate, units, folder):
    (folder / "space.toml").write_text(space(units))
    explore = [foveate, "explore", "space.toml"]
    everything = [*explore, *SCENES, "-o", "alone", *INPUT_OPTIONS, "--quiet"]
    planning, plan = seconds([*everything, "--plan"], cwd=folder)
    lines = plan.splitlines()
    assert len(lines) == units, f"{len(lines)} units are planned"
    last = json.loads(lines[-1])
    by_line, by_name = ([*explore, *last["inputs"], "-o", "one", *INPUT_OPTIONS, "--quiet", "--only", unit] for unit in (lines[-1], last["unit"]))
    # The first run measures; the others find the results in the cache.
    unit_by_line, _ = seconds(by_line, cwd=folder)
    unit_by_name, _ = seconds(by_name, cwd=folder)
    whole, _ = seconds(everything, 1, cwd=folder)
    collecting, _ = seconds(everything, cwd=folder)
    cells = [f"{units:,}", f"{planning:.2f}", f"{unit_by_line:.3f}", f"{unit_by_name:.2f}", f"{whole:.1f}", f"{collecting:.2f}"]
    return [*cells, *snakemake(foveate, units, folder)]


def main():
    foveate = os.environ.get("FOVEATE")
    if not foveate:
        subprocess.run(["cargo", "build", "--release", "--locked", "--quiet", "--package", "foveate"], cwd=SOURCES, check=True)
        foveate = str(pathlib.Path(os.environ.get("CARGO_TARGET_DIR", SOURCES / "target"), "release/foveate"))
    print("| " + " | ".join(COLUMNS) + " |\n" + "| ---: " * len(COLUMNS) + "|")
    for units in map(int, sys.argv[1:] or ["10", "100", "1000", "10000"]):
        with tempfile.TemporaryDirectory() as folder:
            print("| " + " | ".join(measure(foveate, units, pathlib.Path(folder))) + " |", flush=True)


if __name__ == "__main__":
    main()
