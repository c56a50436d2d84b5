#!/usr/bin/env python3
# SPDX-License-Identifier: MIT OR Apache-2.0
"""Makes a network of 8-bit integers from one of floating-point values.

    quantize.py FILE.onnx OUT.onnx [--format qoperator|qdq] [--size WIDTHxHEIGHT] [--golden PREFIX]

--golden also writes a frame of bytes, PREFIX.picture, and the outputs of onnxruntime for it, as 32-bit floating-point values, PREFIX.output.

Needs onnx and onnxruntime, whose quantization this is: static, with a scale per channel of the weights. The ranges of the tensors come from
pictures of noise of different brightness and fineness, from a fixed seed.
"""
import argparse
import os
import tempfile

import numpy as np
import onnx
import onnxruntime
from onnxruntime import quantization
from onnxruntime.quantization.shape_inference import quant_pre_process

FORMATS = {"qoperator": quantization.QuantFormat.QOperator, "qdq": quantization.QuantFormat.QDQ}
PICTURES = 16


class Pictures(quantization.CalibrationDataReader):
    """Yields frames of blocks of noise, from 0 to 1."""

    def __init__(self, name, shape):
        random = np.random.default_rng(1)
        _, channels, height, width = shape

        def picture(number):
            side = 1 << number % 4
            blocks = random.random((1, channels, -(-height // side), -(-width // side)), dtype=np.float32)
            fine = blocks.repeat(side, 2).repeat(side, 3)[:, :, :height, :width]
            return {name: fine * random.random(dtype=np.float32)}

        self.rest = iter([picture(at) for at in range(PICTURES)])

    def get_next(self):
        return next(self.rest, None)


def quantize(path, out, kind, size=None):
    """Writes a quantized form of a network; `size` is the width and height if the network leaves them open."""
    picture = onnx.load(path).graph.input[0]
    lengths = [dim.dim_value for dim in picture.type.tensor_type.shape.dim]
    width, height = size or (lengths[3], lengths[2])
    shape = [1, lengths[1], lengths[2] or height, lengths[3] or width]
    with tempfile.TemporaryDirectory() as folder:
        prepared = os.path.join(folder, "prepared.onnx")
        quant_pre_process(path, prepared, skip_symbolic_shape=True)
        quantization.quantize_static(
            prepared, out, Pictures(picture.name, shape), quant_format=FORMATS[kind], per_channel=True,
            activation_type=quantization.QuantType.QUInt8, weight_type=quantization.QuantType.QInt8)


def golden(path, prefix, size):
    """Writes a frame of soft waves and noise, and the outputs of onnxruntime for it."""
    rows, columns = np.mgrid[:size[1], :size[0]]
    noise = np.random.default_rng(2).normal(0, 16, rows.shape)
    picture = (128 + 70 * np.sin(columns / 5) * np.cos(rows / 4) + noise).clip(0, 255).astype(np.uint8)
    session = onnxruntime.InferenceSession(path, providers=["CPUExecutionProvider"])
    values = picture[None, None].astype(np.float32) / np.float32(255)
    output, = session.run(None, {session.get_inputs()[0].name: values})
    picture.tofile(f"{prefix}.picture")
    output.tofile(f"{prefix}.output")


def main():
    parser = argparse.ArgumentParser(prog="quantize.py", description="Makes a network of 8-bit integers from one of floating-point values.")
    parser.add_argument("network")
    parser.add_argument("out")
    parser.add_argument("--format", choices=FORMATS, default="qoperator")
    parser.add_argument("--size", default="64x64", help="WIDTHxHEIGHT of the pictures, where the network takes any (%(default)s)")
    parser.add_argument("--golden", metavar="PREFIX", help="also write a picture and its output, for a network of one channel")
    options = parser.parse_args()
    size = tuple(map(int, options.size.split("x")))
    quantize(options.network, options.out, options.format, size)
    if options.golden:
        golden(options.out, options.golden, size)


if __name__ == "__main__":
    main()
