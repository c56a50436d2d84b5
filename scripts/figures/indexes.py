#!/usr/bin/env python3
# SPDX-License-Identifier: MIT OR Apache-2.0
"""Compares the relevance indexes, for docs/data/indexes.csv and indexes-area.csv.

    indexes.py [--share PERCENT] [--first N] [--frames N] clips NETWORK CLIP... --calibrate CLIP...
    indexes.py area

`clips` runs YOLOX-nano behind preset `fovea` with `temporal.level` 20 and `periphery.level` 1, where each index is the only feature.
So that all indexes send as much, each gets the minimum score with which the clips of --calibrate send nearest to PERCENT of their
bytes, 5.2 by default. These clips are best others than those of the table. `flow` has reference `previous`, because a camera with
`last-sent` would never send anything by `flow` alone. Of each clip, the camera sees the first frames, 600 by default. For each clip
and index, the network runs on N of them, evenly spread: on whole frames, on these with noise, and on the receiver's screen. A clip
may be a scene of the program (scene:NAME). The column `relevant_percent` is the share of the objects of whole frames of which at
least half of the regions have SRS = 1, and `missed_percent` the share of those without an active region in that frame.

`area` prints what `foveate estimate` finds for preset `fovea` with each index and its defaults: for an RPU of organization
`pipelined`, which cannot compute `flow`, and for a lane of `serial` with a lane for each region. The rows go to standard output.

Needs `foveate` on the path (or its path in FOVEATE), and ffprobe, of ffmpeg.
"""
import argparse
import csv
import json
import os
import subprocess
import sys
import tempfile

from fovea import camera_options
from sight import NETWORKS, NOISE, frame_count

# The levels of an index, if it has one, and the minimum scores that are tried.
INDEXES = {
    "edge": ([100], [1, 2, 3, 4, 5, 6, 8, 10, 13, 16, 20]),
    "corner": ([12], [1, 2, 3, 4, 5, 6, 8]),
    "mad": ([], [0.5, 1, 1.5, 2, 3, 4, 5, 6, 8, 10]),
    "variance": ([], [5, 10, 15, 20, 30, 40, 60, 90, 130]),
    "range": ([], [4, 8, 12, 16, 20, 25, 30, 40, 50, 60]),
    "surface": ([], [0.5, 1, 1.5, 2, 3, 4, 5, 6, 8, 10]),
    "segment": ([8], [1, 2, 3, 4, 6, 8, 10, 13, 16, 20, 24]),
    "flow": ([], [0.1, 0.25, 0.5, 1, 1.5, 2, 3, 4, 6, 8, 12]),
}
PREVIOUS = ["--set", 'temporal.reference="previous"']
SERIAL = ["--set", 'hardware.organization="serial"']
FRAMING = [*NETWORKS["yolox_nano.onnx"][0], "--detect", NETWORKS["yolox_nano.onnx"][1]]
COLUMNS = ["clip", "index", "level", "min_score", "frames", "sent_percent", "active_percent", "found",
           "kept_percent", "right_percent", "relevant_percent", "missed_percent",
           *(f"noise{level}_agreement" for level in NOISE)]


def foveate(*words):
    """Returns what a command prints as JSON."""
    command = [os.environ.get("FOVEATE", "foveate"), *map(str, words), "--json", "--quiet"]
    result = subprocess.run(command, capture_output=True, text=True)
    if result.returncode != 0:
        raise SystemExit(f"indexes: {' '.join(command)}: {result.stderr.strip()}")
    return json.loads(result.stdout)


def settings(index, level, minimum):
    """Returns the options of a camera."""
    options = camera_options(index, level, minimum, temporal=20, periphery=1)
    return options if index != "flow" else [*options, *PREVIOUS, *SERIAL]


def sent_percent(clips, camera):
    """Returns the mean share of bytes that a camera sends of some clips."""
    shares = []
    for clip in clips:
        with tempfile.TemporaryDirectory() as folder:
            summary = foveate("simulate", clip, "-o", os.path.join(folder, "out"), *camera)
        rates = summary["bandwidth"]
        shares.append(100 * rates["region"]["bytes"] / rates["raw"]["bytes"])
    return sum(shares) / len(shares)


def calibrated_minimum(index, level, minima, arguments):
    """Returns the minimum score with which the camera sends nearest to a share of the bytes. A higher minimum never sends more."""
    low, high = 0, len(minima) - 1
    measured = {}

    def error(place):
        if place not in measured:
            camera = [*settings(index, level, minima[place]), "--max-frames", arguments.first]
            measured[place] = sent_percent(arguments.calibrate, camera) - arguments.share
        return measured[place]

    while high - low > 1:
        middle = (low + high) // 2
        low, high = (middle, high) if error(middle) > 0 else (low, middle)
    return minima[min((low, high), key=lambda place: abs(error(place)))]


def recall_percents(folder, clip, camera):
    """Returns the shares of relevant and of missed objects, among those that an inference found in whole frames."""
    boxes = os.path.join(folder, "gt.txt")
    with open(os.path.join(folder, "out", "detections.csv")) as source, open(boxes, "w") as target:
        rows = csv.DictReader(line for line in source if not line.startswith("#"))
        for number, row in enumerate(row for row in rows if row["whole"] == "true"):
            x0, y0, x1, y1 = (float(row[key]) for key in ("x0", "y0", "x1", "y1"))
            target.write(f"{int(row['frame']) + 1},{number},{x0:.2f},{y0:.2f},{x1 - x0:.2f},{y1 - y0:.2f},1,1,1\n")
    if os.path.getsize(boxes) == 0:
        return ["", ""]
    study = foveate("analyze", "recall", clip, "--boxes", boxes, "-o", os.path.join(folder, "recall"), *camera)
    rows = [dict(zip(study["columns"], row, strict=True)) for row in study["rows"]]
    shares = {row["vote"]: row for row in rows if row["key"] == "design" and row["group"] == row["class"] == "all"}
    return [f"{100 * float(shares[vote][key]):.1f}" for vote, key in (("srs", "half"), ("active", "missed"))]


def area_rows():
    """Yields the rows of the table of areas."""
    yield ["index", "rpu_lut", "rpu_clock_mhz", "lane_lut", "lane_clock_mhz", "lane_clocks_per_frame"]
    for index in INDEXES:
        camera = ["--preset", "fovea", "--set", f'spatial=[{{feature="{index}"}}]', *(PREVIOUS if index == "flow" else [])]
        reports = [None if index == "flow" else foveate("estimate", *camera), foveate("estimate", *camera, *SERIAL)]
        figures = [(report["rpu"]["lut_total_packed"], f"{report['clock']['mhz']:.0f}") if report else ("", "") for report in reports]
        yield [index, *figures[0], *figures[1], reports[1]["clocks_per_frame"]]


def calibrated_cameras(arguments):
    """Returns the settings of a camera for each index, its level and its minimum score."""
    cameras = {}
    for index, (levels, minima) in INDEXES.items():
        for level in levels or [None]:
            minimum = calibrated_minimum(index, level, minima, arguments)
            cameras[index, level, minimum] = [*settings(index, level, minimum), "--max-frames", arguments.first]
            print(f"indexes: {index} has min_score {minimum}", file=sys.stderr)
    return cameras


def clip_rows(arguments):
    """Yields the rows of the table of clips."""
    cameras = calibrated_cameras(arguments)
    yield COLUMNS
    for clip in arguments.clips:
        length = arguments.first if clip.startswith("scene:") else min(frame_count(clip), arguments.first)
        every, noise = max(length // arguments.frames, 1), None
        name = os.path.basename(clip).rsplit(".", 1)[0].removeprefix("scene:")
        for (index, level, minimum), camera in cameras.items():
            with tempfile.TemporaryDirectory() as folder:
                levels = "0" if noise is not None else ",".join(map(str, NOISE))
                out = os.path.join(folder, "out")
                summary = foveate("infer", arguments.network, clip, "-o", out, "--every", every, "--noise", levels, *FRAMING, *camera)
                recall = recall_percents(folder, clip, camera)
            sight = summary["sight"]
            # Whole frames, also those with noise, are the same for every camera.
            noise = noise if noise is not None else [f"{100 * level['agreement']:.1f}" for level in sight["noise"]]
            found = sight["detections"]["all"]["whole"]
            shares = [f"{100 * sight['detections'][key]:.1f}" if found else "" for key in ("kept_share", "precision")]
            yield [name, index, "" if level is None else level, minimum, summary["counted_frames"], f"{100 * sight['sent_share']:.2f}",
                   f"{100 * summary['active_share']:.2f}", found, *shares, *recall, *noise]


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--share", type=float, default=5.2)
    parser.add_argument("--frames", type=int, default=60)
    parser.add_argument("--first", type=int, default=600)
    tables = parser.add_subparsers(dest="table", required=True)
    clips = tables.add_parser("clips")
    clips.add_argument("network")
    clips.add_argument("clips", nargs="+")
    clips.add_argument("--calibrate", nargs="+", required=True)
    tables.add_parser("area")
    arguments = parser.parse_args()
    table = csv.writer(sys.stdout, lineterminator="\n")
    for row in clip_rows(arguments) if arguments.table == "clips" else area_rows():
        table.writerow(row)
        sys.stdout.flush()


if __name__ == "__main__":
    main()
