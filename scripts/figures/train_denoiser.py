#!/usr/bin/env python3
# SPDX-License-Identifier: MIT OR Apache-2.0
"""Trains the small denoiser of networks/denoiser.onnx on frames of the synthetic scenes, from a fixed seed.

    train_denoiser.py FILE.onnx

Needs `foveate` on the path (or its path in FOVEATE), torch, onnx, onnxscript, numpy and Pillow. It takes about two minutes on two cores.
The input of the network is a noisy frame of any size, with pixels from 0 to 1. Its output is the frame without noise.
"""
import glob
import os
import subprocess
import sys
import tempfile
import warnings

import numpy as np
import torch
from PIL import Image
from torch import nn

NOISE = 0.08
STEPS = 1500
PATCH, BATCH = 48, 32
# All regions are active, so that the rendered frames are those of the scene.
OPEN = ["--set", "render.payload='raw'", "--set", "temporal={level=1,min_count=0}",
        "--set", "spatial=[{feature='edge',level=100,min_score=0}]"]


class Denoiser(nn.Module):
    """A network of four convolutions that predicts the noise."""

    def __init__(self, channels=12):
        super().__init__()
        self.noise = nn.Sequential(
            nn.Conv2d(1, channels, 3, padding=1), nn.ReLU(), nn.Conv2d(channels, channels, 3, padding=1), nn.ReLU(),
            nn.Conv2d(channels, channels, 3, padding=1), nn.ReLU(), nn.Conv2d(channels, 1, 3, padding=1))

    def forward(self, picture):
        return picture - self.noise(picture)


def frames(scene, count=40):
    """Returns the frames of a scene, from 0 to 1."""
    with tempfile.TemporaryDirectory() as folder:
        out = os.path.join(folder, "out")
        command = [os.environ.get("FOVEATE", "foveate"), "simulate", f"scene:{scene}", "-o", out, "--max-frames", str(count), "--quiet", *OPEN]
        subprocess.run(command, check=True)
        pictures = [np.asarray(Image.open(path), np.float32) / 255 for path in sorted(glob.glob(os.path.join(out, "rendered", "*.png")))]
    return torch.from_numpy(np.stack(pictures))[:, None]


def patches(clips):
    """Returns a batch of random patches."""
    crops = []
    for _ in range(BATCH):
        clip = clips[int(torch.randint(len(clips), ()))]
        frame = clip[int(torch.randint(len(clip), ()))]
        y, x = (int(torch.randint(size - PATCH + 1, ())) for size in frame.shape[1:])
        crops.append(frame[:, y:y + PATCH, x:x + PATCH])
    return torch.stack(crops)


def psnr(a, b):
    return float(-10 * torch.log10(torch.mean((a - b) ** 2)))


def main():
    warnings.filterwarnings("ignore")
    torch.manual_seed(1)
    clips = [frames(scene) for scene in ("street", "shake", "ramps", "one-pixel")]
    # This scene is not used in training.
    test = frames("night-rain", 8)
    network = Denoiser()
    optimizer = torch.optim.Adam(network.parameters(), 2e-3)
    schedule = torch.optim.lr_scheduler.CosineAnnealingLR(optimizer, STEPS)
    for _ in range(STEPS):
        clean = patches(clips)
        loss = torch.mean((network(clean + NOISE * torch.randn_like(clean)) - clean) ** 2)
        optimizer.zero_grad()
        loss.backward()
        optimizer.step()
        schedule.step()
    network.eval()
    with torch.no_grad():
        noisy = clips[0][:8] + NOISE * torch.randn_like(clips[0][:8])
        print(f"street: {psnr(noisy, clips[0][:8]):.1f} dB with noise, {psnr(network(noisy), clips[0][:8]):.1f} dB without")
        noisy = test + NOISE * torch.randn_like(test)
        print(f"night-rain, not seen in training: {psnr(noisy, test):.1f} dB with noise, {psnr(network(noisy), test):.1f} dB without")
    # Lengths below those of the windows are not traced.
    height, width = torch.export.Dim("height", min=4), torch.export.Dim("width", min=4)
    torch.onnx.export(network, (torch.zeros(1, 1, 32, 48),), sys.argv[1], input_names=["picture"], output_names=["clean"],
                      dynamic_shapes=({2: height, 3: width},), external_data=False, verbose=False)
    print(f"{sys.argv[1]}: {os.path.getsize(sys.argv[1])} bytes, {sum(p.numel() for p in network.parameters())} parameters")


if __name__ == "__main__":
    main()
