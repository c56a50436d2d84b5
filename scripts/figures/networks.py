#!/usr/bin/env python3
# SPDX-License-Identifier: MIT OR Apache-2.0
"""Makes the networks of the page "Savings" as ONNX files, with weights from a fixed seed.

    networks.py FOLDER [NAME...] [--size WIDTHxHEIGHT] [--int8]

--int8 also writes forms of 8-bit integers, by scripts/figures/quantize.py: NAME-qoperator.onnx and NAME-qdq.onnx. Needs torch, torchvision, onnx and
onnxscript; --int8 needs onnxruntime. The weights are random, so the networks serve to measure masks, counts and time. Their outputs mean nothing.
"""
import argparse
import os
import warnings

import torch
from torch import nn


def lenet():
    return nn.Sequential(
        nn.Conv2d(1, 6, 5, padding=2), nn.ReLU(), nn.MaxPool2d(2), nn.Conv2d(6, 16, 5), nn.ReLU(), nn.MaxPool2d(2),
        nn.Flatten(), nn.Linear(400, 120), nn.ReLU(), nn.Linear(120, 84), nn.ReLU(), nn.Linear(84, 10))


def denoiser(channels=32, layers=8):
    """A network like DnCNN (Zhang et al. 2017) without batch normalization. It predicts the noise."""
    inner = [layer for _ in range(layers - 2) for layer in (nn.Conv2d(channels, channels, 3, padding=1), nn.ReLU())]
    return nn.Sequential(nn.Conv2d(1, channels, 3, padding=1), nn.ReLU(), *inner, nn.Conv2d(channels, 1, 3, padding=1))


class Detector(nn.Module):
    """A detector like YOLO: a backbone of strided convolutions with SiLU, two scales, boxes and classes of three anchors."""

    def __init__(self, classes=20, anchors=3):
        super().__init__()
        def block(inputs, outputs, stride):
            return nn.Sequential(nn.Conv2d(inputs, outputs, 3, stride, 1, bias=False), nn.BatchNorm2d(outputs), nn.SiLU())
        self.anchors, self.values = anchors, 5 + classes
        self.stem = nn.Sequential(block(3, 16, 2), block(16, 32, 2), block(32, 64, 2))
        self.deep = nn.Sequential(block(64, 128, 2), block(128, 128, 1))
        self.up = nn.Upsample(scale_factor=2, mode="nearest")
        self.joined = block(192, 64, 1)
        self.heads = nn.ModuleList([nn.Conv2d(64, anchors * self.values, 1), nn.Conv2d(128, anchors * self.values, 1)])

    def forward(self, x):
        fine = self.stem(x)
        coarse = self.deep(fine)
        fine = self.joined(torch.cat([fine, self.up(coarse)], 1))
        def shaped(y):
            return y.view(1, self.anchors, self.values, y.shape[2], y.shape[3]).permute(0, 1, 3, 4, 2).sigmoid()
        return shaped(self.heads[0](fine)), shaped(self.heads[1](coarse))


def torchvision_network(name):
    import torchvision
    return getattr(torchvision.models, name)(weights=None)


# Name: the function that makes it, its channels, and its usual width and height.
NETWORKS = {
    "lenet5": (lenet, 1, 28, 28),
    "denoiser": (denoiser, 1, 640, 360),
    "detector": (Detector, 3, 640, 384),
    "mobilenet_v2": (lambda: torchvision_network("mobilenet_v2"), 3, 224, 224),
    "resnet18": (lambda: torchvision_network("resnet18"), 3, 224, 224),
    "resnet50": (lambda: torchvision_network("resnet50"), 3, 224, 224),
    "vgg16": (lambda: torchvision_network("vgg16"), 3, 224, 224),
}


def main():
    parser = argparse.ArgumentParser(prog="networks.py", description="Makes networks as ONNX files, with weights from a fixed seed.")
    parser.add_argument("folder")
    parser.add_argument("names", nargs="*", choices=[[], *NETWORKS], metavar="NAME", help=", ".join(NETWORKS))
    parser.add_argument("--size", help="WIDTHxHEIGHT of the pictures; by default the usual size of each")
    parser.add_argument("--int8", action="store_true", help="also write quantized forms of each")
    options = parser.parse_args()
    os.makedirs(options.folder, exist_ok=True)
    warnings.filterwarnings("ignore")
    for name in options.names or NETWORKS:
        make, channels, width, height = NETWORKS[name]
        if options.size:
            width, height = map(int, options.size.split("x"))
        torch.manual_seed(1)
        network = make().eval()
        path = os.path.join(options.folder, f"{name}.onnx")
        torch.onnx.export(network, (torch.zeros(1, channels, height, width),), path, input_names=["picture"], external_data=False, verbose=False)
        print(f"{path}: {channels} x {height} x {width}, {sum(p.numel() for p in network.parameters()):,} parameters")
        if options.int8:
            # Imported here, because only this option needs it, and it needs onnxruntime.
            from quantize import FORMATS, quantize
            for kind in FORMATS:
                out = os.path.join(options.folder, f"{name}-{kind}.onnx")
                quantize(path, out, kind)
                print(out)


if __name__ == "__main__":
    main()
