#!/usr/bin/env python3
# SPDX-License-Identifier: MIT OR Apache-2.0
"""Compares designs that `foveate fit` finds with a search over all cameras of a grid, as CSV on standard output.

    fits.py [--max-flips 3%] [--grid] INPUT...

Each input is a clip in grey that `fit` gets alone. The columns are the cost of the design that was found, as a percentage of an XCVU9P, and its
flips, missed regions and false alarms on the second half. With --grid, all cameras with the task's feature and regions are tried, too: every
depth from 3 bits, filter and window, with levels and minima around those of the task. Rates and their margins are computed here from the
scores of the Python package, and a camera must meet all limits in the searched part, in the part that confirms, and so in the first half. The
cheapest of these cameras is synthesized in the organization of the design that was found.

Needs `foveate` on the path (or its path in FOVEATE), and with --grid NumPy and the package foveate.
"""
import argparse
import csv
import json
import os
import subprocess
import sys
import tempfile
import tomllib

FOVEATE = os.environ.get("FOVEATE", "foveate")
COLUMNS = ["input", "max_flips_percent", "result", "design", "cost_percent", "flips_percent", "missed_percent", "false_alarms_percent",
           "cameras", "grid_cameras", "grid_design", "grid_cost_percent"]
# Quantiles of Student's t and of a normal variable: 19 of 20 values are below.
STUDENT = [6.314, 2.920, 2.353, 2.132, 2.015, 1.943, 1.895]
NORMAL = 1.645
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


def grid_rows(result, path):
    """Yields the settings of cameras of the grid that meet the limits, without repeated hardware, and the number of all cameras."""
    import numpy as np

    import foveate as fv

    config = {key: table for key, table in tomllib.loads(result["task"]).items() if key != "hardware"}
    frames = np.stack([outcome.frame for outcome in fv.simulate(path, config)])
    half = len(frames) // 2
    searched = -(-2 * half // 3)
    parts = [slice(0, searched), slice(searched, half)]
    side = config["region"]["size"]
    exact = {**config, "region": {**config["region"], "neighborhood": "shared"}}
    ideal = fv.Camera(exact).run(frames[:half], rendered=False, progress=False)
    limits = {check["name"]: check["limit"] for check in result["design"]["fitted_held"]}
    names = ("max-flips", "max-missed", "max-false-alarms")
    feature = config["spatial"][0]["feature"]
    first = np.zeros(half, bool)
    first[0] = True

    def rates(srs, trs, part, left_out=None):
        """Returns flips, missed and false alarms of a part, and the regions that they are shares of."""
        numbers = np.arange(half)[part]
        if left_out is not None:
            groups = min(8, len(numbers))
            numbers = numbers[np.arange(len(numbers)) * groups // len(numbers) != left_out]
        def action(relevant, changed):
            return np.where(relevant, np.where(changed, 2, 1), 0)
        own, other = action(srs, trs)[numbers], action(ideal.srs, ideal.trs)[numbers]
        later = numbers[~first[numbers]]
        sent, wanted = (srs & trs)[later], ideal.active[later]
        both = (sent & wanted).sum()
        return np.array([(own != other).mean(), 1 - both / max(wanted.sum(), 1) if wanted.any() else 0,
                         1 - both / max(sent.sum(), 1) if sent.any() else 0]), (own.size, wanted.sum(), sent.sum())

    def expected(srs, trs, part):
        """Returns the rates to expect of other frames."""
        share, regions = rates(srs, trs, part)
        count = min(8, len(range(half)[part]))
        without = np.array([rates(srs, trs, part, group)[0] for group in range(count)])
        error = np.sqrt((count - 1) / count * ((without - without.mean(0)) ** 2).sum(0))
        most = share + STUDENT[count - 2] * 2**0.5 * error
        for rate in (1, 2):
            n = max(regions[rate] / 2, 1e-9)
            square = NORMAL**2 / n
            spread = NORMAL * (share[rate] * (1 - share[rate]) / n + square / (4 * n)) ** 0.5
            most[rate] = min(max(most[rate], (share[rate] + square / 2 + spread) / (1 + square)), 1)
        return most, min(regions)

    cameras, holding = 0, {}
    bits = config["frame"]["pixel_bits"]
    for depth in range(3, bits + 1):
        shift = bits - depth
        temporal = config["temporal"]["level"] / 2**shift
        level = config["spatial"][0].get("level", 0) / 2**shift
        temporals = sorted({max(0, int(temporal * factor + 0.5)) for factor in (0.5, 0.75, 1, 1.25, 1.6)} | {max(0, int(temporal))})
        levels = sorted({max(1, int(level * factor + 0.5)) for factor in (0.85, 0.95, 1, 1.05, 1.15)} | {int(level)})
        for denoise in ("none", "median3x3", "switching3x3", "binomial3x3"):
            for windows in ("shared", "isolated"):
                shape = (depth, denoise, windows)
                for changed in temporals:
                    for edge in levels:
                        camera = fv.Camera({**config, "frame": {**config["frame"], "pixel_bits": depth},
                                            "region": {"size": side, "neighborhood": windows}, "denoise": {"filter": denoise},
                                            "temporal": {**config["temporal"], "level": changed},
                                            "spatial": [{"feature": feature, "level": edge, "min_score": 1}]})
                        found = camera.run(frames[:half] >> shift, rendered=False, progress=False)
                        scores, counts = found.scores[feature], found.changed
                        for least in (2, 3, 4, 5, 6, 7, 8):
                            for pixels in (1, 2, 3, 4, 5, 6, 8, 10):
                                cameras += 1
                                srs, trs = scores >= least, counts >= pixels
                                # Most cameras fail without a margin.
                                shares = [rates(srs, trs, part)[0] for part in parts]
                                if any(share > limits[name] for part in shares for share, name in zip(part, names)):
                                    continue
                                judged = [expected(srs, trs, part) for part in parts]
                                if all(count >= 49 and all(rate <= limits[name] for rate, name in zip(most, names)) for most, count in judged):
                                    holding.setdefault(shape, (changed, pixels, edge, least))
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
            cameras, holding = grid_rows(result, path)
            row += [cameras, *(cheapest_of_grid(result, holding) if holding else ("none", ""))]
            row[-1] = percent(row[-1]) if holding else ""
        table.writerow(row)
        sys.stdout.flush()


if __name__ == "__main__":
    main()
