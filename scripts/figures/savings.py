#!/usr/bin/env python3
# SPDX-License-Identifier: MIT OR Apache-2.0
"""Measures what the masks of the camera save networks, for the tables of docs/savings.md.

    savings.py FOLDER [NAME...] [--clips CLIP...] [--frames N] [--tune GOAL]
    savings.py FOLDER [NAME...] [--clips CLIP...] [--frames N] --accelerators ACCELERATOR...

FOLDER contains ONNX files, as scripts/figures/networks.py makes them. A row has the figures of a network and a clip over the second half of the
frames: the share of regions that changed, and the shares of the MACs that were needed in the modes exact and compare and with --tune, whose search
did not use these frames, and the error with --tune. With --accelerators, a row has the cost of a whole frame on an accelerator, and the share of it
that is left in the mode exact.

Runs two at a time. Needs onnx, and `foveate` on the path (or its path in FOVEATE).
"""
import argparse
import concurrent.futures
import csv
import glob
import json
import os
import subprocess
import tempfile

import onnx

# The size of the frames for networks that take any size.
OPEN_SIZE = (640, 360)
MODES = (["--mode", "exact"], ["--mode", "compare"])


def size_of(path):
    """Returns width and height of the frames that a network takes."""
    shape = [length.dim_value for length in onnx.load(path, load_external_data=False).graph.input[0].type.tensor_type.shape.dim]
    return (shape[3], shape[2]) if shape[2] and shape[3] else OPEN_SIZE


def label(clip):
    """Returns the name of a clip in the table."""
    return os.path.basename(clip).rsplit(".", 1)[0]


def infer(path, clip, size, frames, options):
    """Returns the summary of a run."""
    width, height = size
    input_options = ["--set", f"frame={{width={width},height={height}}}"] if clip.startswith("scene:") else ["--resize", f"{width}x{height}"]
    if min(size) < 64:
        input_options += ["--set", "region.size=4"]
    with tempfile.TemporaryDirectory() as folder:
        command = [os.environ.get("FOVEATE", "foveate"), "infer", path, clip, "-o", os.path.join(folder, "out"), "--json", "--quiet",
                   "--max-frames", str(frames), *input_options, *options]
        result = subprocess.run(command, capture_output=True, text=True, env=dict(os.environ, RAYON_NUM_THREADS="1"))
        if result.returncode != 0:
            raise SystemExit(f"savings: {' '.join(command)}: {result.stderr.strip()}")
        with open(os.path.join(folder, "out", "frames.csv"), newline="") as table:
            return json.loads(result.stdout), list(csv.DictReader(table))


def needed_share(rows, frames):
    """Returns the share of the MACs over the counted frames of the second half, whose first frame is computed whole with --tune."""
    counted_rows = [row for row in rows if int(row["frame"]) > frames // 2]
    return sum(float(row["macs_needed"]) for row in counted_rows) / sum(float(row["macs_dense"]) for row in counted_rows)


def table_row(path, clip, options):
    """Returns a row of the table."""
    size = size_of(path)
    runs = [infer(path, clip, size, options.frames, mode) for mode in (*MODES, ["--tune", options.tune])]
    shares = [f"{100 * needed_share(rows, options.frames):.1f} %" for _, rows in runs]
    tuned = runs[-1][0]
    error = tuned["error"]
    cells = [os.path.basename(path).removesuffix(".onnx"), f"{size[0]}x{size[1]}", label(clip),
             f"{100 * tuned['changed_share']:.1f} %", *shares,
             f"{100 * error['rms_of_variation']:.1f} %" + ("" if tuned["tuning"]["holds"] else " (missed)"), f"{100 * error['relative_rms']:.2g} %"]
    return f"| {' | '.join(cells)} |"


def accelerator_row(path, clip, name, options):
    """Returns a row of the table of an accelerator."""
    size = size_of(path)
    summary, _ = infer(path, clip, size, options.frames, ["--accelerator", name])
    whole, masked = (summary["accelerator"][key] for key in ("whole", "masked"))
    cells = [os.path.basename(path).removesuffix(".onnx"), label(clip), name, f"{100 * summary['macs']['needed'] / summary['macs']['dense']:.1f} %"]
    for key, scale in (("seconds", 1e3), ("energy_mj", 1), ("dram_accesses", 1e-6)):
        whole_cost = scale * whole[key]
        cells += [f"{whole_cost:,.0f}" if whole_cost >= 100 else f"{whole_cost:.3g}", f"{100 * masked[key] / whole[key]:.1f} %"]
    return f"| {' | '.join(cells)} |"


def main():
    parser = argparse.ArgumentParser(prog="savings.py", description="What the masks of the camera save networks.")
    parser.add_argument("folder")
    parser.add_argument("names", nargs="*", metavar="NAME", help="files without .onnx; by default all")
    parser.add_argument("--clips", nargs="+", default=["scene:street"], help="clips (%(default)s)")
    parser.add_argument("--frames", type=int, default=12)
    parser.add_argument("--tune", default="variation=10%", help="the goal of --tune (%(default)s)".replace("10%", "10%%"))
    parser.add_argument("--accelerators", nargs="+", default=[], help="instead of the modes: what frames cost there")
    options = parser.parse_args()
    paths = [os.path.join(options.folder, f"{name}.onnx") for name in options.names] or sorted(glob.glob(os.path.join(options.folder, "*.onnx")))
    goal = "" if options.accelerators else f", --tune {options.tune}"
    print(f"{options.frames} frames{goal}\n")
    if options.accelerators:
        print("| network | clip | accelerator | MACs needed | ms per frame | masked | mJ per frame | masked | M DRAM accesses | masked |")
        print("| --- | --- | --- | ---: | ---: | ---: | ---: | ---: | ---: | ---: |", flush=True)
    else:
        print("| network | size | clip | changed | exact | compare | tuned | error, of variation | error, of values |")
        print("| --- | --- | --- | ---: | ---: | ---: | ---: | ---: | ---: |", flush=True)
    with concurrent.futures.ThreadPoolExecutor(2) as pool:
        jobs = []
        for path, clip in ((path, clip) for path in paths for clip in options.clips):
            if options.accelerators:
                jobs += [pool.submit(accelerator_row, path, clip, name, options) for name in options.accelerators]
            else:
                jobs.append(pool.submit(table_row, path, clip, options))
        for job in jobs:
            print(job.result(), flush=True)


if __name__ == "__main__":
    main()
