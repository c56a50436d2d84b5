#!/usr/bin/env python3
# SPDX-License-Identifier: MIT OR Apache-2.0
"""Compares the speed of two programs `foveate` in pairs of runs, one directly after the other.

    scripts/checks/speed.py NEW OLD [--pairs N]

Prints the median of the ratios of times, new to old, of the engine, the timed model and the cycle-level models of all organizations
(`foveate bench`, one thread) and of `foveate cosim` (processor time, without building). Ends with 1 if the new program takes more than
LIMIT times as long as the old one.
"""
import argparse
import json
import os
import resource
import statistics
import subprocess
import sys
import tempfile

# The medians of seven pairs of equal programs differ by up to 3 % on a shared machine.
LIMIT = 1.05
BENCHES = {"pipelined": ["--preset", "paper"], "serial": ["--preset", "serial"],
           "raster": ["--preset", "raster", "--set", "frame={width=224,height=224}"]}
LEVELS = {"functional-fast", "transactions", "cycle"}
COSIM = ["cosim", "--preset", "paper", "--level", "rpu", "--rounds", "20", "--quiet"]


def bench_times(program):
    """Returns the seconds per frame of each level of each organization."""
    # The Verilog is not timed: both programs simulate it with the same tool.
    environment = {**os.environ, "FOVEATE_VERILATOR": "none"}
    times = {}
    for organization, options in BENCHES.items():
        command = [program, "bench", *options, "--frames", "4", "--seconds", "0.5", "--json", "--quiet"]
        report = json.loads(subprocess.run(command, env=environment, check=True, capture_output=True, text=True).stdout)
        for row in report["rows"]:
            if row["level"] in LEVELS:
                times[f"{organization}: {row['name']}"] = 1 / row["measured"]["frames_per_second"]
    return times


def cosim_time(program, folder):
    """Returns the processor time of a co-simulation whose simulator is built."""
    before = resource.getrusage(resource.RUSAGE_CHILDREN)
    subprocess.run([program, *COSIM, "--replay", os.path.join(folder, "replay")], check=True, stdout=subprocess.DEVNULL,
                   env={**os.environ, "FOVEATE_CACHE": os.path.join(folder, "cache")})
    after = resource.getrusage(resource.RUSAGE_CHILDREN)
    return after.ru_utime - before.ru_utime + after.ru_stime - before.ru_stime


def measure(program, folder):
    return {**bench_times(program), "co-simulation": cosim_time(program, folder)}


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("new")
    parser.add_argument("old")
    parser.add_argument("--pairs", type=int, default=7)
    options = parser.parse_args()
    ratios = {}
    with tempfile.TemporaryDirectory() as folder:
        for program in (options.new, options.old):
            cosim_time(program, folder)
        for pair in range(options.pairs):
            # Each program is the first one in half of the pairs.
            order = [options.new, options.old] if pair % 2 else [options.old, options.new]
            times = {program: measure(program, folder) for program in order}
            for name, seconds in times[options.new].items():
                ratios.setdefault(name, []).append(seconds / times[options.old][name])
    medians = {name: statistics.median(values) for name, values in ratios.items()}
    for name, median in medians.items():
        print(f"{name}: {median:.3f} times the time of before ({min(ratios[name]):.3f} to {max(ratios[name]):.3f} in {options.pairs} pairs)")
    slower = [name for name, median in medians.items() if median > LIMIT]
    if slower:
        sys.exit(f"speed: slower than {LIMIT} times: {', '.join(slower)}")


if __name__ == "__main__":
    main()
