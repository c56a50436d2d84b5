#!/usr/bin/env python3
# SPDX-License-Identifier: MIT OR Apache-2.0
"""Compares networks with onnxruntime: tests whether each is read, how far its outputs are from onnxruntime's, and whether partial
results are equal to those of whole frames, bit by bit.

    compare_networks.py FILE.onnx... [--size WIDTHxHEIGHT] [--highest H] [--limit L]

The input is noise from 0 to H (1). The difference is the largest of any output, as a share of that output's largest value (of 0.01 at least);
above the limit (1e-4) the script fails, and so it does if a partial result differs from the whole. A network of 16-bit values is compared
with its form of 32 bits, and also as it is. Times are those of one thread. Needs onnxruntime and onnx, and the example `outputs` of crates/network
(its path in OUTPUTS, or cargo builds it).
"""
import argparse
import os
import subprocess
import sys
import tempfile
import time

import numpy as np
import onnx
import onnxruntime
from onnx import TensorProto, numpy_helper

ROOT = os.path.dirname(os.path.dirname(os.path.dirname(os.path.abspath(__file__))))


def program():
    """Returns the path of the example `outputs`."""
    if "OUTPUTS" in os.environ:
        return os.environ["OUTPUTS"]
    subprocess.run(["cargo", "build", "--release", "--quiet", "-p", "foveate-network", "--example", "outputs"], cwd=ROOT, check=True)
    return os.path.join(os.environ.get("CARGO_TARGET_DIR", os.path.join(ROOT, "target")), "release", "examples", "outputs")


def widened(model):
    """Returns a network with 32-bit values in place of 16-bit ones."""
    for value in [*model.graph.input, *model.graph.output, *model.graph.value_info]:
        if value.type.tensor_type.elem_type == TensorProto.FLOAT16:
            value.type.tensor_type.elem_type = TensorProto.FLOAT
    for tensor in model.graph.initializer:
        if tensor.data_type == TensorProto.FLOAT16:
            tensor.CopyFrom(numpy_helper.from_array(numpy_helper.to_array(tensor).astype(np.float32), tensor.name))
    for node in model.graph.node:
        for attribute in node.attribute:
            if node.op_type == "Cast" and attribute.name == "to" and attribute.i == TensorProto.FLOAT16:
                attribute.i = TensorProto.FLOAT
    return model


def apart(theirs, ours):
    """Returns the largest difference of any output, as a share of that output's largest value."""
    found, start = 0.0, 0
    for value in theirs:
        part = ours[start:start + value.size]
        start += value.size
        value = value.astype(np.float32).ravel()
        largest = max(float(np.abs(value).max()), 0.01)
        found = max(found, float(np.abs(value - part).max()) / largest)
    if start != ours.size:
        raise ValueError(f"onnxruntime makes {start} values, we {ours.size}")
    return found


def run(model, picture):
    """Returns the outputs of onnxruntime for a frame, and the time."""
    options = onnxruntime.SessionOptions()
    options.intra_op_num_threads = options.inter_op_num_threads = 1
    options.log_severity_level = 3
    session = onnxruntime.InferenceSession(model, options, providers=["CPUExecutionProvider"])
    kind = {"tensor(float16)": np.float16}.get(session.get_inputs()[0].type, np.float32)
    feed = {session.get_inputs()[0].name: picture.astype(kind)}
    outputs, best = session.run(None, feed), float("inf")
    for _ in range(5):
        start = time.perf_counter()
        session.run(None, feed)
        best = min(best, time.perf_counter() - start)
    return outputs, best


def row(path, size, highest, outputs):
    """Returns the row of a network, and whether there is an error other than the difference."""
    model = onnx.load(path)
    constants = {tensor.name for tensor in model.graph.initializer}
    given = next(value for value in model.graph.input if value.name not in constants)
    is_half = given.type.tensor_type.elem_type == TensorProto.FLOAT16
    lengths = [dim.dim_value for dim in given.type.tensor_type.shape.dim]
    width, height = map(int, size.split("x")) if size else (lengths[3] or 640, lengths[2] or 360)
    channels = lengths[1]
    picture = np.random.default_rng(1).random((1, channels, height, width), dtype=np.float32) * np.float32(highest)
    with tempfile.TemporaryDirectory() as folder:
        files = [os.path.join(folder, name) for name in ("picture", "outputs")]
        picture.tofile(files[0])
        done = subprocess.run([outputs, path, f"{width}x{height}", *files], capture_output=True, text=True)
        if done.returncode:
            return [done.stderr.strip().removeprefix("Error: ")[:200], "", "", "", "", ""], 0.0, False
        ours = np.fromfile(files[1], "<f4")
    said = dict(line.split(" ", 1) for line in done.stdout.splitlines())
    wide = widened(onnx.load(path)).SerializeToString() if is_half else path
    theirs, best = run(wide, picture)
    found = apart(theirs, ours)
    shown = f"{found:.1e}" + (f" (in 16 bits {apart(run(path, picture)[0], ours):.1e})" if is_half else "")
    exact = "same" if said["Exact"] == said["Compare"] == "same" else said["Exact"] + "; " + said["Compare"]
    times = [f"{1e3 * best:.1f} ms", f"{float(said['time']):.1f} ms", f"{1e5 * best / float(said['time']):.0f} %"]
    return ["read", shown, exact, *times], found, exact == "same"


def main():
    parser = argparse.ArgumentParser(prog="compare_networks.py", description="Compares networks with onnxruntime.")
    parser.add_argument("files", nargs="+", metavar="FILE.onnx")
    parser.add_argument("--size", help="WIDTHxHEIGHT of the picture, for networks that take any (640x360)")
    parser.add_argument("--highest", type=float, default=1.0, help="the largest value of the input (1)")
    parser.add_argument("--limit", type=float, default=1e-4)
    options = parser.parse_args()
    outputs, is_right = program(), True
    print(f"onnxruntime {onnxruntime.__version__}\n")
    print("| network | | difference | exact, compare | onnxruntime | dense | speed |\n| --- | --- | ---: | --- | ---: | ---: | ---: |")
    for path in options.files:
        cells, found, is_same = row(path, options.size, options.highest, outputs)
        is_right &= is_same and found <= options.limit
        print("| " + " | ".join([os.path.splitext(os.path.basename(path))[0], *cells]) + " |", flush=True)
    sys.exit(not is_right)


if __name__ == "__main__":
    main()
