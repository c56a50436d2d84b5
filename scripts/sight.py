#!/usr/bin/env python3
# SPDX-License-Identifier: MIT OR Apache-2.0
"""What networks lose behind cameras: docs/data/network-sight.csv.

    sight.py NETWORKS CLIP... [--frames N] [--only NAME]

NETWORKS holds the trained networks of the table below. Every network runs on every clip, on the whole frames and on what the receiver of each camera
sees. A clip is a file, or a folder of images with ground-truth boxes in gt.txt. The rows go to standard output.

Needs `foveate` on the path (or its path in FOVEATE).
"""
import argparse
import csv
import json
import os
import subprocess
import sys
import tempfile

# How each network is shown frames, and how its detections are read.
NETWORKS = {
    "yolox_nano.onnx": (["--framing", "letterbox", "--scale", "1/255"], "yolox"),
    "FastestDet.onnx": (["--framing", "stretch"], "fastestdet"),
    "yunet_n_320_320.onnx": (["--framing", "letterbox", "--scale", "1/255"], "yunet"),
    "RFB-320.onnx": (["--framing", "stretch", "--mean", "0.498039", "--scale", "128/255"], "ssd"),
    "SqueezeNet_fp16.onnx": (["--framing", "stretch", "--mean", "0.407843,0.458824,0.486275", "--scale", "1/255"], None),
    "deeplab_nchw.onnx": (["--framing", "stretch", "--mean", "0.5", "--scale", "0.5"], None),
    "prisma_nchw.onnx": (["--framing", "stretch"], None),
}
# Which objects of COCO a file of pedestrians has.
PEDESTRIANS = "classes=0,height=80"


def means(blocks, *more):
    return ["--preset", "fovea", "--set", f"periphery.blocks={blocks}", *more]


# What irrelevant regions show, and thresholds.
CAMERAS = {
    "paper": ["--preset", "paper"],
    "hold": ["--preset", "steady"],
    "mean 1": means(1),
    "fovea (mean 2)": means(2),
    "fovea; median": means(2, "--set", 'denoise.filter="median3x3"'),
    "mean 4": means(4),
    "mean 4; level 2; temporal.level 4": means(4, "--set", "periphery.level=2", "--set", "temporal.level=4"),
    "fovea; level 8": means(2, "--set", "periphery.level=8"),
    "fovea; level 16": means(2, "--set", "periphery.level=16"),
    "fovea; level 32": means(2, "--set", "periphery.level=32"),
}
COLUMNS = ["network", "clip", "camera", "frames", "sent_percent", "psnr_db", "macs_percent", "agreement_percent", "found", "kept_percent",
           "precision_percent", "objects", "ap50_whole", "ap50_seen"]


def run(network, clip, camera, frames):
    """The summary of a run."""
    path, (options, detector) = network
    boxes = ["--boxes", "gt.txt"] if os.path.isdir(clip) and detector == "yolox" else []
    detect = ["--detect", f"{detector},{PEDESTRIANS}" if boxes else detector] if detector else []
    with tempfile.TemporaryDirectory() as folder:
        command = [os.environ.get("FOVEATE", "foveate"), "infer", path, clip, "-o", os.path.join(folder, "out"), "--json", "--quiet",
                   "--whole-frames", "--max-frames", str(frames), *options, *detect, *boxes, *camera]
        done = subprocess.run(command, capture_output=True, text=True)
    if done.returncode != 0:
        raise SystemExit(f"sight: {' '.join(command)}: {done.stderr.strip()}")
    return json.loads(done.stdout)


def row(network, clip, camera, summary):
    """A row of the table."""
    sight, macs = summary["sight"], summary["macs"]
    found, truth = sight["detections"], sight["truth"]

    def shown(value, digits=1):
        return "" if value is None else f"{value:.{digits}f}"

    def percent(value):
        return shown(100 * value)

    return dict(zip(COLUMNS, [
        network, os.path.basename(clip.rstrip("/")).rsplit(".", 1)[0], camera, summary["counted_frames"], shown(100 * sight["sent_share"], 2),
        shown(sight["picture_psnr"]), percent(macs["needed"] / macs["dense"]), percent(sight["agreement"]),
        *([found["all"]["whole"], percent(found["kept_share"]), percent(found["precision"])] if found else [""] * 3),
        *([truth["objects"], percent(truth["whole_ap50"]), percent(truth["seen_ap50"])] if truth else [""] * 3)], strict=True))


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("networks")
    parser.add_argument("clips", nargs="+")
    parser.add_argument("--frames", type=int, default=40)
    parser.add_argument("--only", help="a part of the name of a network")
    arguments = parser.parse_args()
    table = csv.DictWriter(sys.stdout, COLUMNS, lineterminator="\n")
    table.writeheader()
    for name, options in NETWORKS.items():
        if arguments.only and arguments.only not in name:
            continue
        for clip in arguments.clips:
            for camera, settings in CAMERAS.items():
                summary = run((os.path.join(arguments.networks, name), options), clip, settings, arguments.frames)
                table.writerow(row(name.rsplit(".", 1)[0], clip, camera, summary))
                sys.stdout.flush()


if __name__ == "__main__":
    main()
