#!/usr/bin/env python3
# SPDX-License-Identifier: MIT OR Apache-2.0
"""Measures the area of cores on AXI, part by part, with `foveate estimate`. Writes docs/data/axi-area.csv and prints its rows.

    scripts/figures/axi_area.py

FOVEATE   the program (default: built by scripts/checks/foveate.sh)
"""
import csv
import json
import os
import subprocess
import sys

TABLE = "docs/data/axi-area.csv"
FRAME = ["--preset", "raster", "--set", "hardware.interface='axi'", "--set", "frame={width=1920,height=1080}"]
OUTSIDE = ["--set", "hardware.store='external'"]
MEANS = ["--set", "render.irrelevant='mean'"]
DESIGNS = {
    "pixels alone": OUTSIDE,
    "pixels and means": OUTSIDE + MEANS,
}


def area_rows(program, name, settings):
    """Yields the areas of the parts of a core and of the whole core; a LUT may hold two shift registers."""
    run = subprocess.run([program, "estimate", "--json", "--quiet", *FRAME, *settings], check=True, capture_output=True, text=True)
    report = json.loads(run.stdout)
    bus = report["bus"]
    parts = [("array (rcm)", report["rcm"])] + [(part["name"], part["area"]) for part in bus["parts"]]
    for part, area in [*parts, ("whole (rcm_axi)", bus["whole"])]:
        yield {
            "core": name,
            "part": part,
            "lut": area["lut_total_packed"],
            "of_them_memory": area["lut_memory_packed"],
            "ff": area["ff"],
            "ramb36": f"{area['bram18'] / 2:g}",
        }


def main():
    os.chdir(os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", ".."))
    program = os.environ.get("FOVEATE") or subprocess.run(["scripts/checks/foveate.sh"], check=True, capture_output=True, text=True).stdout.strip()
    rows = [row for name, settings in DESIGNS.items() for row in area_rows(program, name, settings)]
    with open(TABLE, "w", newline="", encoding="utf-8") as file:
        table = csv.DictWriter(file, list(rows[0]), lineterminator="\n")
        table.writeheader()
        table.writerows(rows)
    print(open(TABLE, encoding="utf-8").read(), end="")
    return 0


if __name__ == "__main__":
    sys.exit(main())
