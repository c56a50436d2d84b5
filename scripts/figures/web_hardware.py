#!/usr/bin/env python3
# SPDX-License-Identifier: MIT OR Apache-2.0
"""Writes web/hardware.json, from which the live page takes LUTs, clock and frames/s: `foveate estimate` (Yosys) of one raster core for
frames of 640x480, over region sizes, features, filters, and the reference and rendering of presets paper and fovea. 64 designs, half a minute
each; those that `foveate` has in its cache are not synthesized again.

    scripts/figures/web_hardware.py            with `foveate` of PATH, or of the environment FOVEATE
"""

import itertools
import json
import os
import subprocess
import sys
from pathlib import Path

sys.path.insert(0, str(Path(__file__).parents[1] / "checks"))
import features  # noqa: E402

FRAME = (640, 480)
SIZES = (8, 16)
FILTERS = ("none", "median3x3")
# Filters that are estimated only with the feature of presets paper and fovea.
OTHER_FILTERS = ("switching3x3", "binomial3x3")
PRESET_FEATURE = "edge"
# The reference, the rendering of irrelevant regions, and the name of the pair in the table.
SCREENS = (("previous", "zero", "zero"), ("last-sent", "mean", "mean2"))


def estimate(size: int, feature: str, denoise: str, reference: str, irrelevant: str) -> tuple[str, list]:
    """Returns the synthesizer's name, and LUT, FF, RAMB36, MHz and frames/s of a design."""
    keys = [
        f"frame={{width={FRAME[0]},height={FRAME[1]}}}",
        f"region.size={size}",
        f'spatial=[{{feature="{feature}"}}]',
        f'denoise.filter="{denoise}"',
        f'temporal.reference="{reference}"',
        f'render.irrelevant="{irrelevant}"',
    ]
    if irrelevant == "mean":
        keys.append("periphery.blocks=2")
    foveate = os.environ.get("FOVEATE", "foveate")
    command = [foveate, "estimate", "--preset", "raster", "--json", "--quiet"]
    result = subprocess.run(command + [part for key in keys for part in ("--set", key)], capture_output=True, text=True)
    if result.returncode:
        sys.exit(f"web_hardware: {' '.join(keys)}: {result.stderr.strip()}")
    report = json.loads(result.stdout)
    array, clock = report["rcm"], report["speed"]
    row = [array["lut_total_packed"], array["ff"], array["bram18"] / 2, round(clock["clock_mhz"]), round(clock["frames_per_second"])]
    return report["tool"]["version"].split(" (")[0], row


def main() -> None:
    tool, designs = "", []
    scores = [*itertools.product(features.names("raster"), FILTERS), *((PRESET_FEATURE, denoise) for denoise in OTHER_FILTERS)]
    for size, (feature, denoise), (reference, irrelevant, name) in itertools.product(SIZES, scores, SCREENS):
        tool, row = estimate(size, feature, denoise, reference, irrelevant)
        designs.append([size, feature, denoise, reference, name, *row])
        print(*designs[-1], file=sys.stderr)
    head = json.dumps(
        {
            "tool": tool,
            "frame": FRAME,
            "columns": ["region.size", "feature", "filter", "reference", "irrelevant", "lut", "ff", "ramb36", "mhz", "frames_per_second"],
        }
    )
    rows = ",\n".join(json.dumps(row) for row in designs)
    path = Path(__file__).parents[2] / "web/hardware.json"
    path.write_text(f'{head[:-1]}, "designs": [\n{rows}\n]}}\n')


if __name__ == "__main__":
    main()
