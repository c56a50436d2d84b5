#!/usr/bin/env python3
# SPDX-License-Identifier: MIT OR Apache-2.0
"""Measures Camera.step against the engine without Python, and against a numpy + OpenCV pipeline in the same process.

    scripts/figures/bench_python.py THROUGHPUT ANCHOR [ROUNDS]

THROUGHPUT is the engine's example (cargo build --release -p foveate-engine --example throughput), ANCHOR a folder with cv_pipeline.py and
make_clip.py. Needs the package built for release (pip install .), numpy and opencv-python-headless. Everything runs on one thread, in turn;
each figure is the mean of the faster half of the frames, and the best of the rounds counts.
"""
import importlib.util
import json
import pathlib
import subprocess
import sys
import tempfile
import time

import cv2
import numpy as np

import foveate as fv

CASES = [("1920x1080", 32, 40), ("640x360", 8, 100), ("224x224", 8, 300)]
SECONDS = 0.8


def seconds_per_frame(step, frames):
    """Returns the mean of the faster half of the frames, as cv_pipeline.py and the engine's example compute it."""
    times, first_start, number = [], time.perf_counter(), 0
    while time.perf_counter() - first_start < SECONDS or number < 5:
        frame = frames[number % len(frames)]
        start = time.perf_counter()
        step(frame)
        times.append(time.perf_counter() - start)
        number += 1
    times = sorted(times)[: (len(times) + 1) // 2]
    return sum(times) / len(times)


def step_with_results(camera):
    """Runs a step, and reads its decisions, scores and screen."""

    def step(frame):
        outcome = camera.step(frame)
        return outcome.active, outcome.scores, outcome.changed, outcome.rendered

    return step


def main():
    throughput, anchor = sys.argv[1], pathlib.Path(sys.argv[2])
    rounds = int(sys.argv[3]) if len(sys.argv) > 3 else 3
    spec = importlib.util.spec_from_file_location("cv_pipeline", anchor / "cv_pipeline.py")
    pipeline = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(pipeline)
    cv2.setNumThreads(1)
    print("| frame | N | engine, ms | Camera.step | of the engine's speed | and everything read | OpenCV | Camera.step / OpenCV |")
    print("| --- | ---: | ---: | ---: | ---: | ---: | ---: | ---: |")
    with tempfile.TemporaryDirectory() as folder:
        for size, side, count in CASES:
            width, height = size.split("x")
            clip = pathlib.Path(folder) / f"{size}.npy"
            subprocess.run([sys.executable, anchor / "make_clip.py", clip, width, height, str(count)], check=True, stdout=subprocess.DEVNULL)
            frames = np.load(clip)
            times = {"engine": [], "step": [], "read": [], "opencv": []}
            for _ in range(rounds):
                command = [throughput, clip, "--side", str(side), "--features", "edge", "--seconds", str(SECONDS)]
                engine_run = json.loads(subprocess.run(command, check=True, capture_output=True).stdout)
                times["engine"].append(frames[0].size / engine_run["mpixel_s"] / 1e6)
                design = {"region": {"size": side, "neighborhood": "shared"}}
                times["step"].append(seconds_per_frame(fv.Camera(design).step, frames))
                times["read"].append(seconds_per_frame(step_with_results(fv.Camera(design)), frames))
                times["opencv"].append(seconds_per_frame(pipeline.RCM(side, "edge").step, frames))
            best = {name: min(values) for name, values in times.items()}
            print(
                f"| {size} | {side} | {1e3 * best['engine']:.3f} | {1e3 * best['step']:.3f} | {best['engine'] / best['step']:.2f}x"
                f" | {1e3 * best['read']:.3f} | {1e3 * best['opencv']:.3f} | {best['opencv'] / best['step']:.1f}x |",
                flush=True,
            )


if __name__ == "__main__":
    main()
