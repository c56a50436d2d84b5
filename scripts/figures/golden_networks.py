#!/usr/bin/env python3
# SPDX-License-Identifier: MIT OR Apache-2.0
"""Makes the golden files of crates/network: small networks, an input of each, and the outputs of torch.

    golden_networks.py crates/network/tests/network/golden

Writes NAME.onnx, NAME.input, and NAME.output: all outputs one after the other. Values are 32-bit floating-point, lowest byte first. Fails if
onnxruntime has other outputs. Needs torch, torchvision, onnx, onnxscript and onnxruntime.
"""
import argparse
import os
import warnings

import numpy as np
import onnx
import onnxruntime
import torch
import torchvision
from torch import nn
from torch.nn import functional


class Branches(nn.Module):
    """Branches of one input, each of which is an output."""

    def __init__(self, *branches):
        super().__init__()
        self.branches = nn.ModuleList(branches)

    def forward(self, x):
        return tuple(branch(x) for branch in self.branches)


class Function(nn.Module):
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
    return Branches(
        nn.Conv2d(2, 13, 3, padding=1), nn.Conv2d(2, 4, (3, 5), stride=(2, 1), padding=(0, 2)), nn.Conv2d(2, 6, 3, dilation=(2, 3)),
        nn.Conv2d(2, 8, 3, stride=3, padding=2, groups=2), nn.Conv2d(2, 2, (1, 7), padding=(0, 3), groups=2),
        nn.Sequential(nn.ZeroPad2d((2, 0, 1, 3)), nn.Conv2d(2, 5, 4, stride=2)))


def pools():
    return Branches(
        nn.MaxPool2d(3, 2, 1), nn.MaxPool2d(2, 3, ceil_mode=True), nn.AvgPool2d(3, 2, 1), nn.AvgPool2d(3, 1, 1, count_include_pad=False),
        nn.AdaptiveAvgPool2d(1), nn.AdaptiveMaxPool2d(1))


def activations():
    scaled = (nn.ReLU(), nn.LeakyReLU(0.2), nn.ELU(0.7), nn.Sigmoid(), nn.Tanh(), nn.SiLU(), nn.GELU(), nn.Softplus(), nn.Hardsigmoid(),
              nn.Hardswish(), nn.ReLU6(), nn.Mish(), nn.Softmax(1))
    return Branches(*(nn.Sequential(nn.Conv2d(1, 3, 1), layer) for layer in scaled))


def resizes():
    return Branches(
        nn.Upsample(scale_factor=2, mode="nearest"), nn.Upsample(scale_factor=2, mode="bilinear", align_corners=False),
        nn.Upsample(scale_factor=2, mode="bilinear", align_corners=True), nn.Upsample(size=(9, 20), mode="nearest"))


def shapes():
    return Branches(
        Function(lambda x: torch.cat([x[:, :2], x[:, 2:] * 2], 1)), Function(lambda x: x.permute(0, 2, 3, 1)), Function(lambda x: x[:, :, 1:-1, ::2]),
        Function(lambda x: functional.pad(x, (1, 2, 0, 1), value=0.5)),
        Function(lambda x: x.mean((2, 3))), Function(lambda x: (x - x.mean((2, 3), keepdim=True)).abs().sqrt()),
        Function(lambda x: x.chunk(2, 1)[1].flatten(2)))


def transposed():
    return Branches(
        nn.ConvTranspose2d(4, 6, 3, 2, 1, output_padding=1), nn.ConvTranspose2d(4, 5, 2, 2),
        nn.ConvTranspose2d(4, 4, (3, 5), (3, 1), (1, 0), dilation=(1, 2)),
        nn.ConvTranspose2d(4, 6, 3, 2, groups=2), nn.ConvTranspose2d(4, 4, 4, 2, 1, groups=4),
        nn.Sequential(nn.ConvTranspose2d(4, 2, 1, 2), nn.ReLU()))


def norms():
    return Branches(
        nn.InstanceNorm2d(4, affine=True), nn.GroupNorm(2, 4), nn.LayerNorm([4, 6, 7]),
        Function(lambda x: functional.layer_norm(x.permute(0, 2, 3, 1), (4,)).permute(0, 3, 1, 2)),
        Function(lambda x: functional.normalize(x, dim=1)),
        Function(lambda x: x.log_softmax(1)))


def moves():
    return Branches(
        nn.ChannelShuffle(2), nn.PixelShuffle(2), Function(lambda x: functional.pixel_unshuffle(x[:, :, :6, :6], 2)),
        nn.ReflectionPad2d((2, 1, 0, 3)), nn.ReplicationPad2d((1, 2, 3, 0)), Function(lambda x: functional.pad(x, (0, 0, 0, 0, 1, 2), value=0.25)),
        nn.Upsample(scale_factor=2, mode="bicubic"), nn.Upsample(size=(5, 9), mode="bicubic", align_corners=True),
        Function(lambda x: x.flip(3)), Function(lambda x: x[:, 2]), Function(lambda x: x.mean(2, keepdim=True).expand(1, 4, 6, 7)),
        Function(lambda x: x.amax((1, 3)) + x.sum((1, 3))),
        Function(lambda x: torch.where(x > 0.1, x, x * 0.5 - 1)), Function(lambda x: x.argmax(1).float()),
        Function(lambda x: x.flatten(2).max(2).values + x.flatten(2).norm(dim=2)),
        Function(lambda x: torch.cat([x, torch.full((1, 1, 6, 7), 0.5)], 1)))


class Attention(nn.Module):
    """Attention of each token to all others, as in vision transformers."""

    def __init__(self):
        super().__init__()
        self.norm, self.attention, self.linear = nn.LayerNorm(8), nn.MultiheadAttention(8, 2, batch_first=True), nn.Linear(8, 3)
        self.token = nn.Parameter(torch.rand(1, 1, 8))

    def forward(self, x):
        tokens = torch.cat([self.token, x.flatten(2).transpose(1, 2)], 1)
        normalized = self.norm(tokens)
        tokens = tokens + self.attention(normalized, normalized, normalized, need_weights=False)[0]
        return self.linear(tokens[:, 0]), tokens[:, 1:].transpose(1, 2).reshape(1, 8, 6, 7)


class Head(nn.Module):
    """The head of YOLOv8: places of two scales behind each other, and boxes as means over shares."""

    def __init__(self):
        super().__init__()
        self.fine, self.coarse = nn.Conv2d(4, 19, 1), nn.Sequential(nn.MaxPool2d(2), nn.Conv2d(4, 19, 3, padding=1))
        self.mean = nn.Conv2d(4, 1, 1, bias=False)
        self.mean.weight.data = torch.arange(4.0).view(1, 4, 1, 1)

    def forward(self, x):
        both = torch.cat([part(x).flatten(2) for part in (self.fine, self.coarse)], 2)
        boxes, classes = both.split((16, 3), 1)
        boxes = self.mean(boxes.view(1, 4, 4, -1).transpose(2, 1).softmax(1)).view(1, 4, -1)
        anchors = torch.arange(2.0 * boxes.shape[2]).view(1, 2, -1)
        low, high = boxes.chunk(2, 1)
        low, high = anchors - low, anchors + high
        return torch.cat([torch.cat([(low + high) / 2, high - low], 1) * 8, classes.sigmoid()], 1)


# Name: the function that makes it, and its channels, rows and columns.
NETWORKS = {
    "lenet": (lenet, 1, 20, 20),
    "residual": (residual, 3, 30, 37),
    "inverted": (inverted, 3, 21, 18),
    "convolutions": (lambda: nn.Sequential(nn.Conv2d(3, 2, 1), convolutions()), 3, 13, 19),
    "pools": (pools, 3, 11, 14),
    "activations": (activations, 1, 7, 9),
    "resizes": (lambda: nn.Sequential(nn.Conv2d(3, 4, 1), resizes()), 3, 5, 7),
    "transposed": (lambda: nn.Sequential(nn.Conv2d(3, 4, 1), transposed()), 3, 5, 7),
    "norms": (lambda: nn.Sequential(nn.Conv2d(3, 4, 3, padding=1), norms()), 3, 6, 7),
    "moves": (lambda: nn.Sequential(nn.Conv2d(3, 4, 3, padding=1), moves()), 3, 6, 7),
    "attention": (lambda: nn.Sequential(nn.Conv2d(3, 8, 3, padding=1), Attention()), 3, 6, 7),
    "head": (lambda: nn.Sequential(nn.Conv2d(3, 4, 3, padding=1), Head()), 3, 6, 8),
    "shapes": (lambda: nn.Sequential(nn.Conv2d(3, 4, 1), shapes()), 3, 9, 10),
}


def vary(network):
    """Gives batch normalization random statistics, so that it has an effect."""
    for layer in network.modules():
        if isinstance(layer, nn.BatchNorm2d):
            for values in (layer.running_mean, layer.bias.data):
                values.normal_(0, 0.3)
            for values in (layer.running_var, layer.weight.data):
                values.uniform_(0.5, 1.5)


def export(network, picture, path):
    """Exports a network with PyTorch, as one file and without the names of our sources."""
    torch.onnx.export(network, (picture,), path, input_names=["picture"], external_data=False, verbose=False)
    model = onnx.load(path)
    for node in model.graph.node:
        del node.metadata_props[:]
        node.doc_string = ""
    for part in (model, model.graph, *model.graph.value_info):
        del part.metadata_props[:]
    del model.graph.value_info[:]
    onnx.save(model, path)


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
        export(network, picture, base + ".onnx")
        with torch.no_grad():
            outputs = network(picture)
        outputs = [value.numpy() for value in (outputs if isinstance(outputs, tuple) else (outputs,))]
        session = onnxruntime.InferenceSession(base + ".onnx", providers=["CPUExecutionProvider"])
        onnxruntime_outputs = session.run(None, {"picture": picture.numpy()})
        difference = max(float(np.abs(a - b).max()) for a, b in zip(outputs, onnxruntime_outputs, strict=True))
        print(f"{name}: {len(outputs)} outputs, torch and onnxruntime differ by at most {difference:.1e}")
        if difference > 1e-6 * max(1, *(float(np.abs(value).max()) for value in outputs)):
            raise SystemExit("golden_networks: that is too much for rounding")
        for ending, values in ("input", [picture.numpy()]), ("output", outputs):
            with open(f"{base}.{ending}", "wb") as file:
                file.write(b"".join(np.ascontiguousarray(value, "<f4").tobytes() for value in values))


if __name__ == "__main__":
    main()
