# SPDX-License-Identifier: MIT OR Apache-2.0
"""A network beside the camera of the live page. The witness is `foveate infer` with the command that the page shows."""

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


def give(page, name, data):
    """Drops a network on the page."""
    path = Path(page.folder) / name
    path.parent.mkdir(exist_ok=True)
    path.write_bytes(data)
    page.set_input_files("#network-file", path)


def opened_network(page, name, data):
    give(page, name, data)
    until(page, "foveate.network.facts !== null", timeout=30)


def refused(page, text):
    until(page, "text => document.getElementById('network-refused').textContent.includes(text)", text, timeout=20)
    assert page.locator("#network-refused").is_visible()
    return page.inner_text("#network-refused")


def looked(page):
    until(page, EXACT, timeout=30)
    return page.evaluate(RESULT)


def walk(page, count):
    """Begins anew and steps; what the network says of each frame."""
    page.click("#reset")
    until(page, "foveate.sums.frames === 1")
    found = [looked(page)]
    for number in range(1, count):
        page.evaluate("document.getElementById('step').click()")
        until(page, "number => foveate.sums.frames === number + 1", number)
        found.append(looked(page))
    return found


def infer(page, count):
    """What the command says that the page shows: rows of detections, and the summary."""
    folder = Path(page.folder)
    (folder / "camera.toml").write_text(page.evaluate("foveate.camera.facts.toml"))
    command = shlex.split(page.inner_text("#network-command"))
    assert command[:2] == ["foveate", "infer"]
    done = subprocess.run([FOVEATE, *command[1:], "--max-frames", str(count), "--force"], cwd=folder, capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stderr
    table = folder / "out" / "detections.csv"
    rows = list(csv.DictReader(table.read_text().splitlines())) if table.is_file() else []
    return rows, json.loads((folder / "out" / "inference.json").read_text())


def boxes_of(rows, frame, whole):
    own = [row for row in rows if int(row["frame"]) == frame and row["whole"] == whole]
    places = [[float(row[side]) for side in ("x0", "y0", "x1", "y1")] for row in own]
    return [[int(row["class"]), float(row["score"]), *place] for row, place in zip(own, places, strict=True)], [row["both"] for row in own]


def compare(found, rows, tolerance=0.0):
    """The same boxes in the same order in every frame but the first, which the command does not count."""
    compared = 0
    for number, one in list(enumerate(found))[1:]:
        for key, whole in (("whole", "true"), ("seen", "false")):
            theirs, both = boxes_of(rows, number, whole)
            ours = [[own["class"], own["score"], *own["rect"]] for own in one[key]]
            assert len(ours) == len(theirs), f"frame {number}, {key}: {len(ours)} boxes, natively {len(theirs)}"
            for mine, other in zip(ours, theirs, strict=True):
                near = all(abs(a - b) <= tolerance * max(1, abs(b)) for a, b in zip(mine, other, strict=True))
                assert near, f"frame {number}, {key}: the browser says {mine}, the native program {other}"
            assert [str(own["both"]).lower() for own in one[key]] == both, f"frame {number}, {key}"
            compared += len(ours)
    return compared


@pytest.fixture
def street(still):
    return lambda more="": still(f"#source=scene:street&size={SIZE}&preset=paper{more}")


# --- What it computes


@pytest.mark.parametrize("more", ["", "&render.irrelevant=%22mean%22", "&network.framing=stretch"])
def test_boxes_are_those_of_infer(street, more):
    page = street(more)
    opened_network(page, "squares.onnx", onnx.squares())
    if "network" in more:
        assert "--framing stretch" in page.inner_text("#network-command")
    found = walk(page, 8)
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
    opened_network(page, "squares.onnx", onnx.squares())
    found = walk(page, 4)
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
    opened_network(page, name, (Path(DATA) / "networks" / name).read_bytes())
    assert page.locator("#network-refused").is_hidden()
    assert page.evaluate("foveate.network.facts.scale") == "1/255"
    found = walk(page, frames)
    rows, _ = infer(page, frames)
    # Processors with AVX2 round once where WebAssembly rounds twice.
    assert compare(found, rows, 1e-3) >= least


def test_a_network_that_is_no_detector_is_compared_by_its_class(street):
    page = street()
    opened_network(page, "classes.onnx", onnx.classes())
    assert page.evaluate("foveate.network.facts.head") is None
    found = walk(page, 6)
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
    opened_network(page, "squares.onnx", onnx.squares())
    found = walk(page, 3)[-1]
    for place, key, odd in (("#input", "whole", "lost"), ("#receiver", "seen", "added")):
        assert page.locator(f"{place} .boxes:not(.older) .box").count() == len(found[key])
        assert page.locator(f"{place} .box.{odd}").count() == sum(not own["both"] for own in found[key]) > 0
    assert "the frame shown" in page.inner_text("#network-now")
    # A box lies where it was found.
    first = max(found["whole"], key=lambda own: own["both"] is False)
    shown = page.locator("#input .box.lost").first.bounding_box()
    picture = page.locator("#input canvas").bounding_box()
    share = picture["width"] / 176
    assert any(abs(shown["x"] - picture["x"] - own["rect"][0] * share) < 2 and abs(shown["width"] - (own["rect"][2] - own["rect"][0]) * share) < 4
               for own in found["whole"] if not own["both"]), first
    # While the next frame is looked at, the boxes of the last one are marked.
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
    looked(page)
    assert page.locator(".boxes.older").count() == 0


def test_counts_are_shown_and_begin_anew(street):
    page = street()
    opened_network(page, "squares.onnx", onnx.squares())
    walk(page, 4)
    sums = page.evaluate("foveate.network.sums")
    shown = dict(zip(page.locator("#network-figures dt").all_inner_texts(), page.locator("#network-figures dd").all_inner_texts(), strict=True))
    assert shown["found in whole frames"] == str(sums["whole"])
    assert shown["of these kept"].startswith(f"{sums['kept']} (")
    assert shown["added"] == str(sums["added"])
    assert float(shown["ms a picture"]) > 0
    page.locator("[data-key='region.size'] input[type=number]").fill("16")
    page.keyboard.press("Tab")
    looked(page)
    assert page.evaluate("foveate.network.sums.frames") < 4
    # Another size is another network.
    page.select_option("#size", "320x240")
    until(page, "foveate.network.result?.whole.some(own => own.rect[2] > 176)")
    page.click("#close-network")
    assert page.locator(".box").count() == 0 and page.locator("#network-open").is_hidden()


def test_score_and_overlap_decide_what_counts(street):
    page = street()
    opened_network(page, "squares.onnx", onnx.squares())
    before = len(looked(page)["whole"])
    page.fill("#score", "0.7")
    page.keyboard.press("Tab")
    until(page, "foveate.network.facts?.score > 0.69")
    after = looked(page)["whole"]
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
    alone = rate()
    opened_network(page, "slow.onnx", onnx.filters(64, 6, (1, 1, 240, 320)))
    until(page, "foveate.network.result !== null", timeout=60)
    beside = rate()
    ms = float(page.locator("#network-figures dd").last.inner_text())
    assert ms > 200, "the network of this test is not slow"
    assert beside > 0.5 * alone, f"{beside:.1f} frames/s beside the network, {alone:.1f} alone"


# --- What is refused


@pytest.mark.parametrize(
    ("name", "data", "message"),
    [
        ("notes.onnx", b"no network at all", "notes.onnx is not an ONNX model"),
        ("empty.onnx", b"", "it has no graph"),
        ("big.onnx", lambda: onnx.filters(128, 2, (1, 1, 1024, 1024)), "MB of tensors"),
        ("many.onnx", lambda: onnx.filters(1, 1, (1, 4, 48, 64)), "with 1 or 3 channels, but it has 4"),
        ("any.onnx", lambda: onnx.filters(1, 1, (1, 1, "height", "width")), "say which, for example letterbox=416x416"),
        ("odd.onnx", lambda: odd(), "has the operator Odd, which is not supported"),
    ],
    ids=["no network", "empty", "memory", "channels", "size", "operator"],
)
def test_what_cannot_be_shown_is_told(street, name, data, message):
    page = street()
    give(page, name, data() if callable(data) else data)
    refused(page, message)
    assert page.evaluate(RESULT) is None
    # The page goes on, and the next network, too.
    page.evaluate("document.getElementById('step').click()")
    opened_network(page, "squares.onnx", onnx.squares())
    assert page.locator("#network-refused").is_hidden()
    assert looked(page)["whole"]


def odd():
    model = onnx.Model((1, 1, 48, 64))
    return model.bytes(model.node("Odd", ["picture"]))


def test_a_format_that_does_not_fit_is_told_and_another_can_be_chosen(street):
    page = street("&network.detect=yunet")
    give(page, "squares.onnx", onnx.squares())
    assert "detections of yunet need outputs cls_8" in refused(page, "yunet")
    page.select_option("#detect", "likely")
    until(page, "foveate.network.facts !== null")
    assert page.locator("#network-refused").is_hidden() and looked(page)["whole"]


def test_a_size_is_given_to_a_network_that_takes_any(street):
    page = street()
    give(page, "any.onnx", onnx.filters(1, 1, (1, 1, "height", "width")))
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
    give(page, "squares.onnx", onnx.squares())
    refused(page, message)
    page.evaluate("document.getElementById('step').click()")
    until(page, "foveate.sums.frames === 2")


# --- For everybody


def test_a_network_goes_by_keyboard_and_its_settings_by_link(street):
    page = street()
    opened_network(page, "squares.onnx", onnx.squares())
    page.focus("#open-network")
    reached = []
    for _ in range(12):
        page.keyboard.press("Tab")
        reached.append(page.evaluate("[document.activeElement.id, getComputedStyle(document.activeElement).outlineStyle !== 'none']"))
    wanted = {"close-network", "detect", "score", "overlap", "framing", "framing-size", "range", "mean", "scale", "network-command"}
    assert wanted <= {name for name, visible in reached if visible}, reached
    page.focus("#framing")
    page.keyboard.press("ArrowDown")
    until(page, "foveate.network.facts?.framing === 'stretch'")
    page.focus("#range")
    page.keyboard.press("ArrowDown")
    until(page, "foveate.network.facts?.scale === '1/255'")
    until(page, "location.hash.includes('network.framing=stretch') && location.hash.includes('network.scale=1%2F255')")
    assert "squares" not in page.evaluate("location.hash")
    other = street("&network.framing=stretch&network.scale=1%2F255")
    opened_network(other, "squares.onnx", onnx.squares())
    assert other.evaluate("[foveate.network.facts.framing, foveate.network.facts.scale]") == ["stretch", "1/255"]
    # The settings of the address were for the first network.
    opened_network(other, "again.onnx", onnx.squares())
    until(other, "foveate.network.facts?.framing === 'letterbox'")


@pytest.mark.parametrize("scheme", ["light", "dark"])
def test_a_network_fits_a_narrow_page(still, scheme):
    page = still(f"#size={SIZE}", viewport={"width": 360, "height": 740}, color_scheme=scheme)
    opened_network(page, "squares.onnx", onnx.squares())
    looked(page)
    assert page.evaluate("document.documentElement.scrollWidth") <= 360
