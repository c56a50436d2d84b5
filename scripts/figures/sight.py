#!/usr/bin/env python3
# SPDX-License-Identifier: MIT OR Apache-2.0
"""Measures what networks lose behind cameras, for docs/data/network-sight.csv.

    sight.py NETWORKS CLIP... [--frames N] [--only NAME]

NETWORKS holds the trained networks of the table below. Every network runs on every clip, on whole frames, on these with noise, and on what the
receiver of each camera sees: at least N frames, spread evenly over the whole clip, of which the camera sees all. A clip is a file, or a folder of
images with ground-truth boxes in gt.txt. The MACs are those of a network that sees every frame, of the first 24. The rows go to standard output.

Needs `foveate` on the path (or its path in FOVEATE), and ffprobe, of ffmpeg.
"""
import argparse
import csv
import json
import os
import subprocess
import sys
import tempfile

# The framing of each network, and the format of its detections.
NETWORKS = {
    "yolox_nano.onnx": (["--framing", "letterbox", "--scale", "1/255"], "yolox"),
    "FastestDet.onnx": (["--framing", "stretch"], "fastestdet"),
    "yunet_n_320_320.onnx": (["--framing", "letterbox", "--scale", "1/255"], "yunet"),
    "RFB-320.onnx": (["--framing", "stretch", "--mean", "0.498039", "--scale", "128/255"], "ssd"),
    "SqueezeNet_fp16.onnx": (["--framing", "stretch", "--mean", "0.407843,0.458824,0.486275", "--scale", "1/255"], None),
    "deeplab_nchw.onnx": (["--framing", "stretch", "--mean", "0.5", "--scale", "0.5"], None),
    "prisma_nchw.onnx": (["--framing", "stretch"], None),
}
# The classes of COCO that a file of pedestrians has.
PEDESTRIANS = "classes=0,height=80"


def mean_camera(blocks, *more):
    return ["--preset", "fovea", "--set", f"periphery.blocks={blocks}", *more]


# The rendering of irrelevant regions, and the thresholds.
CAMERAS = {
    "paper": ["--preset", "paper"],
    "hold": ["--preset", "steady"],
    "mean 1": mean_camera(1),
    "fovea (mean 2)": mean_camera(2),
    "fovea; median": mean_camera(2, "--set", 'denoise.filter="median3x3"'),
    "mean 4": mean_camera(4),
    "mean 4; level 2; temporal.level 4": mean_camera(4, "--set", "periphery.level=2", "--set", "temporal.level=4"),
    "fovea; level 8": mean_camera(2, "--set", "periphery.level=8"),
    "fovea; level 16": mean_camera(2, "--set", "periphery.level=16"),
    "fovea; level 32": mean_camera(2, "--set", "periphery.level=32"),
}
# The standard deviations of the noise, in grey levels.
NOISE = [1, 2, 4]
# The number of frames over which MACs are counted.
MAC_FRAMES = 24
COLUMNS = ["network", "clip", "camera", "frames", "every", "sent_percent", "psnr_db", "macs_percent", "agreement_percent", "agreement_low",
           "agreement_high", "found", "kept_percent", "precision_percent", "objects", "ap50_whole", "ap50_seen",
           *(f"noise{level}_{figure}" for level in NOISE for figure in ["agreement", "kept", "precision"])]


def foveate(network, clip, *more):
    """Returns the summary of a run."""
    path, (options, _) = network
    with tempfile.TemporaryDirectory() as folder:
        command = [os.environ.get("FOVEATE", "foveate"), "infer", path, clip, "-o", os.path.join(folder, "out"), "--json", "--quiet", *options, *more]
        result = subprocess.run(command, capture_output=True, text=True)
    if result.returncode != 0:
        raise SystemExit(f"sight: {' '.join(command)}: {result.stderr.strip()}")
    return json.loads(result.stdout)


def run(network, clip, camera, every, noise):
    """Returns the summary of a run that is compared with whole frames."""
    detector = network[1][1]
    boxes = ["--boxes", "gt.txt"] if os.path.isdir(clip) and detector == "yolox" else []
    detect = ["--detect", f"{detector},{PEDESTRIANS}" if boxes else detector] if detector else []
    return foveate(network, clip, "--whole-frames", "--every", str(every), "--noise", noise, *detect, *boxes, *camera)


def frame_count(clip):
    """Returns the number of frames of a clip."""
    if os.path.isdir(clip):
        return sum(name.endswith((".jpg", ".png")) for name in os.listdir(clip))
    command = ["ffprobe", "-v", "error", "-select_streams", "v:0", "-count_packets"]
    command += ["-show_entries", "stream=nb_read_packets", "-of", "csv=p=0", clip]
    result = subprocess.run(command, capture_output=True, text=True)
    if result.returncode != 0:
        raise SystemExit(f"sight: {' '.join(command)}: {result.stderr.strip()}")
    return int(result.stdout.strip().strip(","))


def table_row(network, clip, camera, summary, noise, macs):
    """Returns a row of the table."""
    sight = summary["sight"]
    detections, truth = sight["detections"], sight["truth"]

    def number_text(value, digits=1):
        return "" if value is None else f"{value:.{digits}f}"

    def percent(value):
        return number_text(100 * value)

    def percent_or_empty(value):
        return "" if value is None else percent(value)

    return dict(zip(COLUMNS, [
        network, os.path.basename(clip.rstrip("/")).rsplit(".", 1)[0], camera, summary["counted_frames"], summary["every"],
        number_text(100 * sight["sent_share"], 2), number_text(sight["picture_psnr"]),
        percent(macs["needed"] / macs["dense"]), percent(sight["agreement"]),
        *map(percent_or_empty, sight["intervals"]["agreement"] or [None] * 2),
        *([detections["all"]["whole"], percent(detections["kept_share"]), percent(detections["precision"])] if detections else [""] * 3),
        *([truth["objects"], percent(truth["whole_ap50"]), percent(truth["seen_ap50"])] if truth else [""] * 3),
        *(percent_or_empty(level[figure]) for level in noise for figure in ["agreement", "kept_share", "precision"])], strict=True))


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("networks")
    parser.add_argument("clips", nargs="+")
    parser.add_argument("--frames", type=int, default=60)
    parser.add_argument("--only", help="a part of the name of a network")
    arguments = parser.parse_args()
    table = csv.DictWriter(sys.stdout, COLUMNS, lineterminator="\n")
    table.writeheader()
    for name, options in NETWORKS.items():
        if arguments.only and arguments.only not in name:
            continue
        network = (os.path.join(arguments.networks, name), options)
        for clip in arguments.clips:
            every, noise = max(frame_count(clip) // arguments.frames, 1), []
            for camera, settings in CAMERAS.items():
                # Whole frames, also those with noise, are the same for every camera.
                summary = run(network, clip, settings, every, "0" if noise else ",".join(map(str, NOISE)))
                noise = noise or summary["sight"]["noise"]
                macs = foveate(network, clip, "--max-frames", str(MAC_FRAMES), *settings)["macs"]
                table.writerow(table_row(name.rsplit(".", 1)[0], clip, camera, summary, noise, macs))
                sys.stdout.flush()


if __name__ == "__main__":
    main()
