#!/usr/bin/env python3
# SPDX-License-Identifier: MIT OR Apache-2.0
"""Compares settings for preset `fovea`, for docs/data/fovea-choice.csv and fovea-clips.csv.

    fovea.py NETWORK CLIP... [OPTION...]

NETWORK is one of the detectors that sight.py knows. It runs on every fifth of the first frames of each clip, on whole frames and on what
the receiver sees, behind preset `fovea` with every combination of the values that --feature, --level, --min-score, --temporal and
--periphery give. Three columns have the share of the objects in whole frames that are kept, the share of the detections that are right, and
the bytes as a share of raw video. The rows go to standard output.

Needs `foveate` on the path (or its path in FOVEATE).
"""
import argparse
import csv
import itertools
import os
import sys

from sight import NETWORKS, foveate

COLUMNS = ["network", "clip", "feature", "level", "min_score", "temporal_level", "periphery_level", "frames", "found", "kept_percent",
           "right_percent", "sent_percent"]


def camera_options(feature, level, minimum, temporal, periphery):
    """Returns the options of a camera."""
    level_text = "" if level is None else f",level={level}"
    return ["--preset", "fovea", "--set", f'spatial=[{{feature="{feature}",min_score={minimum}{level_text}}}]',
            "--set", f"temporal.level={temporal}", "--set", f"periphery.level={periphery}"]


def table_row(path, clip, settings, arguments):
    """Returns the row of a network, a clip and the settings of a camera."""
    name = os.path.basename(path)
    framing, detector = NETWORKS[name]
    summary = foveate((path, (framing, detector)), clip, "--every", str(arguments.every), "--max-frames", str(arguments.first),
                      "--noise", "0", "--threads", "1", "--detect", detector, *camera_options(*settings))
    sight = summary["sight"]
    found = sight["detections"]["all"]["whole"]
    shares = [f"{100 * sight['detections'][key]:.1f}" if found else "" for key in ("kept_share", "precision")]
    return [name.rsplit(".", 1)[0], os.path.basename(clip).rsplit(".", 1)[0], *("" if value is None else value for value in settings),
            summary["counted_frames"], found, *shares, f"{100 * sight['sent_share']:.2f}"]


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("network")
    parser.add_argument("clips", nargs="+")
    parser.add_argument("--every", type=int, default=5, help="the network runs on one of so many frames")
    parser.add_argument("--first", type=int, default=60, help="the camera sees so many frames")
    parser.add_argument("--feature", nargs="+", default=["edge"])
    parser.add_argument("--level", nargs="+", type=int, default=[None], help="the feature's default without it")
    parser.add_argument("--min-score", nargs="+", type=float, default=[4])
    parser.add_argument("--temporal", nargs="+", type=int, default=[16])
    parser.add_argument("--periphery", nargs="+", type=int, default=[1])
    arguments = parser.parse_args()
    table = csv.writer(sys.stdout, lineterminator="\n")
    table.writerow(COLUMNS)
    for values in itertools.product(arguments.feature, arguments.level, arguments.min_score, arguments.temporal, arguments.periphery):
        for clip in arguments.clips:
            table.writerow(table_row(arguments.network, clip, values, arguments))
            sys.stdout.flush()


if __name__ == "__main__":
    main()
