#!/usr/bin/env python3
# SPDX-License-Identifier: MIT OR Apache-2.0
"""Times `foveate infer` beside onnxruntime, in one run.

    bench_networks.py FOLDER [NAME...] [--input INPUT] [--frames N] [--rounds N] [--threads N...]

FOLDER holds ONNX files, as scripts/networks.py makes them. The programs take turns, and the best of the rounds counts: other work on the
machine only makes a time longer. Needs `foveate` on the path (or its path in FOVEATE), and onnxruntime.
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


def infer(path, size, mode, threads, options):
    """The summary of a run."""
    width, height = size
    is_scene = options.input.startswith("scene:")
    fit = ["--set", f"frame={{width={width},height={height}}}"] if is_scene else ["--resize", f"{width}x{height}"]
    with tempfile.TemporaryDirectory() as folder:
        command = [os.environ.get("FOVEATE", "foveate"), "infer", path, options.input, "-o", os.path.join(folder, "out"),
                   "--mode", mode, "--json", "--max-frames", str(options.frames), *fit]
        env = dict(os.environ, RAYON_NUM_THREADS=str(threads))
        return json.loads(subprocess.run(command, env=env, check=True, capture_output=True, text=True).stdout)


def session(path, threads):
    options = onnxruntime.SessionOptions()
    options.intra_op_num_threads, options.inter_op_num_threads = threads, 1
    return onnxruntime.InferenceSession(path, options, providers=["CPUExecutionProvider"])


def dense_time(runner, shape):
    """Seconds of a picture in onnxruntime, the best of some."""
    name = runner.get_inputs()[0].name
    picture = np.random.default_rng(1).random(shape, dtype=np.float32)
    times = []
    for _ in range(5):
        start = time.perf_counter()
        runner.run(None, {name: picture})
        times.append(time.perf_counter() - start)
    return min(times)


def main():
    parser = argparse.ArgumentParser(prog="bench_networks.py", description="Times `foveate infer` beside onnxruntime.")
    parser.add_argument("folder")
    parser.add_argument("names", nargs="*", metavar="NAME", help="files without .onnx; by default all")
    parser.add_argument("--input", default="scene:street", help="a clip (%(default)s)")
    parser.add_argument("--frames", type=int, default=12)
    parser.add_argument("--rounds", type=int, default=3)
    parser.add_argument("--threads", type=int, nargs="+", default=[1])
    options = parser.parse_args()
    paths = [os.path.join(options.folder, f"{name}.onnx") for name in options.names] or sorted(glob.glob(os.path.join(options.folder, "*.onnx")))
    print(f"onnxruntime {onnxruntime.__version__}, {options.input}, {options.frames} frames\n")
    print("| network | size | threads | onnxruntime | dense | exact | dense / onnxruntime | exact / onnxruntime | changed | MACs computed |")
    print("| --- | --- | ---: | ---: | ---: | ---: | ---: | ---: | ---: | ---: |")
    for path in paths:
        for threads in options.threads:
            runner = session(path, threads)
            shape = runner.get_inputs()[0].shape
            size = [shape[3], shape[2]]
            if not all(isinstance(length, int) for length in shape):
                size = [640, 360]
                shape = [1, shape[1], 360, 640]
            theirs, dense, exact = [], [], []
            for _ in range(options.rounds):
                theirs.append(dense_time(runner, shape))
                dense.append(infer(path, size, "dense", threads, options))
                exact.append(infer(path, size, "exact", threads, options))
            milliseconds = [1e3 * min(theirs), *(1e3 * min(run["seconds_per_frame"] for run in runs) for runs in (dense, exact))]
            found = exact[0]
            share = found["macs"]["scheduled"] / found["macs"]["dense"]
            name = os.path.splitext(os.path.basename(path))[0]
            times = " | ".join(f"{value:.1f} ms" for value in milliseconds)
            ratios = " | ".join(f"{milliseconds[0] / value:.2f}x" for value in milliseconds[1:])
            shares = f"{100 * found['changed_share']:.1f} % | {100 * share:.0f} %"
            print(f"| {name} | {size[0]}x{size[1]} | {threads} | {times} | {ratios} | {shares} |", flush=True)


if __name__ == "__main__":
    main()
