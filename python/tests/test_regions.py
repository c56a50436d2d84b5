# SPDX-License-Identifier: MIT OR Apache-2.0
"""An outcome draws, explains and groups its regions as the command line does."""
import subprocess
import sys
import types

import numpy as np
import pytest
from PIL import Image

import foveate as fv
from conftest import ROOT

AREAS = {"areas": [{"class": "off", "rectangle": [0, 0, 64, 64]}, {"class": "always", "rectangle": [64, 64, 96, 96]}]}
DESIGNS = {
    "paper": ("paper", {}, []),
    "large": ("paper", {"region": {"size": 24}}, ["--set", "region.size=24"]),
    "flow": ("serial", {"spatial": ["edge", {"feature": "flow", "radius": 2}]}, ["--set", "spatial=[{feature='edge'},{feature='flow',radius=2}]"]),
    "summaries": ("fovea", {}, []),
    "zones": (
        "paper",
        {"zones": AREAS},
        ["--set", "zones.areas=[{class='off',rectangle=[0,0,64,64]},{class='always',rectangle=[64,64,96,96]}]"],
    ),
    "deep": ("mad", {"frame": {"pixel_bits": 12}}, ["--set", "frame.pixel_bits=12"]),
}


@pytest.mark.parametrize("name", DESIGNS)
def test_an_overlay_is_the_upper_part_of_that_of_simulate(name, command, tmp_path):
    preset, keys, words = DESIGNS[name]
    command("simulate", "scene:street", "-p", preset, *words, "-o", tmp_path / "out", "--frames", 3, "--overlay=png", "--quiet")
    camera = fv.Camera(preset, **keys)
    for number, outcome in enumerate(fv.simulate("scene:street", camera, max_frames=3)):
        written = np.asarray(Image.open(tmp_path / f"out/overlay/{number:06}.png"))
        overlay = outcome.overlay()
        height, width, _ = overlay.shape
        # The legend and the chart are below.
        assert overlay.dtype == np.uint8 and np.array_equal(overlay, written[:height, :width]) and height < len(written)
        assert (height % outcome.design.height, width % outcome.design.width) == (0, 0)
        assert np.array_equal(camera.step(outcome.frame).overlay(outcome.frame), overlay)


def test_an_overlay_shows_what_is_sent_or_outlines_the_decisions():
    *_, outcome = fv.simulate("scene:street", "paper", max_frames=2)
    scale = len(outcome.overlay()) // len(outcome.frame)
    sent = np.repeat(np.repeat(outcome.active, 8 * scale, 0), 8 * scale, 1)
    frame = np.repeat(np.repeat(outcome.frame, scale, 0), scale, 1)
    overlay = outcome.overlay()
    assert np.array_equal(overlay[sent], np.stack([frame[sent]] * 3, axis=-1)) and (overlay[~sent].T <= frame[~sent] // 3 + 1).all()
    assert not np.array_equal(outcome.overlay(outlines=True), overlay)


def test_an_overlay_needs_a_frame_of_its_size(frames):
    outcome = fv.Camera().step(frames[0])
    with pytest.raises(TypeError, match=r"Camera.step does not keep the frame that it takes; give that frame, outcome.overlay\(frame\)"):
        outcome.overlay()
    with pytest.raises(ValueError, match="the frame has 30x20 pixels, but this outcome is that of a frame of 83x60"):
        outcome.overlay(np.zeros((20, 30), np.uint8))
    with pytest.raises(TypeError, match="not float64"):
        outcome.overlay(frames[0] / 2)
    # Any frame of that size may be drawn over.
    assert not np.array_equal(outcome.overlay(outcome.rendered), outcome.overlay(frames[1]))


def test_marks_of_classes_are_those_of_the_configuration(frames):
    zones = {"areas": [{"class": "off", "rectangle": [0, 0, 40, 40]}]}
    camera, other = fv.Camera(zones=zones), fv.Camera(zones=zones)
    marked = camera.step(frames[0]).overlay(frames[0])
    other.step(frames[0])
    other.zones = other.zones
    camera.reset()
    other.reset()
    assert np.array_equal(camera.step(frames[0]).overlay(frames[0]), marked)
    # The same regions are active, but the marks of an assigned map are not drawn.
    assert not np.array_equal(other.step(frames[0]).overlay(frames[0]), marked)


PIXELS = {"raw", "denoised", "summary"}


def known(explanation):
    """Returns the part of an explanation that scores tell."""
    spatial = ("feature", "level", "score", "min_score", "unit", "vote")
    displacement = ("dx", "dy")
    return {
        **{key: value for key, value in explanation.items() if key not in PIXELS},
        "spatial": [
            {key: one[key] for key in spatial if key in one}
            | ({"displacement": {key: one["displacement"][key] for key in displacement}} if "displacement" in one else {})
            for one in explanation["spatial"]
        ],
        "temporal": {key: explanation["temporal"][key] for key in ("against", "level", "count", "min_count")},
    }


@pytest.mark.parametrize("name", DESIGNS)
def test_an_explanation_has_what_scores_tell(name):
    preset, keys, _ = DESIGNS[name]
    camera = fv.Camera(preset, **keys)
    outcomes = list(fv.simulate("scene:street", camera, max_frames=3))
    columns, rows = outcomes[0].design.columns, outcomes[0].design.rows
    for outcome in outcomes:
        for region in [(0, 0), (columns - 1, rows - 1), (columns // 2, rows // 2), (columns // 3, rows // 3)]:
            whole = fv.explain("scene:street", camera, frame=outcome.number, region=region, max_frames=3)
            own = outcome.explain(region)
            assert own == known(whole), region
            assert isinstance(own, fv.Explanation)
            # Lines of the decision are equal, except for what follows from pixels.
            for line in (line for line in str(own).splitlines() if "SRS" in line or "TRS" in line or "votes" in line):
                assert any(other.startswith(line) for other in str(whole).splitlines()), line


def test_an_explanation_follows_the_map_of_the_frame(frames):
    camera = fv.Camera(zones={})
    camera.step(frames[0])
    camera.zones = np.full((8, 11), 1)
    off = camera.step(frames[1])
    camera.zones = np.full((8, 11), 3)
    always = camera.step(frames[2])
    assert off.explain((1, 1))["class"] == "off" and always.explain(region=(1, 1))["class"] == "always"
    assert "SRS 0 (by the class, not by the votes)" in str(off.explain((1, 1)))
    assert off.explain((1, 1))["name"] is None and str(off.explain((1, 1))).startswith("frame 1 at 33333 us\n")
    for region in [(11, 0), (0, 8)]:
        with pytest.raises(IndexError, match="columns are 0 to 10, rows 0 to 7"):
            off.explain(region)


def boxes_by_hand(active, size, height, width):
    """Groups active regions step by step, as the rule says."""
    rest, boxes = {tuple(place) for place in np.argwhere(active)}, []
    for first in sorted(rest):
        if first not in rest:
            continue
        group, waiting = set(), [first]
        while waiting:
            row, column = waiting.pop()
            if (row, column) in rest:
                rest.remove((row, column))
                group.add((row, column))
                waiting += [(row + down, column + right) for down in (-1, 0, 1) for right in (-1, 0, 1)]
        rows, columns = zip(*group, strict=True)
        right, lower = min((max(columns) + 1) * size, width), min((max(rows) + 1) * size, height)
        boxes.append([min(columns) * size, min(rows) * size, right, lower])
    return boxes


@pytest.mark.parametrize("size", [4, 8, 13])
def test_boxes_surround_groups_of_active_regions(size):
    chance, counts = np.random.default_rng(size), []
    camera = fv.Camera("bare", region={"size": size})
    for _ in range(12):
        frame = np.zeros((60, 83), np.uint8)
        for row, column in zip(chance.integers(0, 56, 9), chance.integers(0, 79, 9), strict=True):
            frame[row : row + 4, column : column + 4] = chance.integers(0, 256, (4, 4))
        outcome = camera.step(frame)
        boxes = outcome.boxes()
        assert boxes.dtype == np.float32 and boxes.shape == (len(boxes), 4)
        assert boxes.tolist() == boxes_by_hand(outcome.active, size, 60, 83)
        counts.append(len(boxes))
    assert max(counts) > 1
    # The next frame is the same, so no region is active.
    assert camera.step(frame).boxes().shape == (0, 4)


def test_detections_are_those_of_supervision(frames, monkeypatch):
    outcome = fv.Camera("paper", region={"size": 4}).step(frames[0])
    supervision = types.ModuleType("supervision")
    supervision.__spec__ = types.SimpleNamespace(name="supervision")
    supervision.Detections = lambda **values: values
    monkeypatch.setitem(sys.modules, "supervision", supervision)
    detections = outcome.detections()
    assert detections.keys() == {"xyxy"} and np.array_equal(detections["xyxy"], outcome.boxes())


def test_detections_say_what_they_need():
    code = (
        "import importlib.util as util, numpy as np\n"
        "found = util.find_spec\n"
        "util.find_spec = lambda name, *rest: None if name == 'supervision' else found(name, *rest)\n"
        "import foveate as fv\n"
        "fv.Camera().step(np.zeros((8, 8), np.uint8)).detections()\n"
    )
    result = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, cwd=ROOT / "docs")
    needed = "outcome.detections() needs supervision, which is not installed: pip install supervision; outcome.boxes() needs no package"
    assert result.stderr.splitlines()[-1] == f"ImportError: {needed}"
