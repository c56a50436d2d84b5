#!/usr/bin/env python3
# SPDX-License-Identifier: MIT OR Apache-2.0
"""Counts how much damage to photographs is refused.

    scripts/figures/damaged_images.py FOLDER [--each 4] [--command target/release/foveate]

Takes 200 JPEGs of the folder and those below it, at random but always the same ones, damages each of them in several ways,
and has `foveate explain` read the result. Prints a row for each kind of damage. Fails if a whole picture is refused, or if
one that is cut or has 2,000 zeros in it is accepted, because the format makes such damage visible.
"""

import argparse
import random
import subprocess
import sys
import tempfile
from collections.abc import Callable
from pathlib import Path

PICTURES = 200
# Shorter data have no room for damaged stretches.
SMALLEST = 6000
MUST_BE_REFUSED = ("cut", "cut and closed", "2,000 zeros")


def replace_bytes(data: bytes, start: int, replacement: bytes) -> bytes:
    return data[:start] + replacement + data[start + len(replacement) :]


def damaged_copies(generator: random.Random, data: bytes) -> dict[str, bytes]:
    """Returns copies of a picture with each kind of damage to its coded pixels."""
    first = data.rfind(b"\xff\xda", 0, data.find(b"\xff\xda") + 2) + 20

    def place(room: int) -> int:
        return generator.randrange(first, max(first + 1, len(data) - 2 - room))

    bit = place(0)
    return {
        "cut": data[: generator.randrange(2, len(data) - 2)],
        "cut and closed": data[: place(40)] + b"\xff\xd9",
        "2,000 zeros": replace_bytes(data, start := place(2000), bytes(min(2000, len(data) - 2 - start))),
        "64 zeros": replace_bytes(data, place(64), bytes(64)),
        "64 random bytes": replace_bytes(data, place(64), generator.randbytes(64)),
        "64 bytes missing": data[: (start := place(64))] + data[start + 64 :],
        "64 bytes more": data[: (start := place(0))] + generator.randbytes(64) + data[start:],
        "one bit": replace_bytes(data, bit, bytes([data[bit] ^ 1 << generator.randrange(8)])),
    }


def reader(command: str, folder: Path) -> Callable[[bytes], bool]:
    """Returns whether the command reads a picture. An exit code that is neither success nor a refusal ends the program."""
    path = folder / "picture.jpg"
    call = [command, "explain", str(path), "--frame", "0", "--region", "0,0"]

    def reads(data: bytes) -> bool:
        path.write_bytes(data)
        result = subprocess.run(call, capture_output=True, text=True)
        if result.returncode not in (0, 2):
            sys.exit(f"exit code {result.returncode}: {result.stderr}")
        return result.returncode == 0

    return reads


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("folder", type=Path)
    parser.add_argument("--each", type=int, default=4, help="how often a picture is damaged in each way")
    parser.add_argument("--command", default="target/release/foveate")
    args = parser.parse_args()
    generator = random.Random(1)
    candidates = sorted(path for path in args.folder.rglob("*.jpg") if path.stat().st_size >= SMALLEST)
    pictures = generator.sample(candidates, min(PICTURES, len(candidates)))
    if not pictures:
        sys.exit(f"{args.folder} has no JPEG of {SMALLEST} bytes or more")
    counts: dict[str, list[int]] = {}
    with tempfile.TemporaryDirectory() as folder:
        reads = reader(args.command, Path(folder))
        for path in pictures:
            data = path.read_bytes()
            if not reads(data):
                sys.exit(f"{path} is whole, but is refused")
            for _ in range(args.each):
                for name, damaged in damaged_copies(generator, data).items():
                    count = counts.setdefault(name, [0, 0])
                    count[0] += 1
                    count[1] += not reads(damaged)
    print(f"{len(pictures)} pictures\n| damage | cases | refused |\n| --- | ---: | ---: |")
    for name, (cases, refused) in counts.items():
        print(f"| {name} | {cases} | {refused} |")
    missed = [name for name in MUST_BE_REFUSED if counts[name][0] != counts[name][1]]
    if missed:
        sys.exit(f"not all refused: {', '.join(missed)}")


if __name__ == "__main__":
    main()
