# SPDX-License-Identifier: MIT OR Apache-2.0
"""Writes ONNX files: small networks that the tests make themselves."""

import struct

FLOAT, INT64 = 1, 7


def varint(value):
    value &= (1 << 64) - 1
    data = b""
    while value > 127:
        data += bytes([value & 127 | 128])
        value >>= 7
    return data + bytes([value])


def number(field, value):
    return varint(field << 3) + varint(value)


def message(field, data):
    data = data.encode() if isinstance(data, str) else data
    return varint(field << 3 | 2) + varint(len(data)) + data


def value(name, shape):
    """A value of floats; a side that is a name is open."""
    dims = b"".join(message(1, message(2, side) if isinstance(side, str) else number(1, side)) for side in shape)
    return message(1, name) + message(2, message(1, number(1, FLOAT) + message(2, dims)))


def tensor(name, shape, values, kind=FLOAT):
    raw = struct.pack(f"<{len(values)}{'f' if kind == FLOAT else 'q'}", *values)
    return b"".join(number(1, side) for side in shape) + number(2, kind) + message(8, name) + message(9, raw)


def attribute(name, given):
    """An integer, or a list of them."""
    if isinstance(given, int):
        return message(1, name) + number(3, given) + number(20, 2)
    return message(1, name) + b"".join(number(8, one) for one in given) + number(20, 7)


class Model:
    """A model under way, whose input is `picture`."""

    def __init__(self, shape):
        self.input = message(11, value("picture", shape))
        self.nodes = self.constants = b""
        self.count = 0

    def constant(self, shape, values, kind=FLOAT):
        self.count += 1
        self.constants += message(5, tensor(f"constant{self.count}", shape, values, kind))
        return f"constant{self.count}"

    def node(self, operator, inputs, output=None, **attributes):
        self.count += 1
        output = output or f"value{self.count}"
        data = b"".join(message(1, name) for name in inputs) + message(2, output) + message(3, f"{operator}{self.count}") + message(4, operator)
        data += b"".join(message(5, attribute(name, given)) for name, given in attributes.items())
        self.nodes += message(1, data)
        return output

    def bytes(self, *outputs):
        graph = self.nodes + message(2, "graph") + self.constants + self.input + b"".join(message(12, value(name, ())) for name in outputs)
        return number(1, 8) + message(7, graph) + message(8, number(2, 13))


def squares(width=64, height=48):
    """A detector of the format `yolov5` that finds something in every bright square of 8x8 pixels of 0 to 1: the wider the brighter, and of another
    class above half of white. Weights are powers of two, so that every processor rounds the same way."""
    columns, rows = width // 8, height // 8
    cells, model = columns * rows, Model((1, 1, height, width))
    # Width, score and the second class are means of the square; the others come from the sum below.
    weights = [0.0] * (7 * 64)
    for channel, share in [(2, 8.0), (4, 1.0), (6, 1.0)]:
        weights[64 * channel : 64 * (channel + 1)] = [share / 64] * 64
    means = model.node("Conv", ["picture", model.constant((7, 1, 8, 8), weights)], kernel_shape=[8, 8], strides=[8, 8])
    flat = model.node("Reshape", [means, model.constant((3,), (1, 7, cells), INT64)])
    rows_of = model.node("Transpose", [flat], perm=[0, 2, 1])
    known = [part for cell in range(cells) for part in (cell % columns * 8 + 4, cell // columns * 8 + 4, 4, 7, 0.125, 0.5, 0)]
    model.node("Add", [rows_of, model.constant((1, cells, 7), known)], "found")
    return model.bytes("found")


def classes(width=64, height=48):
    """Three classes: how bright the upper half is, the lower half, and a constant."""
    model = Model((1, 1, height, width))
    half = [1.0 / 1024] * (width * height // 2)
    none = [0.0] * len(half)
    weights = [*half, *none, *none, *half, *none, *none]
    inputs = ["picture", model.constant((3, 1, height, width), weights), model.constant((3,), (0, 0, 0.25))]
    scores = model.node("Conv", inputs, kernel_shape=[height, width])
    model.node("Flatten", [scores], "scores")
    return model.bytes("scores")


def filters(channels, layers, shape):
    """Convolutions of 3x3, one behind the other: as much work and memory as one likes."""
    model = Model(shape)
    last, before = "picture", 1
    for _ in range(layers):
        weights = model.constant((channels, before, 3, 3), [2.0**-10] * (channels * before * 9))
        last, before = model.node("Conv", [last, weights], kernel_shape=[3, 3], pads=[1, 1, 1, 1]), channels
    return model.bytes(last)
