#!/usr/bin/env python3
# SPDX-License-Identifier: MIT OR Apache-2.0
"""Compares designs that `foveate fit` finds with a search over all cameras of a grid, as CSV on standard output.

    fits.py [--max-flips 3%] [--grid] INPUT...

Each input is a clip in grey that `fit` gets alone. The columns are the cost of the design that was found, as a percentage of an XCVU9P, and its
flips, missed regions and false alarms on the second half. With --grid, all cameras with the task's feature and regions are tried, too: every
depth from 3 bits, filter and window, with levels and minima around those of the task. Rates and their margins are computed here from the
scores of the Python package, and a camera must meet all limits in the searched part, in the part that confirms, and so in the first half. The
cheapest of these cameras is synthesized in the organization of the design that was found.

Needs `foveate` on the path (or its path in FOVEATE), NumPy and the package foveate.
"""
import argparse
import csv
import itertools
import json
import os
import subprocess
import sys
import tempfile

import numpy as np
import tomllib

import foveate as fv

FOVEATE = os.environ.get("FOVEATE", "foveate")
COLUMNS = ["input", "max_flips_percent", "result", "design", "cost_percent", "flips_percent", "missed_percent", "false_alarms_percent",
           "cameras", "grid_cameras", "grid_design", "grid_cost_percent"]
# Quantiles of Student's t and of a normal variable: 19 of 20 values are below.
STUDENT = [6.314, 2.920, 2.353, 2.132, 2.015, 1.943, 1.895]
NORMAL = 1.645
# The minimum scores and counts of the grid.
MIN_SCORES = (2, 3, 4, 5, 6, 7, 8)
MIN_COUNTS = (1, 2, 3, 4, 5, 6, 8, 10)
# LUTs, RAMB18, DSPs and a hundred times the flip-flops of an XCVU9P.
DEVICE = {"lut_total_packed": 1_182_240, "bram18": 4_320, "dsp": 6_840, "ff": 236_448_000}


def percent(share):
    """Returns a share as text in percent."""
    return f"{100 * share:.3f}"


def cost(area):
    """Returns the share of the device."""
    return sum(area[key] / count for key, count in DEVICE.items())


def fitted(path, arguments):
    """Returns the result of `foveate fit`, or None with the message of its error."""
    command = [FOVEATE, "fit", path, "--json", "--quiet", "--max-flips", arguments.max_flips, *arguments.options]
    run = subprocess.run(command, capture_output=True, text=True)
    return (json.loads(run.stdout), "") if run.stdout.startswith("{") else (None, run.stderr.strip())


class Comparison:
    """The ideal camera of a fit on the first half of a clip, and the limits on decisions."""

    def __init__(self, result, path):
        self.config = {key: table for key, table in tomllib.loads(result["task"]).items() if key != "hardware"}
        frames = np.stack([outcome.frame for outcome in fv.simulate(path, self.config)])
        half = len(frames) // 2
        searched = -(-2 * half // 3)
        self.parts = [np.arange(0, searched), np.arange(searched, half)]
        self.frames = frames[:half]
        self.ideal = self.run({"region": {**self.config["region"], "neighborhood": "shared"}}, 0)
        checks = {check["name"]: check["limit"] for check in result["design"]["fitted_held"]}
        self.limits = np.array([checks[name] for name in ("max-flips", "max-missed", "max-false-alarms")])

    def run(self, changes, shift):
        """Returns the outcomes of a camera that differs from the task in some tables, for frames with so many bits fewer."""
        return fv.Camera({**self.config, **changes}).run(self.frames >> shift, rendered=False, progress=False)

    def rates(self, srs, trs, numbers):
        """Returns flips, missed and false alarms in some frames, and the regions that they are shares of."""
        own, other = (np.where(relevant, np.where(changed, 2, 1), 0)[numbers]
                      for relevant, changed in ((srs, trs), (self.ideal.srs, self.ideal.trs)))
        later = numbers[numbers > 0]
        sent, wanted = (srs & trs)[later], self.ideal.active[later]
        both = (sent & wanted).sum()
        counts = np.array([own.size, wanted.sum(), sent.sum()])
        wrong = np.array([(own != other).sum(), counts[1] - both, counts[2] - both])
        return wrong / np.maximum(counts, 1), counts

    def expected(self, srs, trs, numbers):
        """Returns the rates to expect of other frames, and the regions that they are shares of."""
        share, counts = self.rates(srs, trs, numbers)
        groups = min(8, len(numbers))
        of_frame = np.arange(len(numbers)) * groups // len(numbers)
        without = np.array([self.rates(srs, trs, numbers[of_frame != group])[0] for group in range(groups)])
        error = np.sqrt((groups - 1) / groups * ((without - without.mean(0)) ** 2).sum(0))
        by_groups = share + STUDENT[groups - 2] * 2**0.5 * error
        half = np.maximum(counts / 2, 1e-9)
        square = NORMAL**2 / half
        spread = NORMAL * np.sqrt(share * (1 - share) / half + square / (4 * half))
        by_count = (share + square / 2 + spread) / (1 + square)
        by_count[0] = 0
        return np.minimum(np.maximum(by_groups, by_count), 1), counts

    def holds(self, srs, trs):
        """Returns whether decisions meet the limits in both parts. Most fail without a margin, which is faster."""
        if any((self.rates(srs, trs, part)[0] > self.limits).any() for part in self.parts):
            return False
        judged = [self.expected(srs, trs, part) for part in self.parts]
        return all((most <= self.limits).all() and (counts >= 49).all() for most, counts in judged)


def levels_around(level, factors, least):
    """Returns the levels around one, rounded to the nearest and down."""
    return sorted({max(least, int(level * factor + 0.5)) for factor in factors} | {max(least, int(level))})


def search_grid(comparison):
    """Returns the number of cameras of the grid, and thresholds for each depth, filter and window that meet the limits."""
    config, cameras, holding = comparison.config, 0, {}
    [feature] = config["spatial"]
    bits = config["frame"]["pixel_bits"]
    shapes = itertools.product(range(3, bits + 1), ("none", "median3x3", "switching3x3", "binomial3x3"), ("shared", "isolated"))
    for depth, denoise, windows in shapes:
        shift = bits - depth
        temporals = levels_around(config["temporal"]["level"] / 2**shift, (0.5, 0.75, 1, 1.25, 1.6), 0)
        levels = levels_around(feature["level"] / 2**shift, (0.85, 0.95, 1, 1.05, 1.15), 1)
        for changed, level in itertools.product(temporals, levels):
            found = comparison.run({
                "frame": {**config["frame"], "pixel_bits": depth},
                "region": {**config["region"], "neighborhood": windows},
                "denoise": {"filter": denoise},
                "temporal": {**config["temporal"], "level": changed},
                "spatial": [{**feature, "level": level, "min_score": 1}],
            }, shift)
            for least, pixels in itertools.product(MIN_SCORES, MIN_COUNTS):
                cameras += 1
                if comparison.holds(found.scores[feature["feature"]] >= least, found.changed >= pixels):
                    holding.setdefault((depth, denoise, windows), (changed, pixels, level, least))
    return cameras, holding


def cheapest_of_grid(result, holding):
    """Returns the cheapest of some cameras in the organization of the design that was found, and its cost."""
    costs = {}
    for (depth, denoise, windows), (changed, pixels, edge, least) in holding.items():
        with tempfile.NamedTemporaryFile("w", suffix=".toml") as file:
            file.write(result["design"]["toml"])
            file.flush()
            settings = [f"frame.pixel_bits={depth}", f'denoise.filter="{denoise}"', f'region.neighborhood="{windows}"',
                        f"temporal.level={changed}", f"temporal.min_count={pixels}",
                        f'spatial=[{{feature="edge",level={edge},min_score={least}}}]']
            options = [word for setting in settings for word in ("--set", setting)]
            run = subprocess.run([FOVEATE, "estimate", "--json", "--quiet", "--config", file.name, *options], capture_output=True, text=True,
                                 check=True)
        design = f"{depth} bits, {denoise}, {windows}; temporal {changed}, {pixels}; edge {edge}, {least}"
        costs[design] = cost(json.loads(run.stdout)["rcm"])
    best = min(costs, key=costs.get)
    return best, costs[best]


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("inputs", nargs="+", metavar="INPUT")
    parser.add_argument("--max-flips", default="3%")
    parser.add_argument("--grid", action="store_true")
    parser.add_argument("--options", default="", help="more options of `foveate fit`")
    arguments = parser.parse_args()
    arguments.options = arguments.options.split()
    table = csv.writer(sys.stdout, lineterminator="\n")
    table.writerow(COLUMNS)
    for path in arguments.inputs:
        result, message = fitted(path, arguments)
        name = os.path.basename(path)
        limit = arguments.max_flips.rstrip("%")
        if result is None:
            table.writerow([name, limit, message])
            continue
        design, held_out = result["design"], result["design"]["held_out"]
        outcome = "found" if result["feasible"] else "none"
        if result["feasible"] and not result["borne_out"]:
            outcome = "refuted"
        row = [name, limit, outcome, design["summary"], percent(cost(design["silicon"]["array"])), percent(held_out["action_flips"]),
               percent(held_out["missed"]), percent(held_out["false_alarms"]), result["considered"][0]]
        if arguments.grid:
            cameras, holding = search_grid(Comparison(result, path))
            row += [cameras, *(cheapest_of_grid(result, holding) if holding else ("none", ""))]
            row[-1] = percent(row[-1]) if holding else ""
        table.writerow(row)
        sys.stdout.flush()


if __name__ == "__main__":
    main()
