#!/usr/bin/env python3
# SPDX-License-Identifier: MIT OR Apache-2.0
"""Compares the filters, for docs/data/filters-noise.csv, filters-network.csv and filters-area.csv.

    filters.py [--frames N] noise CLIP...
    filters.py [--frames N] [--first N] network NETWORK CLIP...
    filters.py area

`noise` adds noise to the first N frames of each clip, and writes the PSNR of the denoised frames against those without added noise.
Impulse noise makes a share of the pixels black or white; Gaussian noise has a standard deviation in grey levels. `network` runs
YOLOX-nano on N frames, spread evenly over the first frames of each clip, 600 by default, behind preset `fovea` with `variance` of at
least 40, `temporal.level` 20 and `periphery.level` 1, with each filter. The camera sends denoised or raw pixels.
`area` prints the LUTs and flip-flops of an RPU with each filter. The rows go to standard output.

`noise` needs the Python package, and the others `foveate` on the path (or its path in FOVEATE), and ffprobe, of ffmpeg.
"""
import argparse
import csv
import os
import sys
import tempfile

from indexes import FRAMING, foveate, settings
from sight import frame_count

FILTERS = ["none", "median3x3", "switching3x3", "binomial3x3"]
# The kinds of noise with their amounts: percent of the pixels, or grey levels.
NOISES = [("none", 0), *(("impulse", percent) for percent in (1, 5, 10)), *(("gaussian", sigma) for sigma in (2, 5, 10))]


def clip_name(clip):
    return os.path.basename(clip).rsplit(".", 1)[0]


def filter_option(name):
    return f'denoise.filter="{name}"'


def noisy(frame, kind, amount, chance):
    """Returns a frame of 8 bits with noise."""
    import numpy as np

    if kind == "none":
        return frame
    if kind == "impulse":
        hit = chance.random(frame.shape) < amount / 100
        return np.where(hit, 255 * chance.integers(0, 2, frame.shape), frame).astype(np.uint8)
    return np.clip(np.rint(frame + chance.normal(0, amount, frame.shape)), 0, 255).astype(np.uint8)


def noise_rows(clips, frames):
    """Yields the rows of the table of PSNR. Cameras whose regions are always active show the denoised frame."""
    import numpy as np

    import foveate as fv

    always = {"spatial": [{"feature": "edge", "min_score": 0}], "temporal": {"min_count": 0}}
    yield ["clip", "noise", "amount", "filter", "psnr_db"]
    for clip in clips:
        whole = fv.Camera("paper", denoise={"filter": "none"}, **always)
        clean = [outcome.rendered.copy() for outcome in fv.simulate(clip, whole, max_frames=frames)]
        for kind, amount in NOISES:
            for name in FILTERS:
                camera = fv.Camera("paper", denoise={"filter": name}, **always)
                chance, error = np.random.default_rng(0), 0.0
                for frame in clean:
                    shown = camera.step(noisy(frame, kind, amount, chance)).rendered
                    error += np.mean((shown.astype(float) - frame) ** 2) / len(clean)
                yield [clip_name(clip), kind, amount, name, "" if error == 0 else f"{10 * np.log10(255**2 / error):.2f}"]


def network_rows(network, clips, frames, first):
    """Yields the rows of the table of networks."""
    yield ["clip", "filter", "payload", "frames", "sent_percent", "found", "kept_percent", "right_percent"]
    for clip in clips:
        every = max(min(frame_count(clip), first) // frames, 1)
        for name in FILTERS:
            for payload in ["denoised", "raw"] if name != "none" else ["denoised"]:
                with tempfile.TemporaryDirectory() as folder:
                    camera = [*settings("variance", None, 40), "--set", filter_option(name), "--set", f'render.payload="{payload}"']
                    camera += ["--max-frames", first, "--every", every, "--noise", "0"]
                    summary = foveate("infer", network, clip, "-o", os.path.join(folder, "out"), *FRAMING, *camera)
                sight = summary["sight"]
                found = sight["detections"]["all"]["whole"]
                shares = [f"{100 * sight['detections'][key]:.1f}" if found else "" for key in ("kept_share", "precision")]
                yield [clip_name(clip), name, payload, summary["counted_frames"], f"{100 * sight['sent_share']:.2f}", found, *shares]


def area_rows():
    """Yields the rows of the table of areas, without and with a filter in front of the default feature."""
    yield ["filter", "lut", "ff", "clock_mhz"]
    for name in FILTERS:
        report = foveate("estimate", "--preset", "paper", "--set", filter_option(name))
        yield [name, report["rpu"]["lut_total_packed"], report["rpu"]["ff"], f"{report['clock']['mhz']:.0f}"]


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--frames", type=int, default=60)
    parser.add_argument("--first", type=int, default=600)
    tables = parser.add_subparsers(dest="table", required=True)
    tables.add_parser("noise").add_argument("clips", nargs="+")
    network = tables.add_parser("network")
    network.add_argument("network")
    network.add_argument("clips", nargs="+")
    tables.add_parser("area")
    arguments = parser.parse_args()
    if arguments.table == "noise":
        rows = noise_rows(arguments.clips, arguments.frames)
    elif arguments.table == "network":
        rows = network_rows(arguments.network, arguments.clips, arguments.frames, arguments.first)
    else:
        rows = area_rows()
    table = csv.writer(sys.stdout, lineterminator="\n")
    for row in rows:
        table.writerow(row)
        sys.stdout.flush()


if __name__ == "__main__":
    main()
