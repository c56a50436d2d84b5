#!/usr/bin/env python3
# SPDX-License-Identifier: MIT OR Apache-2.0
"""Makes the golden files of crates/network: small networks, an input of each, and what torch makes of it.

    golden_networks.py crates/network/tests/network/golden

Writes NAME.onnx, NAME.input, and NAME.output: all outputs one after the other. Values are 32-bit floating-point, lowest byte first. Fails if
onnxruntime has other outputs. Needs torch, torchvision, onnx and onnxruntime.
"""
import argparse
import os
import warnings

import numpy as np
import onnxruntime
import torch
import torchvision
from torch import nn
from torch.nn import functional


class Zoo(nn.Module):
    """Branches of one input, each an output."""

    def __init__(self, *branches):
        super().__init__()
        self.branches = nn.ModuleList(branches)

    def forward(self, x):
        return tuple(branch(x) for branch in self.branches)


class Of(nn.Module):
    """A function as a module."""

    def __init__(self, function):
        super().__init__()
        self.function = function

    def forward(self, x):
        return self.function(x)


def lenet():
    return nn.Sequential(
        nn.Conv2d(1, 4, 5, padding=2), nn.Tanh(), nn.AvgPool2d(2), nn.Conv2d(4, 6, 5), nn.Tanh(), nn.AvgPool2d(2),
        nn.Flatten(), nn.Linear(54, 16), nn.ReLU(), nn.Linear(16, 10), nn.Softmax(1))


def residual():
    block = torchvision.models.resnet.BasicBlock
    down = nn.Sequential(nn.Conv2d(4, 8, 1, 2, bias=False), nn.BatchNorm2d(8))
    return nn.Sequential(
        nn.Conv2d(3, 4, 7, 2, 3, bias=False), nn.BatchNorm2d(4), nn.ReLU(), nn.MaxPool2d(3, 2, 1), block(4, 4), block(4, 8, 2, down),
        nn.AdaptiveAvgPool2d(1), nn.Flatten(), nn.Linear(8, 5))


def inverted():
    block = torchvision.models.mobilenetv2.InvertedResidual
    return nn.Sequential(nn.Conv2d(3, 4, 3, 2, 1), nn.ReLU6(), block(4, 6, 2, 2), block(6, 6, 1, 3), nn.Hardswish())


def convolutions():
    return Zoo(
        nn.Conv2d(2, 13, 3, padding=1), nn.Conv2d(2, 4, (3, 5), stride=(2, 1), padding=(0, 2)), nn.Conv2d(2, 6, 3, dilation=(2, 3)),
        nn.Conv2d(2, 8, 3, stride=3, padding=2, groups=2), nn.Conv2d(2, 2, (1, 7), padding=(0, 3), groups=2),
        nn.Sequential(nn.ZeroPad2d((2, 0, 1, 3)), nn.Conv2d(2, 5, 4, stride=2)))


def pools():
    return Zoo(
        nn.MaxPool2d(3, 2, 1), nn.MaxPool2d(2, 3, ceil_mode=True), nn.AvgPool2d(3, 2, 1), nn.AvgPool2d(3, 1, 1, count_include_pad=False),
        nn.AdaptiveAvgPool2d(1), nn.AdaptiveMaxPool2d(1))


def activations():
    scaled = (nn.ReLU(), nn.LeakyReLU(0.2), nn.ELU(0.7), nn.Sigmoid(), nn.Tanh(), nn.SiLU(), nn.GELU(), nn.Softplus(), nn.Hardsigmoid(),
              nn.Hardswish(), nn.ReLU6(), nn.Mish(), nn.Softmax(1))
    return Zoo(*(nn.Sequential(nn.Conv2d(1, 3, 1), layer) for layer in scaled))


def resizes():
    return Zoo(
        nn.Upsample(scale_factor=2, mode="nearest"), nn.Upsample(scale_factor=2, mode="bilinear", align_corners=False),
        nn.Upsample(scale_factor=2, mode="bilinear", align_corners=True), nn.Upsample(size=(9, 20), mode="nearest"))


def shapes():
    return Zoo(
        Of(lambda x: torch.cat([x[:, :2], x[:, 2:] * 2], 1)), Of(lambda x: x.permute(0, 2, 3, 1)), Of(lambda x: x[:, :, 1:-1, ::2]),
        Of(lambda x: functional.pad(x, (1, 2, 0, 1), value=0.5)),
        Of(lambda x: x.mean((2, 3))), Of(lambda x: (x - x.mean((2, 3), keepdim=True)).abs().sqrt()), Of(lambda x: x.chunk(2, 1)[1].flatten(2)))


# Name: how it is made, and its channels, rows and columns.
NETWORKS = {
    "lenet": (lenet, 1, 20, 20),
    "residual": (residual, 3, 30, 37),
    "inverted": (inverted, 3, 21, 18),
    "convolutions": (lambda: nn.Sequential(nn.Conv2d(3, 2, 1), convolutions()), 3, 13, 19),
    "pools": (pools, 3, 11, 14),
    "activations": (activations, 1, 7, 9),
    "resizes": (lambda: nn.Sequential(nn.Conv2d(3, 4, 1), resizes()), 3, 5, 7),
    "shapes": (lambda: nn.Sequential(nn.Conv2d(3, 4, 1), shapes()), 3, 9, 10),
}


def vary(network):
    """Gives batch normalization something to do."""
    for layer in network.modules():
        if isinstance(layer, nn.BatchNorm2d):
            for values in (layer.running_mean, layer.bias.data):
                values.normal_(0, 0.3)
            for values in (layer.running_var, layer.weight.data):
                values.uniform_(0.5, 1.5)


def main():
    parser = argparse.ArgumentParser(prog="golden_networks.py", description="Makes the golden files of crates/network.")
    parser.add_argument("folder")
    folder = parser.parse_args().folder
    os.makedirs(folder, exist_ok=True)
    warnings.filterwarnings("ignore")
    for name, (make, channels, height, width) in NETWORKS.items():
        torch.manual_seed(1)
        network = make().eval()
        vary(network)
        picture = torch.rand(1, channels, height, width) * 4 - 2
        base = os.path.join(folder, name)
        torch.onnx.export(network, (picture,), base + ".onnx", opset_version=17, dynamo=False, input_names=["picture"])
        with torch.no_grad():
            found = network(picture)
        found = [value.numpy() for value in (found if isinstance(found, tuple) else (found,))]
        session = onnxruntime.InferenceSession(base + ".onnx", providers=["CPUExecutionProvider"])
        theirs = session.run(None, {"picture": picture.numpy()})
        apart = max(float(np.abs(a - b).max()) for a, b in zip(found, theirs, strict=True))
        print(f"{name}: {len(found)} outputs, torch and onnxruntime differ by at most {apart:.1e}")
        if apart > 1e-6:
            raise SystemExit("golden_networks: that is too much for rounding")
        for ending, values in ("input", [picture.numpy()]), ("output", found):
            with open(f"{base}.{ending}", "wb") as file:
                file.write(b"".join(np.ascontiguousarray(value, "<f4").tobytes() for value in values))


if __name__ == "__main__":
    main()
