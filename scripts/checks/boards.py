#!/usr/bin/env python3
# SPDX-License-Identifier: MIT OR Apache-2.0
"""Called by boards.sh: builds the boards with `foveate build`, and writes a row for each."""
import csv
import json
import os
import statistics
import subprocess
import sys
import tempfile

FOVEATE = os.environ["FOVEATE"]
SEEDS = os.environ.get("SEEDS", "5")
TABLE = "docs/data/boards.csv"
# The names in nextpnr of logic, separate flip-flops, block RAM and large RAM, by family.
LOGIC = ["ICESTORM_LC", "TRELLIS_COMB", "LUT4"]
BLOCKS = ["ICESTORM_RAM", "DP16KD", "BSRAM"]
LARGE = ["ICESTORM_SPRAM"]


def open_boards():
    """Returns the names of the boards that need no Vivado."""
    descriptions = json.loads(subprocess.run([FOVEATE, "build", "--list", "--json"], check=True, capture_output=True).stdout)
    return [board["name"] for board in descriptions if not board["part"].startswith("xc")]


def cell_use(build, names):
    for cell in build["used"]:
        if cell["cell"] in names:
            return f"{cell['used']} of {cell['available']}"
    return ""


def board_row(name):
    with tempfile.TemporaryDirectory() as folder:
        command = [FOVEATE, "build", "--board", name, "-o", f"{folder}/out", "--seeds", SEEDS, "--json"]
        run = subprocess.run(command, stdout=subprocess.PIPE)
        # A board that is too slow gets a row, too.
        if run.returncode not in (0, 1) or not run.stdout:
            run.check_returncode()
        build = json.loads(run.stdout)
    clocks = build["reached_mhz"]
    return {
        "board": name,
        "logic": cell_use(build, LOGIC),
        "block RAM": cell_use(build, BLOCKS),
        "large RAM": cell_use(build, LARGE),
        "clock needed, MHz": build["core_mhz"],
        "slowest seed": min(clocks),
        "median": statistics.median_low(clocks),
        "fastest": max(clocks),
        "seeds": len(clocks),
        "sensor needed, MHz": build["pclk_mhz"],
        "sensor reached": build["pclk_reached_mhz"],
        "bytes": build["bytes"],
    }


def main():
    names = sys.argv[1:] or open_boards()
    unknown = [name for name in names if name not in open_boards()]
    if unknown:
        print(f"boards: no open tools for {', '.join(unknown)}; use {', '.join(open_boards())}", file=sys.stderr)
        return 2
    rows = []
    for name in names:
        rows.append(board_row(name))
        print(*(f"{key} {value}" for key, value in rows[-1].items() if value != ""), sep=", ", flush=True)
    if not sys.argv[1:]:
        with open(TABLE, "w", newline="") as file:
            table = csv.DictWriter(file, list(rows[0]), lineterminator="\n")
            table.writeheader()
            table.writerows(rows)
    return 0


if __name__ == "__main__":
    sys.exit(main())
