# SPDX-License-Identifier: MIT OR Apache-2.0
"""Called by snippets.sh: runs the Python of the documents as it stands, over folders that foveate really writes."""
import csv
import gzip
import os
import pathlib
import shlex
import struct
import subprocess
import sys
import tempfile

import numpy
import pandas
import pyarrow.csv
from PIL import Image

FOVEATE = os.environ["FOVEATE"]


def steps(page):
    """Commands and blocks of Python of a page in order: their line, their kind and their text."""
    block, start, fence = None, 0, False
    for number, line in enumerate(page.read_text().splitlines(), 1):
        if line.startswith("```"):
            if block is not None:
                yield start, "python", "\n".join(block) + "\n"
            block, start = ([], number + 1) if not fence and line.startswith("```python") else (None, 0)
            fence = not fence
        elif block is not None:
            block.append(line)
        elif not fence and line.startswith("    foveate "):
            yield number, "command", line.strip()


def given(folder, seed=1):
    """What the pages take for granted: a labelled IDX set, labelled photographs, a clip, a folder of clips, and the network of the sources."""
    chance = numpy.random.default_rng(seed)
    images, labels = chance.integers(0, 256, (12, 28, 28), numpy.uint8), numpy.arange(12, dtype=numpy.uint8) % 10
    images[:, :12] = 0
    for name, kind, array in [("images-idx3", 3, images), ("labels-idx1", 1, labels)]:
        header = struct.pack(f">BBBB{kind}I", 0, 0, 8, kind, *array.shape)
        (folder / f"train-{name}-ubyte.gz").write_bytes(gzip.compress(header + array.tobytes()))
    for label, name in [("cat", "1.jpg"), ("cat", "one, two#3.png"), ("dog", '50% "sure".png'), ("dog", "b.png")]:
        (folder / "photos" / label).mkdir(parents=True, exist_ok=True)
        pixels = chance.integers(0, 256, (96, 128, 3), numpy.uint8)
        Image.fromarray(pixels).save(folder / "photos" / label / name)
    (folder / "networks").mkdir()
    for network in pathlib.Path("networks").glob("*.onnx"):
        (folder / network).write_bytes(network.read_bytes())
    (folder / "clips").mkdir()
    command = [FOVEATE, "simulate", "scene:street", "-o", "made", "--frames", "6", "--rendered", "mp4", "--quiet"]
    subprocess.run(command, cwd=folder, check=True, stdout=subprocess.DEVNULL)
    for name in ["street.mp4", "clips/one.mp4", "clips/two.mp4"]:
        (folder / name).write_bytes((folder / "made/rendered.mp4").read_bytes())


def run_page(page):
    """Runs a page in a new folder: its number of blocks, or nothing if it has none."""
    parts = list(steps(page))
    blocks = sum(kind == "python" for _, kind, _ in parts)
    if not blocks:
        return 0
    with tempfile.TemporaryDirectory() as folder:
        given(pathlib.Path(folder))
        for line, kind, text in parts:
            command = [sys.executable, "-W", "error", "-c", text] if kind == "python" else [FOVEATE, *shlex.split(text)[1:]]
            done = subprocess.run(command, cwd=folder, capture_output=True, text=True)
            if done.returncode != 0:
                sys.exit(f"{page}:{line}: this fails with exit code {done.returncode}:\n{text}\n{done.stderr or done.stdout}")
    print(f"{page}: {blocks} blocks, {len(parts) - blocks} commands")
    return blocks


READERS = {
    "csv": lambda path: [row["name"] for row in csv.DictReader(open(path, newline="", encoding="utf-8"))],
    "numpy.genfromtxt": lambda path: list(
        numpy.genfromtxt(path, delimiter=",", names=True, dtype=None, encoding="utf-8")["name"]
    ),
    "pandas": lambda path: list(pandas.read_csv(path)["name"]),
    "pandas, comments": lambda path: list(pandas.read_csv(path, comment="#")["name"]),
    "pyarrow": lambda path: pyarrow.csv.read_csv(path)["name"].to_pylist(),
}


def read_names():
    """Every reader reads the same names of frames from a set with difficult ones."""
    with tempfile.TemporaryDirectory() as folder:
        folder = pathlib.Path(folder)
        given(folder)
        command = [FOVEATE, "dataset", "-o", "out", "--resize", "64x64", "--quiet"]
        for inputs, count in [(["photos"], 4), (["train-images-idx3-ubyte.gz"], 12)]:
            done = subprocess.run([*command, "--force", *inputs], cwd=folder, capture_output=True, text=True)
            if done.returncode != 0:
                sys.exit(f"dataset {inputs} fails:\n{done.stderr}")
            names = {reader: read(folder / "out/frames.csv") for reader, read in READERS.items()}
            for reader, seen in names.items():
                if seen != names["csv"] or len(set(seen)) != count:
                    sys.exit(f"{reader} reads {seen}\nwhere csv reads {names['csv']}")
            print(f"frames.csv of {inputs[0]}: {count} names, the same in {len(names)} readers, the last {names['csv'][-1]}")


def main():
    pages = [pathlib.Path("README.md"), *sorted(pathlib.Path("docs").rglob("*.md"))]
    if sum(run_page(page) for page in pages) == 0:
        sys.exit("no page has a block of Python")
    read_names()


main()
