#!/usr/bin/env python3
# SPDX-License-Identifier: MIT OR Apache-2.0
"""Measures a camera whose keen zone is where a network saw something, for docs/data/zones-loop.csv.

    zones.py NETWORK CLIP... [--frames N] [--every N]

NETWORK is the file of YOLOX-nano. The network sees the receiver's screen of every frame, behind preset `fovea` and behind cameras with a
coarser temporal level: everywhere, and everywhere except near the boxes of the frames before. On every fifth frame the boxes are compared
with those of the same network on whole frames. The rows go to standard output.

Needs the Python package foveate, and onnxruntime.
"""
import argparse
import csv
import os
import sys

import numpy as np
import onnxruntime

import foveate as fv

SIDE = 416  # pixels of a side of the network's input
STRIDES = (8, 16, 32)
LEAST_SCORE = 0.3
SAME = 0.5  # least intersection over union of two boxes of one object
COARSE = 24  # temporal.level away from boxes
HELD_FRAMES = 8  # a region stays keen for so many frames
AROUND = 2  # regions around a box that are keen, too
KEEN = 2  # code of the class


class Detector:
    """A network that finds boxes in grey frames."""

    def __init__(self, path):
        options = onnxruntime.SessionOptions()
        options.intra_op_num_threads = 1
        self.session = onnxruntime.InferenceSession(path, options)
        self.input = self.session.get_inputs()[0].name
        cells, strides = [], []
        for stride in STRIDES:
            y, x = np.mgrid[: SIDE // stride, : SIDE // stride]
            cells.append(np.stack([x.ravel(), y.ravel()], 1))
            strides.append(np.full((x.size, 1), stride))
        self.cells, self.strides = np.concatenate(cells), np.concatenate(strides)

    def boxes(self, frame):
        """Returns the boxes in a frame: rows of left, top, right, bottom, class and score."""
        height, width = frame.shape
        scale = min(SIDE / height, SIDE / width)
        rows = np.minimum((np.arange(int(height * scale)) / scale).astype(int), height - 1)
        columns = np.minimum((np.arange(int(width * scale)) / scale).astype(int), width - 1)
        picture = np.full((SIDE, SIDE), 114, np.float32)
        picture[: len(rows), : len(columns)] = frame[rows][:, columns]
        found = self.session.run(None, {self.input: np.broadcast_to(picture, (1, 3, SIDE, SIDE)).copy()})[0][0]
        center = (found[:, :2] + self.cells) * self.strides / scale
        half = np.exp(found[:, 2:4]) * self.strides / scale / 2
        scores = found[:, 4] * found[:, 5:].max(1)
        boxes = np.column_stack([center - half, center + half, found[:, 5:].argmax(1), scores])[scores >= LEAST_SCORE]
        return without_doubles(boxes[np.argsort(-boxes[:, 5])])


def overlaps(box, others):
    """Returns the intersection over union of a box with each of others, 0 for boxes of other classes."""
    low, high = np.maximum(box[:2], others[:, :2]), np.minimum(box[2:4], others[:, 2:4])
    shared = np.prod(np.maximum(high - low, 0), 1)
    areas = np.prod(others[:, 2:4] - others[:, :2], 1) + np.prod(box[2:4] - box[:2])
    return np.where(others[:, 4] == box[4], shared / (areas - shared), 0)


def without_doubles(boxes):
    kept = []
    for box in boxes:
        if not kept or overlaps(box, np.array(kept)).max() < 0.45:
            kept.append(box)
    return np.array(kept).reshape(-1, 6)


def matches(found, whole):
    """Returns the number of pairs of boxes that are the same object, each in one pair at most."""
    free, count = np.ones(len(whole), bool), 0
    for box in found:
        values = np.where(free, overlaps(box, whole), 0) if len(whole) else np.zeros(1)
        if values.max() >= SAME:
            free[values.argmax()] = False
            count += 1
    return count


def near(boxes, shape, size):
    """Returns True for the regions near boxes."""
    mask = np.zeros(shape, bool)
    for left, top, right, bottom, *_ in boxes:
        first, last = np.array([top, left]) // size - AROUND, np.array([bottom, right]) // size + AROUND + 1
        (row, column), (row_end, column_end) = np.maximum(first, 0).astype(int), np.maximum(last, 0).astype(int)
        mask[row:row_end, column:column_end] = True
    return mask


def frames(clip, count):
    return [outcome.frame.copy() for outcome in fv.simulate(clip, "fovea", max_frames=count)]


CAMERAS = {
    "fovea": {},
    f"level {COARSE} everywhere": {"temporal": {"level": COARSE}},
    f"level {COARSE}, keen near boxes": {"temporal": {"level": COARSE}, "zones": {"keen": {"temporal": {"level": 16}}}},
}


def measure(detector, clip_frames, whole, keys, every):
    """Returns the share of bytes, of keen regions, of kept boxes and of right boxes, in percent."""
    camera, seen = fv.Camera("fovea", **keys), None
    sent = keen = kept = found = count = 0
    for number, frame in enumerate(clip_frames):
        if seen is not None:
            camera.zones = np.where(seen > 0, KEEN, 0).astype(np.uint8)
            keen += (seen > 0).mean()
        outcome = camera.step(frame)
        size = camera.design.region_size
        summaries = outcome.action == fv.ACTIONS.index("summarize")
        sent += outcome.active.sum() * size * size + summaries.sum() * 4
        if number % every and "zones" not in keys:
            continue
        boxes = detector.boxes(outcome.rendered)
        if "zones" in keys:
            seen = np.maximum((np.zeros(outcome.active.shape, int) if seen is None else seen) - 1, 0)
            seen[near(boxes, seen.shape, size)] = HELD_FRAMES
        if number % every == 0:
            same = matches(boxes, whole[number])
            kept, found, count = kept + same, found + len(boxes), count + len(whole[number])
    raw = sum(frame.size for frame in clip_frames)
    return [f"{100 * sent / raw:.2f}", f"{100 * keen / len(clip_frames):.1f}", count, f"{100 * kept / count:.1f}", f"{100 * kept / found:.1f}"]


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("network")
    parser.add_argument("clips", nargs="+")
    parser.add_argument("--frames", type=int, default=60)
    parser.add_argument("--every", type=int, default=5)
    arguments = parser.parse_args()
    detector, table = Detector(arguments.network), csv.writer(sys.stdout, lineterminator="\n")
    table.writerow(["clip", "camera", "sent_percent", "keen_percent", "found", "kept_percent", "right_percent"])
    for clip in arguments.clips:
        clip_frames = frames(clip, arguments.frames)
        whole = {number: detector.boxes(clip_frames[number]) for number in range(0, len(clip_frames), arguments.every)}
        for name, keys in CAMERAS.items():
            name_of_clip = os.path.basename(clip).rsplit(".", 1)[0]
            table.writerow([name_of_clip, name, *measure(detector, clip_frames, whole, keys, arguments.every)])
            sys.stdout.flush()


if __name__ == "__main__":
    main()
