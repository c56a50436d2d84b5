# SPDX-License-Identifier: MIT OR Apache-2.0
"""The files that a reader of the pages is assumed to have: the reader's own, and those of a checkout."""
import gzip
import pathlib
import shutil
import struct
import subprocess

import numpy
from PIL import Image


def make_reader_files(folder, foveate, seed=1):
    """Makes all files that the pages assume: a labelled IDX set, labelled photographs, a clip of 25 s, a folder of clips, and copies of
    the networks and the Verilog of the sources."""
    random = numpy.random.default_rng(seed)
    images, labels = random.integers(0, 256, (12, 28, 28), numpy.uint8), numpy.arange(12, dtype=numpy.uint8) % 10
    images[:, :12] = 0
    for name, kind, array in [("images-idx3", 3, images), ("labels-idx1", 1, labels)]:
        header = struct.pack(f">BBBB{kind}I", 0, 0, 8, kind, *array.shape)
        (folder / f"train-{name}-ubyte.gz").write_bytes(gzip.compress(header + array.tobytes()))
    for label, name in [("cat", "1.jpg"), ("cat", "one, two#3.png"), ("dog", '50% "sure".png'), ("dog", "b.png")]:
        (folder / "photos" / label).mkdir(parents=True, exist_ok=True)
        pixels = random.integers(0, 256, (96, 128, 3), numpy.uint8)
        Image.fromarray(pixels).save(folder / "photos" / label / name)
    (folder / "networks").mkdir()
    for network in pathlib.Path("networks").glob("*.onnx"):
        shutil.copy(network, folder / network)
    shutil.copytree("rtl", folder / "rtl")
    (folder / "clips").mkdir()
    command = [foveate, "simulate", "scene:street", "-o", "made", "--frames", "50", "--preset", "fovea", "--rendered", "mp4", "--quiet"]
    subprocess.run(command, cwd=folder, check=True, stdout=subprocess.DEVNULL)
    # Two frames per second.
    slower = ["ffmpeg", "-v", "error", "-itsscale", "15", "-i", "made/rendered.mp4", "-c", "copy", "street.mp4"]
    subprocess.run(slower, cwd=folder, check=True)
    for name in ["clips/one.mp4", "clips/two.mp4"]:
        shutil.copy(folder / "street.mp4", folder / name)
    shutil.rmtree(folder / "made")
