#!/usr/bin/env python3
# SPDX-License-Identifier: MIT OR Apache-2.0
"""Compares the clock estimated from a netlist with the one that nextpnr reaches on an ECP5. Prints the rows of docs/data/clock-ecp5.csv.

    scripts/figures/clock.py [--seeds N] [DESIGN...]     by default 5 seeds and every design

Each design is placed by `foveate estimate --place-and-route`, whose results are cached: a second run takes seconds.

FOVEATE                an executable to use instead of the debug build (scripts/checks/foveate.sh)
FOVEATE_NEXTPNR_ECP5   nextpnr for the ECP5 if it is not in PATH (scripts/python_tools.sh --route)
"""
import argparse
import json
import pathlib
import statistics
import subprocess
import sys

SOURCES = pathlib.Path(__file__).resolve().parents[2]
sys.path.insert(0, str(SOURCES / "scripts/checks"))
import features  # noqa: E402

DEVICE = "ecp5-85k"
MEDIAN = "denoise.filter='median3x3'"
DEEP = "hardware.pipelining='deep'"
RASTER = ["hardware.organization='raster'", "hardware.pixels_per_clock=1"]
# One lane for four regions of sixteen.
SERIAL = ["hardware.fold=4", "frame={width=32,height=32}"]


def designs():
    """Yields name, preset, changed keys and level of each design."""
    for feature in features.names("pipelined"):
        spatial = f"spatial=[{{feature='{feature}'}}]"
        yield f"pipelined {feature}", "bare", [spatial], "rpu"
        yield f"pipelined {feature} median", "bare", [spatial, MEDIAN], "rpu"
        yield f"pipelined {feature} deep", "bare", [spatial, DEEP], "rpu"
        yield f"pipelined {feature} median deep", "bare", [spatial, MEDIAN, DEEP], "rpu"
    for feature in features.names("serial"):
        yield f"serial {feature}", "serial", [f"spatial=[{{feature='{feature}'}}]", *SERIAL], "rcm"
        yield f"serial {feature} deep", "serial", [f"spatial=[{{feature='{feature}'}}]", *SERIAL, DEEP], "rcm"
    for feature in features.names("raster"):
        for pipelining in ["plain", "deep"]:
            keys = [f"spatial=[{{feature='{feature}'}}]", MEDIAN, *RASTER, f"hardware.pipelining='{pipelining}'"]
            yield f"raster {feature} median {pipelining}", "bare", keys, "rpu"


def place_and_route(foveate, preset, keys, level, seeds):
    """Returns the report of the command about a design."""
    command = [foveate, "estimate", "--place-and-route", DEVICE, "--seeds", str(seeds), "--level", level, "--preset", preset]
    command += [word for key in keys for word in ("--set", key)]
    run = subprocess.run([*command, "--json", "--quiet"], capture_output=True, text=True, check=False)
    if run.returncode:
        sys.exit(f"clock: `{' '.join(command)}` failed: {run.stderr.strip()}")
    return json.loads(run.stdout)["devices"][0]["placed"]


def table_row(name, placement):
    """Returns a line of the table, and the error of the estimate as a share of the reached clock."""
    fmax, estimate, critical_path = placement["fmax"], placement["estimate"], placement["critical"]
    error = estimate["mhz"] / fmax["median_mhz"] - 1
    cells = [name, *(f"{placement[key]['used']:,}" for key in ("logic", "ff", "block_ram"))]
    cells += [f"{fmax[key]:.1f}" for key in ("min_mhz", "median_mhz", "max_mhz")]
    cells += [f"{critical_path['from']['module']} to {critical_path['to']['module']}"]
    return "| " + " | ".join([*cells, f"{estimate['mhz']:.1f}", f"{100 * error:+.0f}%"]) + " |", error


def main():
    """Prints a line for each design, and the errors of all."""
    options = argparse.ArgumentParser(description=__doc__.split("\n", maxsplit=1)[0])
    options.add_argument("--seeds", type=int, default=5)
    options.add_argument("designs", nargs="*", metavar="DESIGN", help="such as 'serial edge'")
    options = options.parse_args()
    known = list(designs())
    unknown = set(options.designs) - {name for name, *_ in known}
    if unknown:
        sys.exit(f"clock: there is no design {sorted(unknown)[0]!r}; there are: {', '.join(name for name, *_ in known)}")
    foveate = subprocess.run([SOURCES / "scripts/checks/foveate.sh"], capture_output=True, text=True, check=True).stdout.strip()
    print("| design | LUT4 | FF | block RAM | slowest seed, MHz | median | fastest | longest path, modules | expected, MHz | error |")
    print("| --- | ---: | ---: | ---: | ---: | ---: | ---: | --- | ---: | ---: |")
    errors = []
    for name, preset, keys, level in known:
        if options.designs and name not in options.designs:
            continue
        line, error = table_row(name, place_and_route(foveate, preset, keys, level, options.seeds))
        print(line, flush=True)
        errors.append(error)
    within_count = sum(abs(error) <= 0.25 for error in errors)
    print(f"\n{len(errors)} designs; {within_count} within 25%; median error {100 * statistics.median(errors):+.0f}%, "
          f"largest {100 * max(errors, key=abs):+.0f}%.")


if __name__ == "__main__":
    main()
