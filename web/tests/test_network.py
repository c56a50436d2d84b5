# SPDX-License-Identifier: MIT OR Apache-2.0
"""A network beside the camera of the live page. The expected results are those of `foveate infer`, with the command that the page shows."""

import csv
import json
import os
import shlex
import subprocess
from pathlib import Path

import numpy as np
import onnx
import pytest
from PIL import Image
from waiting import until

pytest_plugins = ["pages"]

FOVEATE = os.environ.get("FOVEATE", "foveate")
DATA = os.environ.get("FOVEATE_DATA")
# A size of another shape than the networks, so that letterbox and stretch differ.
SIZE = "176x112"
EXACT = "foveate.network.result?.id === foveate.network.shown.id"
RESULT = "foveate.network.result"


def drop_network(page, name, data):
    """Drops a network on the page."""
    path = Path(page.folder) / name
    path.parent.mkdir(exist_ok=True)
    path.write_bytes(data)
    page.set_input_files("#network-file", path)


def open_network(page, name, data):
    drop_network(page, name, data)
    until(page, "foveate.network.facts !== null", timeout=30)


def refused(page, text):
    until(page, "text => document.getElementById('network-refused').textContent.includes(text)", text, timeout=20)
    assert page.locator("#network-refused").is_visible()
    return page.inner_text("#network-refused")


def network_result(page):
    until(page, EXACT, timeout=30)
    return page.evaluate(RESULT)


def step_frames(page, count):
    """Restarts the source and steps. Returns the results of the network for each frame."""
    page.click("#reset")
    until(page, "foveate.sums.frames === 1")
    results = [network_result(page)]
    for number in range(1, count):
        page.evaluate("document.getElementById('step').click()")
        until(page, "number => foveate.sums.frames === number + 1", number)
        results.append(network_result(page))
    return results


def infer(page, count):
    """Runs the command that the page shows. Returns its rows of detections, and its summary."""
    folder = Path(page.folder)
    (folder / "camera.toml").write_text(page.evaluate("foveate.camera.facts.toml"))
    command = shlex.split(page.inner_text("#network-command"))
    assert command[:2] == ["foveate", "infer"]
    result = subprocess.run([FOVEATE, *command[1:], "--max-frames", str(count), "--force"], cwd=folder, capture_output=True, text=True, check=False)
    assert result.returncode == 0, result.stderr
    table = folder / "out" / "detections.csv"
    rows = list(csv.DictReader(table.read_text().splitlines())) if table.is_file() else []
    return rows, json.loads((folder / "out" / "inference.json").read_text())


def boxes_of(rows, frame, whole):
    frame_rows = [row for row in rows if int(row["frame"]) == frame and row["whole"] == whole]
    places = [[float(row[side]) for side in ("x0", "y0", "x1", "y1")] for row in frame_rows]
    boxes = [[int(row["class"]), float(row["score"]), *place] for row, place in zip(frame_rows, places, strict=True)]
    return boxes, [row["both"] for row in frame_rows]


def compare(results, rows, tolerance=0.0):
    """Checks that every frame but the first, which the command does not count, has the same boxes in the same order. Returns their number."""
    compared = 0
    for number, result in list(enumerate(results))[1:]:
        for key, whole in (("whole", "true"), ("seen", "false")):
            native_boxes, both = boxes_of(rows, number, whole)
            browser_boxes = [[box["class"], box["score"], *box["rect"]] for box in result[key]]
            assert len(browser_boxes) == len(native_boxes), f"frame {number}, {key}: {len(browser_boxes)} boxes, natively {len(native_boxes)}"
            for browser_box, native_box in zip(browser_boxes, native_boxes, strict=True):
                near = all(abs(a - b) <= tolerance * max(1, abs(b)) for a, b in zip(browser_box, native_box, strict=True))
                assert near, f"frame {number}, {key}: the browser says {browser_box}, the native program {native_box}"
            assert [str(box["both"]).lower() for box in result[key]] == both, f"frame {number}, {key}"
            compared += len(browser_boxes)
    return compared


@pytest.fixture
def street(still):
    return lambda more="": still(f"#source=scene:street&size={SIZE}&preset=paper{more}")


# --- What it computes


@pytest.mark.parametrize("more", ["", "&render.irrelevant=%22mean%22", "&network.framing=stretch"])
def test_boxes_are_those_of_infer(street, more):
    page = street(more)
    open_network(page, "squares.onnx", onnx.squares())
    if "network" in more:
        assert "--framing stretch" in page.inner_text("#network-command")
    found = step_frames(page, 8)
    rows, summary = infer(page, 8)
    assert compare(found, rows) > 100
    # Counts are sums, of all frames and, without the first, of the command's.
    sums = page.evaluate("foveate.network.sums")
    kept = summary["sight"]["detections"]["all"]
    for key in ("whole", "kept", "seen", "added"):
        assert sums[key] == sum(one["found"][key] for one in found)
        assert sums[key] - found[0]["found"][key] == kept[key]
    assert sums["frames"] == 8
    assert {own["class"] for one in found for own in one["whole"]} == {0, 1}
    if not more:
        assert 0 < kept["kept"] < kept["whole"] and kept["added"] > 0


@pytest.mark.parametrize("bits", [5, 12])
def test_boxes_are_those_of_infer_at_every_depth(still, bits):
    page = still(f"#preset=fovea&frame.pixel_bits={bits}")
    folder = Path(page.folder)
    folder.mkdir(exist_ok=True)
    for number in range(4):
        moved = [[min(255, (x * 4 + y * 3 + 40 * number) % 330) for x in range(80)] for y in range(60)]
        Image.fromarray(np.array(moved, dtype=np.uint8)).save(folder / f"{number}.png")
    page.set_input_files("#files", [folder / f"{number}.png" for number in range(4)])
    until(page, "document.getElementById('source').value === 'files' && foveate.sums.frames >= 1")
    open_network(page, "squares.onnx", onnx.squares())
    found = step_frames(page, 4)
    rows, _ = infer(page, 4)
    assert compare(found, rows) > 50


@pytest.mark.skipif(not DATA, reason="FOVEATE_DATA is not set")
@pytest.mark.parametrize(
    ("name", "clip", "cut", "least"),
    [
        ("yunet_n_320_320.onnx", "mot17/MOT17-02/%06d.jpg", "crop=480:480:240:240", 20),
        ("yolox_nano.onnx", "video_static/traffic_camera_720p.mp4", "scale=640:-2", 20),
    ],
    ids=["yunet", "yolox"],
)
def test_trained_detectors_are_those_of_infer(still, name, clip, cut, least):
    frames, page = 3, still("#preset=fovea")
    folder = Path(page.folder)
    folder.mkdir(exist_ok=True)
    source = ["-i", str(Path(DATA) / clip), "-frames:v", str(frames), "-vf", f"{cut},format=gray"]
    subprocess.run(["ffmpeg", "-v", "error", *source, str(folder / "%d.png")], check=True)
    page.set_input_files("#files", [folder / f"{number + 1}.png" for number in range(frames)])
    until(page, "document.getElementById('source').value === 'files' && foveate.sums.frames >= 1")
    open_network(page, name, (Path(DATA) / "networks" / name).read_bytes())
    assert page.locator("#network-refused").is_hidden()
    assert page.evaluate("foveate.network.facts.scale") == "1/255"
    found = step_frames(page, frames)
    rows, _ = infer(page, frames)
    # Processors with AVX2 round once where WebAssembly rounds twice.
    assert compare(found, rows, 1e-3) >= least


def test_a_network_that_is_no_detector_is_compared_by_its_class(street):
    page = street()
    open_network(page, "classes.onnx", onnx.classes())
    assert page.evaluate("foveate.network.facts.head") is None
    found = step_frames(page, 6)
    _, summary = infer(page, 6)
    theirs = summary["sight"]["classes"]
    for key in ("same_share", "whole_margin", "seen_margin"):
        ours = sum(one["classes"][key] for one in found[1:]) / 5
        assert ours == pytest.approx(theirs[key], rel=1e-5)
    now = page.inner_text("#network-now")
    assert f"class {found[-1]['class'][0]}" in now and "to the receiver class" in now
    assert page.locator(".box").count() == 0


# --- What is shown


def test_boxes_are_of_the_frame_shown_or_marked_as_older(street):
    page = street()
    open_network(page, "squares.onnx", onnx.squares())
    result = step_frames(page, 3)[-1]
    for place, key, kind in (("#input", "whole", "lost"), ("#receiver", "seen", "added")):
        assert page.locator(f"{place} .boxes:not(.older) .box").count() == len(result[key])
        assert page.locator(f"{place} .box.{kind}").count() == sum(not box["both"] for box in result[key]) > 0
    assert "the frame shown" in page.inner_text("#network-now")
    # A box lies where it was found.
    first = max(result["whole"], key=lambda box: box["both"] is False)
    box_on_page = page.locator("#input .box.lost").first.bounding_box()
    picture = page.locator("#input canvas").bounding_box()
    share = picture["width"] / 176
    left, width = box_on_page["x"] - picture["x"], box_on_page["width"]
    assert any(abs(left - box["rect"][0] * share) < 2 and abs(width - (box["rect"][2] - box["rect"][0]) * share) < 4
               for box in result["whole"] if not box["both"]), first
    # While the network runs on the next frame, the boxes of the last one are marked.
    page.evaluate(
        """() => {
            window.marked = null;
            const frameShown = foveate.network.frameShown.bind(foveate.network);
            foveate.network.frameShown = number => {
                frameShown(number);
                window.marked = [...document.querySelectorAll(".boxes")].every(own => own.classList.contains("older"));
            };
        }"""
    )
    page.evaluate("document.getElementById('step').click()")
    until(page, "window.marked !== null")
    assert page.evaluate("window.marked")
    network_result(page)
    assert page.locator(".boxes.older").count() == 0


def test_counts_are_shown_and_begin_anew(street):
    page = street()
    open_network(page, "squares.onnx", onnx.squares())
    step_frames(page, 4)
    sums = page.evaluate("foveate.network.sums")
    shown = dict(zip(page.locator("#network-figures dt").all_inner_texts(), page.locator("#network-figures dd").all_inner_texts(), strict=True))
    assert shown["found in whole frames"] == str(sums["whole"])
    assert shown["of these kept"].startswith(f"{sums['kept']} (")
    assert shown["added"] == str(sums["added"])
    assert float(shown["ms per picture"]) > 0
    page.locator("[data-key='region.size'] input[type=number]").fill("16")
    page.keyboard.press("Tab")
    network_result(page)
    assert page.evaluate("foveate.network.sums.frames") < 4
    # Another size is another network.
    page.select_option("#size", "320x240")
    until(page, "foveate.network.result?.whole.some(own => own.rect[2] > 176)")
    page.click("#close-network")
    assert page.locator(".box").count() == 0 and page.locator("#network-open").is_hidden()


def test_score_and_overlap_decide_what_counts(street):
    page = street()
    open_network(page, "squares.onnx", onnx.squares())
    before = len(network_result(page)["whole"])
    page.fill("#score", "0.7")
    page.keyboard.press("Tab")
    until(page, "foveate.network.facts?.score > 0.69")
    after = network_result(page)["whole"]
    assert 0 < len(after) < before
    assert all(own["score"] >= 0.7 for own in after)
    assert "--detect yolov5,score=0.7,overlap=0.45" in page.inner_text("#network-command")
    page.select_option("#detect", "none")
    until(page, "foveate.network.facts?.head === null")
    assert page.locator(".box").count() == 0
    until(page, "document.getElementById('network-now').textContent.includes('outputs agree')")


def test_a_slow_network_does_not_slow_the_picture(opened):
    page = opened(f"#source=scene:street&size={SIZE}&preset=paper")

    def rate():
        before = page.evaluate("foveate.sums.frames")
        page.wait_for_timeout(3000)
        return (page.evaluate("foveate.sums.frames") - before) / 3

    until(page, "foveate.sums.frames > 10")
    rate_alone = rate()
    open_network(page, "slow.onnx", onnx.filters(64, 6, (1, 1, 240, 320)))
    until(page, "foveate.network.result !== null", timeout=60)
    rate_with_network = rate()
    ms = float(page.locator("#network-figures dd").last.inner_text())
    assert ms > 200, "the network of this test is not slow"
    assert rate_with_network > 0.5 * rate_alone, f"{rate_with_network:.1f} frames/s beside the network, {rate_alone:.1f} alone"


# --- What is refused


@pytest.mark.parametrize(
    ("name", "data", "message"),
    [
        ("notes.onnx", b"no network at all", "notes.onnx is not an ONNX model"),
        ("empty.onnx", b"", "it has no graph"),
        ("big.onnx", lambda: onnx.filters(128, 2, (1, 1, 1024, 1024)), "MB of tensors"),
        ("many.onnx", lambda: onnx.filters(1, 1, (1, 4, 48, 64)), "with 1 or 3 channels, but it has 4"),
        ("any.onnx", lambda: onnx.filters(1, 1, (1, 1, "height", "width")), "give one, for example letterbox=416x416"),
        ("odd.onnx", lambda: odd_model(), "has the operator Odd, which is not supported"),
    ],
    ids=["no network", "empty", "memory", "channels", "size", "operator"],
)
def test_what_cannot_be_shown_is_told(street, name, data, message):
    page = street()
    drop_network(page, name, data() if callable(data) else data)
    refused(page, message)
    assert page.evaluate(RESULT) is None
    # The page goes on, and the next network, too.
    page.evaluate("document.getElementById('step').click()")
    open_network(page, "squares.onnx", onnx.squares())
    assert page.locator("#network-refused").is_hidden()
    assert network_result(page)["whole"]


def odd_model():
    model = onnx.Model((1, 1, 48, 64))
    return model.bytes(model.node("Odd", ["picture"]))


def test_a_format_that_does_not_fit_is_told_and_another_can_be_chosen(street):
    page = street("&network.detect=yunet")
    drop_network(page, "squares.onnx", onnx.squares())
    assert "detections of yunet need outputs cls_8" in refused(page, "yunet")
    page.select_option("#detect", "likely")
    until(page, "foveate.network.facts !== null")
    assert page.locator("#network-refused").is_hidden() and network_result(page)["whole"]


def test_a_size_is_given_to_a_network_that_takes_any(street):
    page = street()
    drop_network(page, "any.onnx", onnx.filters(1, 1, (1, 1, "height", "width")))
    refused(page, "letterbox=416x416")
    page.fill("#framing-size", "48x32")
    page.keyboard.press("Tab")
    until(page, "foveate.network.facts !== null")
    assert page.evaluate("foveate.network.facts.input") == {"width": 48, "height": 32, "channels": 1}
    assert "--framing letterbox=48x32" in page.inner_text("#network-command")
    page.fill("#scale", "0")
    page.keyboard.press("Tab")
    assert "expected a number above 0" in refused(page, "scale")


FAULT = "(() => { throw Object.assign(new Error('so'), { fault: true }); })("


@pytest.mark.parametrize(
    ("before", "after", "message"),
    [
        ("engine.takeNetwork(", "engine.notThere(", "notThere"),
        ("engine.look(", FAULT, "most likely it takes more memory than a page has"),
        ("let engine;", "throw new Error('so');", "thread does not start"),
    ],
    ids=["error", "fault", "start"],
)
def test_a_thread_that_fails_is_told(street, before, after, message):
    page = street()
    page.evaluate(
        """([before, after]) => {
            const own = document.getElementById("network-worker");
            own.textContent = own.textContent.replace(before, after);
        }""",
        [before, after],
    )
    drop_network(page, "squares.onnx", onnx.squares())
    refused(page, message)
    page.evaluate("document.getElementById('step').click()")
    until(page, "foveate.sums.frames === 2")


# --- For everybody


def test_a_network_goes_by_keyboard_and_its_settings_by_link(street):
    page = street()
    open_network(page, "squares.onnx", onnx.squares())
    page.focus("#open-network")
    reached = []
    for _ in range(12):
        page.keyboard.press("Tab")
        reached.append(page.evaluate("[document.activeElement.id, getComputedStyle(document.activeElement).outlineStyle !== 'none']"))
    expected = {"close-network", "detect", "score", "overlap", "framing", "framing-size", "range", "mean", "scale", "network-command"}
    assert expected <= {name for name, visible in reached if visible}, reached
    page.focus("#framing")
    page.keyboard.press("ArrowDown")
    until(page, "foveate.network.facts?.framing === 'stretch'")
    page.focus("#range")
    page.keyboard.press("ArrowDown")
    until(page, "foveate.network.facts?.scale === '1/255'")
    until(page, "location.hash.includes('network.framing=stretch') && location.hash.includes('network.scale=1%2F255')")
    assert "squares" not in page.evaluate("location.hash")
    other = street("&network.framing=stretch&network.scale=1%2F255")
    open_network(other, "squares.onnx", onnx.squares())
    assert other.evaluate("[foveate.network.facts.framing, foveate.network.facts.scale]") == ["stretch", "1/255"]
    # The settings of the address were for the first network.
    open_network(other, "again.onnx", onnx.squares())
    until(other, "foveate.network.facts?.framing === 'letterbox'")


@pytest.mark.parametrize("scheme", ["light", "dark"])
def test_a_network_fits_a_narrow_page(still, scheme):
    page = still(f"#size={SIZE}", viewport={"width": 360, "height": 740}, color_scheme=scheme)
    open_network(page, "squares.onnx", onnx.squares())
    network_result(page)
    assert page.evaluate("document.documentElement.scrollWidth") <= 360
