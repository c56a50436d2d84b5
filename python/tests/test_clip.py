# SPDX-License-Identifier: MIT OR Apache-2.0
"""A camera takes a whole clip as it takes its frames one by one, and functions that read footage take arrays."""
import json
import os
import pty
import subprocess
import sys

import numpy as np
import pytest

import foveate as fv
from conftest import equal

PER_FRAME = ("number", "time_us", "sent_pixels", "sent_bytes")
PER_REGION = ("srs", "trs", "active", "action", "changed", "rendered")
FLOW = {"spatial": ["edge", {"feature": "flow", "radius": 2}], "hardware": {"organization": "serial"}}


def assert_stacked(found, outcomes):
    """Checks that the arrays of a clip are those of its outcomes."""
    assert len(found) == len(outcomes) > 0
    for name in PER_FRAME + PER_REGION:
        expected = np.array([getattr(outcome, name) for outcome in outcomes])
        stacked = getattr(found, name)
        assert np.array_equal(stacked, expected) and stacked.dtype == expected.dtype and stacked.flags.writeable, name
    assert found.scores.keys() == outcomes[0].scores.keys()
    for feature, scores in found.scores.items():
        assert np.array_equal(scores, [outcome.scores[feature] for outcome in outcomes])
    if outcomes[0].displacements is None:
        assert found.displacements is None
    else:
        assert np.array_equal(found.displacements, [outcome.displacements for outcome in outcomes])


@pytest.mark.parametrize("keys", [{}, {"region": {"size": 5}}, FLOW, {"denoise": {"filter": "median3x3"}, "render": {"payload": "raw"}}])
def test_a_run_is_its_steps(keys, frames):
    camera, other = fv.Camera(**keys), fv.Camera(**keys)
    for clip in (frames, list(frames), frames[:, ::-1]):
        found = camera.run(clip)
        assert_stacked(found, [other.step(frame, keep=True) for frame in clip])
        # Both cameras go on from the same state: nothing was reset.
        assert camera.frames == other.frames
    assert camera.step(frames[3]).packets() == other.step(frames[3]).packets()
    assert found.number[0] == 24 and found.names[:2] == ("array[0]", "array[1]") and found.problem is None
    assert found.design == camera.design and repr(found).startswith("<foveate.ClipOutcome of 12 frames: ")


def test_frames_of_more_bits(frames):
    deep = frames.astype(np.uint16) * 16
    camera, other = fv.Camera("mad", frame={"pixel_bits": 12}), fv.Camera("mad", frame={"pixel_bits": 12})
    found = camera.run(deep)
    assert_stacked(found, [other.step(frame, keep=True) for frame in deep])
    assert found.rendered.dtype == np.uint16


def test_a_run_over_footage_is_a_simulation():
    options = {"max_frames": 6, "resize": (100, 60)}
    camera = fv.Camera("steady")
    found = camera.run("scene:street", **options)
    assert_stacked(found, list(fv.simulate("scene:street", "steady", **options)))
    # Times of a second run continue from the last frame.
    again = camera.run("scene:street", rendered=False, **options)
    assert again.rendered is None and again.number.tolist() == list(range(6, 12))
    assert again.time_us.tolist() == [camera_time(number) for number in range(6, 12)]
    camera.reset()
    assert np.array_equal(camera.run("scene:street", **options).active, found.active)


def camera_time(number):
    """Returns the time of a frame at 30 frames per second in microseconds."""
    return (number * 1_000_000 + 15) // 30


def test_the_rate_of_arrays_gives_their_times(frames):
    camera = fv.Camera()
    assert camera.run(frames[:3], rate=100).time_us.tolist() == [0, 10_000, 20_000]
    assert camera.run(frames[:2], rate=100).time_us.tolist() == [30_000, 40_000]
    assert camera.step(frames[0]).time_us == 73_333
    # Floats are rates, too, and two halves have the times of the whole clip.
    for rate in (30_000 / 1001, 100 / 3, 7):
        whole, halves = fv.Camera().run(frames, rate=rate), fv.Camera()
        parts = [halves.run(part, rate=rate).time_us for part in (frames[:6], frames[6:])]
        assert np.abs(np.concatenate(parts) - whole.time_us).max() <= 1
    assert len(fv.Camera().run(frames, start=1e-5).number) == len(frames) - 1


def test_one_clip_is_asked_for(frames, tmp_path):
    for name in ("a", "b"):
        (tmp_path / name).mkdir()
        for number, frame in enumerate(frames[:3]):
            (tmp_path / name / f"{number}.pgm").write_bytes(b"P5 83 60 255\n" + frame.tobytes())
    raster = {"hardware": {"organization": "raster"}}
    for inputs in ([tmp_path / "a", tmp_path / "b"], tmp_path):
        for call in (
            lambda inputs: fv.Camera().run(inputs),
            fv.simulate,
            lambda inputs: fv.clocks(inputs, raster),
            fv.pixel_events,
            fv.fidelity,
            lambda inputs: fv.explain(inputs, frame=0, region=(0, 0)),
        ):
            with pytest.raises(ValueError, match="the inputs are 2 clips"):
                call(inputs)


def test_arrays_of_the_ideal_camera_are_compared(frames):
    coarse = {"frame": {"pixel_bits": 6}}
    found = fv.fidelity(frames, coarse, ideal="paper")
    assert 0 < found["psnr_ideal"] < 60


def test_a_run_is_refused_with_a_reason(frames, tmp_path):
    camera = fv.Camera()
    camera.run(frames[:1])
    with pytest.raises(ValueError, match="30x20 pixels, but this camera has taken frames of 83x60"):
        camera.run(np.zeros((2, 20, 30), np.uint8))
    with pytest.raises(TypeError, match="run takes footage, .* or frames, .*; not int"):
        camera.run(3)
    with pytest.raises(TypeError, match=r"list of arrays of shape \(12, 60, 83\)"):
        camera.run([frames])
    with pytest.raises(TypeError, match="not float64"):
        camera.run(frames / 2)
    with pytest.raises(TypeError, match="run has no option max_frame, but max_frames; its options are rendered, progress, max_frames"):
        camera.run(frames, max_frame=3)
    with pytest.raises(FileNotFoundError):
        camera.run(tmp_path / "nothing.mp4")
    with pytest.raises(ValueError, match="images of a set do not follow one another; run needs a clip"):
        camera.run(frames, images="set")
    with pytest.raises(ValueError, match="no frame"):
        camera.run([])
    assert camera.frames == 1


def test_a_damaged_video_is_run_as_far_as_it_goes(frames, tmp_path):
    path = tmp_path / "clip.y4m"
    path.write_bytes((b"YUV4MPEG2 W83 H60 F30:1 Cmono\n" + b"".join(b"FRAME\n" + frame.tobytes() for frame in frames))[:-100])
    with pytest.warns(UserWarning, match="clip.y4m"):
        found = fv.Camera().run(path)
    assert len(found) == 11 and "clip.y4m" in found.problem


def test_progress_is_shown_where_someone_sees_it(capfd):
    fv.Camera().run("scene:street", max_frames=3)
    assert capfd.readouterr().err == ""
    fv.Camera().run("scene:street", max_frames=3, progress=True)
    shown = capfd.readouterr().err
    assert shown.startswith("\r1 of 3 frames") and shown.endswith("\r")
    code = "import foveate as fv; fv.Camera().run('scene:street', max_frames=3{})"
    for option, is_shown in [("", True), (", progress=False", False)]:
        own, other = pty.openpty()
        subprocess.run([sys.executable, "-c", code.format(option)], stderr=other, check=True)
        os.close(other)
        try:
            shown = os.read(own, 1000)
        except OSError:
            shown = b""
        os.close(own)
        assert (b"1 of 3 frames" in shown) == is_shown


def test_an_interrupt_leaves_a_camera_that_goes_on():
    code = (
        "import foveate as fv, numpy as np, os, signal, threading\n"
        # A job in the background of a shell ignores the signal.
        "signal.signal(signal.SIGINT, signal.default_int_handler)\n"
        "camera = fv.Camera('paper')\n"
        "threading.Timer(0.5, os.kill, (os.getpid(), signal.SIGINT)).start()\n"
        "try:\n"
        "    camera.run('scene:street', max_frames=1_000_000, rendered=False)\n"
        "except KeyboardInterrupt:\n"
        "    taken = camera.frames\n"
        "    print(0 < taken < 1_000_000 and camera.step(np.zeros((224, 224), np.uint8)).number == taken)\n"
    )
    found = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, timeout=60)
    assert found.stdout == "True\n", found.stderr


def test_arrays_are_read_as_a_file_of_them(frames, tmp_path):
    path = tmp_path / "clip.y4m"
    path.write_bytes(b"YUV4MPEG2 W83 H60 F30:1 Cmono\n" + b"".join(b"FRAME\n" + frame.tobytes() for frame in frames))
    options = {"max_frames": 7, "crop": (60, 40, 8, 8)}
    for clip in (frames, list(frames)):
        run = fv.simulate(clip, "steady", **options)
        assert run.total == 7
        outcomes, expected = list(run), list(fv.simulate(path, "steady", **options))
        assert len(outcomes) == 7 and all(map(equal, outcomes, expected))
        assert [one.time_us for one in outcomes] == [one.time_us for one in expected] and outcomes[3].name == "array[3]"
        assert np.array_equal(outcomes[2].frame, frames[2, 8:48, 8:68]) and outcomes[2].packets() == expected[2].packets()
        assert fv.fidelity(clip, "steady", **options) == fv.fidelity(path, "steady", **options)
        own, other = (fv.explain(one, "steady", frame=5, region=(2, 3), **options) for one in (clip, path))
        assert {**own, "name": ""} == {**other, "name": ""} and own["name"] == "array[5]"
    with pytest.raises(TypeError, match="simulate takes footage, .* or frames, "):
        fv.simulate(3)
    unrelated = list(fv.simulate(frames[:2], images="set"))
    assert all(outcome.trs.all() for outcome in unrelated)


@pytest.mark.parametrize(("options", "words"), [
    ({}, []),
    ({"contrast": 40}, ["--contrast", "40"]),
    ({"log": True}, ["--log"]),
    ({"log": True, "contrast": 0.35}, ["--log", "--contrast", "0.35"]),
])
def test_pixel_events_are_those_of_simulate(options, words, command, tmp_path):
    command("simulate", "scene:street", "-o", tmp_path / "out", "--frames", 4, "--pixel-events", *words, "--rendered", "none", "--quiet")
    expected = np.load(tmp_path / "out/pixel_events.npz")["events"]
    events = fv.pixel_events("scene:street", max_frames=4, **options)
    assert events.dtype == np.dtype([("x", "<i2"), ("y", "<i2"), ("t", "<i8"), ("p", "?")])
    assert len(events) > 100 and np.array_equal(events, expected) and events.flags.writeable
    summary = json.loads((tmp_path / "out/summary.json").read_text())
    assert summary["frames"] == 4


def test_pixel_events_of_arrays(frames):
    clip = np.zeros((3, 4, 6), np.uint8)
    clip[1:, 1, 2] = 50
    clip[2, 3, 5] = 20
    events = fv.pixel_events(clip, contrast=20, rate=1000)
    assert events.tolist() == [(2, 1, 1000, True), (2, 1, 1000, True), (5, 3, 2000, True)]
    clip[2, 1, 2] = 0
    assert fv.pixel_events(clip, contrast=20, rate=1000)[2:].tolist() == [(2, 1, 2000, False), (2, 1, 2000, False), (5, 3, 2000, True)]
    # The default contrast is that of the design.
    assert len(fv.pixel_events(clip, "paper")) == len(fv.pixel_events(clip, contrast=9))
    deep = fv.Camera("mad", frame={"pixel_bits": 12})
    assert len(fv.pixel_events(clip.astype(np.uint16) * 16, deep, contrast=320, rate=1000)) == 5
    assert len(fv.pixel_events(frames[:1])) == 0
    for contrast, error in [(0.001, ValueError), ("much", TypeError), (True, TypeError), (float("nan"), ValueError)]:
        with pytest.raises(error, match="contrast"):
            fv.pixel_events(clip, contrast=contrast)
    with pytest.raises(TypeError, match="pixel_events has no option level; its options are contrast, log, max_frames"):
        fv.pixel_events(clip, level=3)
    with pytest.raises(ValueError, match="pixel_events needs a clip"):
        fv.pixel_events(clip, images="set")
