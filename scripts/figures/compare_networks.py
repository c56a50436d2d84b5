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


def widen(model):
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


def largest_difference(reference_outputs, outputs):
    """Returns the largest difference of any output, as a share of that output's largest value."""
    difference, start = 0.0, 0
    for value in reference_outputs:
        output = outputs[start:start + value.size]
        start += value.size
        value = value.astype(np.float32).ravel()
        largest = max(float(np.abs(value).max()), 0.01)
        difference = max(difference, float(np.abs(value - output).max()) / largest)
    if start != outputs.size:
        raise ValueError(f"onnxruntime makes {start} values, we {outputs.size}")
    return difference


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


def table_row(path, size, highest, outputs):
    """Returns the row of a network, and whether there is an error other than the difference."""
    model = onnx.load(path)
    constants = {tensor.name for tensor in model.graph.initializer}
    input_value = next(value for value in model.graph.input if value.name not in constants)
    is_half = input_value.type.tensor_type.elem_type == TensorProto.FLOAT16
    lengths = [dim.dim_value for dim in input_value.type.tensor_type.shape.dim]
    width, height = map(int, size.split("x")) if size else (lengths[3] or 640, lengths[2] or 360)
    channels = lengths[1]
    picture = np.random.default_rng(1).random((1, channels, height, width), dtype=np.float32) * np.float32(highest)
    with tempfile.TemporaryDirectory() as folder:
        files = [os.path.join(folder, name) for name in ("picture", "outputs")]
        picture.tofile(files[0])
        result = subprocess.run([outputs, path, f"{width}x{height}", *files], capture_output=True, text=True)
        if result.returncode:
            return [result.stderr.strip().removeprefix("Error: ")[:200], "", "", "", "", ""], 0.0, False
        own_outputs = np.fromfile(files[1], "<f4")
    properties = dict(line.split(" ", 1) for line in result.stdout.splitlines())
    wide_model = widen(onnx.load(path)).SerializeToString() if is_half else path
    reference_outputs, best = run(wide_model, picture)
    difference = largest_difference(reference_outputs, own_outputs)
    difference_text = f"{difference:.1e}" + (f" (in 16 bits {largest_difference(run(path, picture)[0], own_outputs):.1e})" if is_half else "")
    exact = "same" if properties["Exact"] == properties["Compare"] == "same" else properties["Exact"] + "; " + properties["Compare"]
    times = [f"{1e3 * best:.1f} ms", f"{float(properties['time']):.1f} ms", f"{1e5 * best / float(properties['time']):.0f} %"]
    return ["read", difference_text, exact, *times], difference, exact == "same"


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
        cells, difference, is_same = table_row(path, options.size, options.highest, outputs)
        is_right &= is_same and difference <= options.limit
        print("| " + " | ".join([os.path.splitext(os.path.basename(path))[0], *cells]) + " |", flush=True)
    sys.exit(not is_right)


if __name__ == "__main__":
    main()
