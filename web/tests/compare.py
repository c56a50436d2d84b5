# SPDX-License-Identifier: MIT OR Apache-2.0
"""Compares what came of the same frames in the browser and in the native program, and names the first difference."""

import base64
import csv


def same(told, run, what):
    """Fails with the frame and the region of the first difference."""
    events = list(csv.DictReader(told["events"].splitlines()))
    assert len(told["outcomes"]) == len(run.frames), f"{what}: {len(told['outcomes'])} frames, natively {len(run.frames)}"
    columns = told["facts"]["columns"]
    for number, (outcome, frame) in enumerate(zip(told["outcomes"], run.frames, strict=True)):
        own = events[number * len(frame.rows) : (number + 1) * len(frame.rows)]
        for region, (row, expected) in enumerate(zip(own, frame.rows, strict=True)):
            assert row == expected, (
                f"{what}: frame {number}, region {region % columns},{region // columns}: the browser says {row}, the native program {expected}"
            )
        shown = base64.b64decode(outcome["screen"])
        assert len(shown) == len(frame.shown), f"{what}: frame {number}: {len(shown)} pixels, natively {len(frame.shown)}"
        if shown != frame.shown:
            at = next(at for at, pair in enumerate(zip(shown, frame.shown, strict=True)) if pair[0] != pair[1])
            x, y, side = at % run.width, at // run.width, told["facts"]["side"]
            raise AssertionError(
                f"{what}: frame {number}, region {x // side},{y // side}, pixel {x},{y}: {shown[at]} is rendered, natively {frame.shown[at]}"
            )
        assert base64.b64decode(outcome["regions"]) == frame.regions, f"{what}: frame {number}: packed decisions differ"
        assert outcome["hash"] == frame.hash(), f"{what}: frame {number}: the hash differs, and nothing else"
    assert told["events"] == run.events, f"{what}: the text of events.csv differs"
    bits = sum(outcome["sent"]["bits"] for outcome in told["outcomes"])
    sent = run.summary["bandwidth"]["region"]["bytes"]
    assert (bits + 7) // 8 == sent, f"{what}: {bits} bits are sent, natively {sent} bytes"
