#!/usr/bin/env python3
# SPDX-License-Identifier: MIT OR Apache-2.0
"""Times `foveate infer` beside onnxruntime and tract, in one run.

    bench_networks.py FOLDER [NAME...] [--inputs INPUT...] [--frames N] [--rounds N] [--threads N...] [--tract PROGRAM]

FOLDER contains ONNX files, as scripts/figures/networks.py makes them. The programs take turns, and the best of the rounds counts: other work on the
machine only makes a time longer. Needs `foveate` on the path (or its path in FOVEATE), and onnxruntime. PROGRAM is what
`cargo build --release --manifest-path scripts/figures/tract_dense/Cargo.toml` makes; tract computes on one thread.
"""
import argparse
import glob
import json
import os
import subprocess
import tempfile
import time

import numpy as np
import onnxruntime


def infer(path, clip, size, mode, threads, options):
    """Returns the summary of a run."""
    width, height = size
    fit = ["--set", f"frame={{width={width},height={height}}}"] if clip.startswith("scene:") else ["--resize", f"{width}x{height}"]
    with tempfile.TemporaryDirectory() as folder:
        command = [os.environ.get("FOVEATE", "foveate"), "infer", path, clip, "-o", os.path.join(folder, "out"),
                   "--mode", mode, "--json", "--max-frames", str(options.frames), *fit]
        env = dict(os.environ, RAYON_NUM_THREADS=str(threads))
        return json.loads(subprocess.run(command, env=env, check=True, capture_output=True, text=True).stdout)


def session(path, threads):
    options = onnxruntime.SessionOptions()
    options.intra_op_num_threads, options.inter_op_num_threads = threads, 1
    return onnxruntime.InferenceSession(path, options, providers=["CPUExecutionProvider"])


def dense_time(runner, shape):
    """Returns the seconds of a frame in onnxruntime, the best of some runs."""
    name = runner.get_inputs()[0].name
    picture = np.random.default_rng(1).random(shape, dtype=np.float32)
    times = []
    for _ in range(5):
        start = time.perf_counter()
        runner.run(None, {name: picture})
        times.append(time.perf_counter() - start)
    return min(times)


def shape_of(runner):
    """Returns the shape of the frames; networks for any size get 640x360."""
    shape = runner.get_inputs()[0].shape
    return shape if all(isinstance(length, int) for length in shape) else [1, shape[1], 360, 640]


def tract_time(program, path, shape):
    """Returns the seconds of a frame in tract, the best of some runs."""
    command = [program, path, *map(str, shape)]
    return float(subprocess.run(command, check=True, capture_output=True, text=True).stdout)


def table_row(path, clip, threads, options):
    """Measures a network on a clip. Returns a row of the table."""
    runner = session(path, threads)
    shape = shape_of(runner)
    size = shape[3], shape[2]
    onnxruntime_times, tract_times, dense_times, exact_times = [], [], [], []
    for _ in range(options.rounds):
        onnxruntime_times.append(dense_time(runner, shape))
        if options.tract and threads == 1:
            tract_times.append(tract_time(options.tract, path, shape))
        dense_times.append(infer(path, clip, size, "dense", threads, options)["seconds_per_frame"])
        exact_times.append(infer(path, clip, size, "exact", threads, options))
    mask_time = min(run["overhead_seconds_per_frame"] for run in exact_times)
    first_run = exact_times[0]
    exact_times = [run["seconds_per_frame"] for run in exact_times]
    time_cells = [f"{1e3 * min(times):.1f} ms" if times else "" for times in (onnxruntime_times, tract_times, dense_times, exact_times, [mask_time])]
    if not options.tract:
        del time_cells[1]
    ratios = [f"{min(onnxruntime_times) / min(times):.2f}x" for times in (dense_times, exact_times)]
    # The share of computed blocks, and the time in relation to it.
    blocks = first_run["macs"]["scheduled"] / first_run["macs"]["whole"]
    shares = [f"{100 * first_run['changed_share']:.1f} %", f"{100 * blocks:.0f} %", f"{100 * min(exact_times) / min(dense_times):.0f} %"]
    name = os.path.splitext(os.path.basename(path))[0]
    label = os.path.basename(clip).rsplit(".", 1)[0]
    return [name, f"{size[0]}x{size[1]}", label, str(threads), *time_cells, *ratios, *shares]


def networks(folder, names):
    """Returns the ONNX files of a folder with these names, or all."""
    known = sorted(glob.glob(os.path.join(folder, "*.onnx")))
    if not known:
        raise ValueError(f"there is no ONNX file in `{folder}`; `scripts/figures/networks.py {folder}` makes some")
    by_name = {os.path.splitext(os.path.basename(path))[0]: path for path in known}
    for name in names:
        if name not in by_name:
            raise ValueError(f"there is no network `{name}` in `{folder}`; there are {', '.join(by_name)}")
    return [by_name[name] for name in names] or known


def main():
    parser = argparse.ArgumentParser(prog="bench_networks.py", description="Times `foveate infer` beside onnxruntime and tract.")
    parser.add_argument("folder")
    parser.add_argument("names", nargs="*", metavar="NAME", help="files without .onnx; by default all")
    parser.add_argument("--inputs", nargs="+", default=["scene:street"], help="clips (scene:street)")
    parser.add_argument("--frames", type=int, default=12)
    parser.add_argument("--rounds", type=int, default=3)
    parser.add_argument("--threads", type=int, nargs="+", default=[1])
    parser.add_argument("--tract", metavar="PROGRAM", help="what scripts/figures/tract_dense makes")
    options = parser.parse_args()
    try:
        paths = networks(options.folder, options.names)
    except ValueError as error:
        raise SystemExit(f"bench_networks: {error}") from None
    print(f"onnxruntime {onnxruntime.__version__}, {options.frames} frames\n")
    programs = ["onnxruntime", *(["tract"] if options.tract else []), "dense", "exact", "masks"]
    heads = ["network", "size", "clip", "threads", *programs, "dense / onnxruntime", "exact / onnxruntime", "changed", "blocks", "time"]
    print("| " + " | ".join(heads) + " |")
    print("| --- | --- | --- |" + " ---: |" * (len(heads) - 3))
    for path in paths:
        for clip in options.inputs:
            for threads in options.threads:
                print("| " + " | ".join(table_row(path, clip, threads, options)) + " |", flush=True)


if __name__ == "__main__":
    main()
