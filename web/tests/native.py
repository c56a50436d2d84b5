# SPDX-License-Identifier: MIT OR Apache-2.0
"""The native results: those of `foveate simulate` for the same frames, read from its files. The hash of a frame is written a second
time from its definition (crates/engine/src/digest.rs), so that an error in one of them is found."""

import csv
import json
import subprocess

import numpy as np
from PIL import Image

ACTIONS = ["forward", "hold", "blank", "summarize"]


class Program:
    """The native program `foveate`."""

    def __init__(self, program, folders):
        self.program = program
        self.folders = folders

    def call(self, *arguments):
        """Returns its standard output; fails with its messages if it fails."""
        result = subprocess.run([self.program, *map(str, arguments)], capture_output=True, text=True, check=False)
        assert result.returncode == 0, f"foveate {' '.join(map(str, arguments))}: {result.stderr}"
        return result.stdout

    def pictures(self, frames, size):
        """Writes frames of 8-bit grey. Returns their files, in order."""
        folder = self.folders.mktemp("frames")
        names = []
        for number, frame in enumerate(frames):
            names.append(folder / f"{number:06}.pgm")
            names[-1].write_bytes(b"P5 %d %d 255\n" % size + frame)
        return names

    def simulate(self, toml, inputs, *options):
        """Returns the results of every frame."""
        folder = self.folders.mktemp("native")
        config = folder / "design.toml"
        config.write_text(toml)
        out = folder / "out"
        self.call("simulate", *inputs, "--config", config, "-o", out, "--events", "csv", *options)
        return SimulationResults(out)


class SimulationResults:
    """The results in a folder of `simulate`."""

    def __init__(self, folder):
        self.summary = json.loads((folder / "summary.json").read_text())
        frame = self.summary["configuration"]["frame"]
        self.width, self.height, self.bits = frame["width"], frame["height"], frame["pixel_bits"]
        self.events = (folder / "events.csv").read_text()
        rows = list(csv.DictReader(self.events.splitlines()))
        scores = [name for name in rows[0] if name.startswith("score_")]
        count = int(rows[-1]["frame"]) + 1
        regions = len(rows) // count
        self.frames = []
        for number in range(count):
            own = rows[number * regions : (number + 1) * regions]
            self.frames.append(Frame(own, scores, folder / "rendered" / f"{number:06}.png", self.bits))


class Frame:
    """The results of one frame."""

    def __init__(self, rows, scores, picture, bits):
        self.rows = rows
        self.regions = bytes(
            int(row["srs"]) | int(row["trs"]) << 1 | ACTIONS.index(row["action"]) << 2 for row in rows
        )
        self.scores = [[int(row[name]) for row in rows] for name in scores]
        self.counts = [int(row["t_count"]) for row in rows]
        self.displacements = [[int(row["dx"]), int(row["dy"])] for row in rows if "dx" in row]
        shown = np.asarray(Image.open(picture))
        # A picture shows pixels of up to 8 bits as 8, others as 16, by repeating bits.
        self.shown = (shown if bits <= 8 else shown >> 8).astype(np.uint8).tobytes()
        self.pixels = shown.astype(np.uint16) >> ((8 if bits <= 8 else 16) - bits)

    def hash(self):
        """FNV-1a of 64 bits of pixels, decisions, scores, counts and displacements."""
        data = b"".join([
            self.pixels.astype("<u2").tobytes(),
            self.regions,
            np.array(self.scores, dtype="<u8").tobytes(),
            np.array(self.counts, dtype="<u4").tobytes(),
            np.array(self.displacements, dtype="i1").tobytes(),
        ])
        value = 0xCBF29CE484222325
        for byte in data:
            value = (value ^ byte) * 0x100000001B3 & 0xFFFFFFFFFFFFFFFF
        return f"{value:016x}"
