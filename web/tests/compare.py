# SPDX-License-Identifier: MIT OR Apache-2.0
"""Compares the results of the same frames in the browser and in the native program, and names the first difference."""

import base64
import csv


def assert_same_results(browser_results, run, case):
    """Fails with the frame and the region of the first difference."""
    events = list(csv.DictReader(browser_results["events"].splitlines()))
    assert len(browser_results["outcomes"]) == len(run.frames), f"{case}: {len(browser_results['outcomes'])} frames, natively {len(run.frames)}"
    columns = browser_results["facts"]["columns"]
    for number, (outcome, frame) in enumerate(zip(browser_results["outcomes"], run.frames, strict=True)):
        region_rows = events[number * len(frame.rows) : (number + 1) * len(frame.rows)]
        for region, (row, expected) in enumerate(zip(region_rows, frame.rows, strict=True)):
            assert row == expected, (
                f"{case}: frame {number}, region {region % columns},{region // columns}: the browser says {row}, the native program {expected}"
            )
        screen = base64.b64decode(outcome["screen"])
        assert len(screen) == len(frame.shown), f"{case}: frame {number}: {len(screen)} pixels, natively {len(frame.shown)}"
        if screen != frame.shown:
            position = next(position for position, pair in enumerate(zip(screen, frame.shown, strict=True)) if pair[0] != pair[1])
            x, y, side = position % run.width, position // run.width, browser_results["facts"]["side"]
            raise AssertionError(
                f"{case}: frame {number}, region {x // side},{y // side}, pixel {x},{y}:"
                f" {screen[position]} is rendered, natively {frame.shown[position]}"
            )
        assert base64.b64decode(outcome["regions"]) == frame.regions, f"{case}: frame {number}: packed decisions differ"
        assert outcome["hash"] == frame.hash(), f"{case}: frame {number}: the hash differs, and nothing else"
    assert browser_results["events"] == run.events, f"{case}: the text of events.csv differs"
    bits = sum(outcome["sent"]["bits"] for outcome in browser_results["outcomes"])
    sent = run.summary["bandwidth"]["region"]["bytes"]
    assert (bits + 7) // 8 == sent, f"{case}: {bits} bits are sent, natively {sent} bytes"
