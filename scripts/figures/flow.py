#!/usr/bin/env python3
# SPDX-License-Identifier: MIT OR Apache-2.0
"""Measures the index `flow`, for docs/data/flow-noise.csv, flow-pans.csv and flow-clips.csv.

    flow.py noise IMAGE
    flow.py pans IMAGE
    flow.py clips CLIP... [--frames N]

`noise` shows an image twice, each time with other Gaussian noise, and counts the regions that vote although nothing moves. `pans` moves
the view over an image by known steps, and compares the displacements of the regions that vote, OpenCV's dense flow (DIS) averaged over
each region, and OpenCV's phase correlation of each region and of the whole view. A displacement is right if it equals the step, once
rounded. `clips` compares the displacements of the regions that vote with DIS on the first N frames of real clips: the share of the votes
that differ from it by at most one pixel in both directions, among all votes, where DIS counts as the radius if it is larger, and among
those within reach, where DIS is no larger than the radius.

The rows go to standard output. Needs the Python package, numpy and opencv-python-headless.
"""
import argparse
import csv
import itertools
import os
import sys

import cv2
import numpy as np

import foveate as fv

SIZE = (448, 320)
RADII = [1, 2, 3]
MINIMA = [1, 2, 3]
SIGMAS = [1, 2, 4, 8]
STEPS = [(1, 0), (0, -1), (2, 1), (-3, 2)]


def camera(radius, minimum, side=8, size=SIZE):
    width, height = size
    return fv.Camera(
        "serial",
        frame={"width": width, "height": height},
        region={"size": side},
        denoise={"filter": "none"},
        spatial=[{"feature": "flow", "radius": radius, "min_score": minimum}],
        temporal={"reference": "previous"},
    )


def with_noise(frame, sigma, chance):
    """Returns a frame of 8 bits with Gaussian noise."""
    return np.clip(np.rint(frame + chance.normal(0, sigma, frame.shape)), 0, 255).astype(np.uint8)


def view(image, step=(0, 0), margin=16):
    """Returns the part of an image that a camera sees whose content has moved by `step`."""
    (width, height), (right, down) = SIZE, step
    return np.ascontiguousarray(image[margin - down :, margin - right :][:height, :width])


def gray_image(path):
    """Returns an image that is large enough for every view."""
    image = cv2.imread(path, cv2.IMREAD_GRAYSCALE)
    if image is None:
        raise SystemExit(f"flow: {path} is not an image that OpenCV can read")
    width, height = (side + 32 for side in SIZE)
    scale = max(width / image.shape[1], height / image.shape[0], 1)
    return cv2.resize(image, None, fx=scale, fy=scale) if scale > 1 else image


def motion(frames, radius, minimum, side=8):
    """Returns the votes and the displacements of the last frame."""
    height, width = frames[0].shape
    own = camera(radius, minimum, side, (width, height))
    outcome = [own.step(frame, keep=True) for frame in frames][-1]
    return outcome.srs, outcome.displacements


def noise_rows(path):
    chance = np.random.default_rng(1)
    image = view(gray_image(path))
    yield ["side", "radius", "min_score", "sigma", "votes_percent"]
    for side, radius, minimum, sigma in itertools.product([4, 8, 16], RADII, MINIMA, SIGMAS):
        votes = [motion([with_noise(image, sigma, chance) for _ in range(2)], radius, minimum, side)[0] for _ in range(4)]
        yield [side, radius, minimum, sigma, f"{100 * np.mean(votes):.2f}"]


def region_means(field, side):
    """Returns the mean vector of a dense field in every region, for frames that consist of whole regions."""
    height, width, _ = field.shape
    return field.reshape(height // side, side, width // side, side, 2).mean(axis=(1, 3))


def dense_flow(before, now):
    return cv2.DISOpticalFlow_create(cv2.DISOPTICAL_FLOW_PRESET_MEDIUM).calc(before, now, None)


def region_phases(before, now, side):
    """Returns the displacement of every region by phase correlation."""
    rows, columns = (length // side for length in now.shape)
    found = np.zeros((rows, columns, 2))
    for row, column in np.ndindex(rows, columns):
        place = np.s_[row * side :, column * side :]
        pair = [np.float32(frame[place][:side, :side]) for frame in (before, now)]
        found[row, column] = cv2.phaseCorrelate(*pair)[0]
    return found


def right_percent(found, step, votes):
    """Returns the share of the votes whose displacement is the step, in percent."""
    hits = np.all(np.rint(found[votes]) == step, axis=-1)
    return f"{100 * hits.mean():.1f}" if hits.size else ""


def pan_rows(path):
    chance = np.random.default_rng(2)
    image = gray_image(path)
    yield ["step", "sigma", "side", "votes_percent", "flow_right", "dis_right", "phase_right", "whole_phase"]
    for step, sigma, side in itertools.product(STEPS, [0, 2], [8, 16]):
        frames = [with_noise(view(image, moved), sigma, chance) if sigma else view(image, moved) for moved in ((0, 0), step)]
        votes, found = motion(frames, 3, 2, side)
        dense = region_means(dense_flow(*frames), side)
        phases = region_phases(*frames, side)
        shares = [right_percent(other, step, votes) for other in (found, dense, phases)]
        whole = cv2.phaseCorrelate(*map(np.float32, frames))[0]
        yield [f"{step[0]} {step[1]}", sigma, side, f"{100 * votes.mean():.1f}", *shares, f"{whole[0]:.2f} {whole[1]:.2f}"]


def clip_frames(path, count):
    """Returns the first frames of a clip in grey, cut to whole regions of 8x8 pixels."""
    capture, frames = cv2.VideoCapture(path), []
    while len(frames) < count:
        is_read, frame = capture.read()
        if not is_read:
            break
        height, width = (side // 8 * 8 for side in frame.shape[:2])
        frames.append(np.ascontiguousarray(cv2.cvtColor(frame, cv2.COLOR_BGR2GRAY)[:height, :width]))
    if len(frames) < 2:
        raise SystemExit(f"flow: {path} is not a clip of two or more frames that OpenCV can read")
    return frames


def clip_rows(clips, count):
    yield ["clip", "radius", "frames", "votes_percent", "moving_percent", "near_percent", "reach_percent", "near_in_reach_percent"]
    for clip in clips:
        frames = clip_frames(clip, count)
        dense = [region_means(dense_flow(*pair), 8) for pair in itertools.pairwise(frames)]
        for radius in RADII:
            yield [os.path.basename(clip).rsplit(".", 1)[0], radius, len(frames), *clip_shares(frames, dense, radius)]


def percent_text(parts, digits=1):
    """Returns the mean of some numbers, in percent, or nothing if there are none."""
    return f"{100 * np.mean(parts):.{digits}f}" if len(parts) else ""


def clip_shares(frames, dense, radius):
    """Returns the shares of regions that vote and that move by DIS, and of votes near DIS, within reach, and near DIS among these."""
    own = camera(radius, 2, 8, frames[0].shape[::-1])
    own.step(frames[0])
    votes, moving, near, within = [], [], [], []
    for field, frame in zip(dense, frames[1:], strict=True):
        outcome = own.step(frame, keep=True)
        distance = np.abs(outcome.displacements - np.clip(field, -radius, radius)).max(axis=-1)
        speed = np.abs(field).max(axis=-1)
        votes.append(outcome.srs.mean())
        moving.append((speed >= 0.5).mean())
        near.extend(distance[outcome.srs] <= 1)
        within.extend(speed[outcome.srs] <= radius)
    near, within = np.array(near, bool), np.array(within, bool)
    return percent_text(votes, 2), percent_text(moving, 2), percent_text(near), percent_text(within), percent_text(near[within])


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("table", choices=["noise", "pans", "clips"])
    parser.add_argument("paths", nargs="+", metavar="PATH")
    parser.add_argument("--frames", type=int, default=60, metavar="N")
    args = parser.parse_args()
    rows = {
        "noise": lambda: noise_rows(args.paths[0]),
        "pans": lambda: pan_rows(args.paths[0]),
        "clips": lambda: clip_rows(args.paths, args.frames),
    }
    writer = csv.writer(sys.stdout, lineterminator="\n")
    for row in rows[args.table]():
        writer.writerow(row)
        sys.stdout.flush()


if __name__ == "__main__":
    main()
