# SPDX-License-Identifier: MIT OR Apache-2.0
"""The clocks of a camera equal those of the command line, row by row."""
import re

import numpy as np
import pyarrow.parquet
import pytest

import foveate as fv

RASTER = {"hardware": {"organization": "raster"}}
#: By name: a design, its keys on the command line, the options of a camera, and those of the command line.
CASES = {
    "pipelined": ({}, [], {}, []),
    "serial": (
        {"hardware": {"organization": "serial", "fold": 2}},
        ["hardware.organization='serial'", "hardware.fold=2"],
        {"clock_hz": 1e6},
        ["--clock", "1MHz"],
    ),
    "raster": (RASTER, ["hardware.organization='raster'"], {"sink_rate": (1, 8)}, ["--sink-rate", "1/8"]),
    "means": (
        {**RASTER, "render": {"irrelevant": "mean"}},
        ["hardware.organization='raster'", "render.irrelevant='mean'"],
        {"clock_hz": 50_000_000, "sink_stalls": [[0, 5], [2100, 4000], [1_700_000, 1]]},
        ["--clock", "50MHz", "--sink-stalls", "stalls.csv"],
    ),
}
#: The events that a case must show.
EVENTS = {
    "pipelined": {"decision", "pixels"},
    "serial": {"decision", "pixels"},
    "raster": {"decision", "pixels", "loss"},
    "means": {"decision", "pixels", "means", "loss"},
}


def stepped(camera, frames, times=None):
    """Returns the rows of all frames, one step after the other."""
    given = [{} for _ in frames] if times is None else [{"time_us": time} for time in times]
    return np.concatenate([*(camera.step(frame, **keys) for frame, keys in zip(frames, given, strict=True)), camera.finish()])


@pytest.mark.parametrize("case", CASES)
def test_rows_equal_those_of_simulate(case, command, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    (tmp_path / "stalls.csv").write_text("clock,clocks\n0,5\n2100,4000\n1700000,1\n")
    config, keys, options, words = CASES[case]
    sets = [word for key in keys for word in ("--set", key)]
    command("simulate", "scene:street", "-o", "out", "--frames", 5, "--rendered", "none", "--quiet", "--clocks=npy,parquet", *sets, *words)
    names = ("decision", "pixels", "means", "loss")
    expected = [(names[event], *numbers, last == 1, aborted == 1) for event, *numbers, last, aborted in np.load("out/clocks.npy").tolist()]
    assert {row[0] for row in expected} == EVENTS[case]

    rows = fv.clocks("scene:street", config, max_frames=5, **options)
    assert rows.tolist() == expected
    written = pyarrow.parquet.read_table("out/clocks.parquet")
    assert written.column_names == list(rows.dtype.names)
    types = [np.dtype(field.type.to_pandas_dtype()) for field in written.schema][1:]
    assert types == [rows.dtype[name] for name in rows.dtype.names[1:]]

    clip = list(fv.simulate("scene:street", max_frames=5))
    frames = [outcome.frame for outcome in clip]
    times = [outcome.time_us for outcome in clip] if "clock_hz" in options else None
    camera = fv.TimedCamera(config, **options)
    assert stepped(camera, frames, times).tolist() == expected
    # Without times, frames come at 30 frames per second, as those of the scene.
    assert stepped(camera, frames).tolist() == expected
    assert fv.clocks(np.stack(frames), config, **options).tolist() == fv.clocks(frames, config, **options).tolist() == expected


@pytest.mark.parametrize("config", [{}, {"spatial": [{"feature": "variance"}]}, RASTER])
def test_rows_come_as_soon_as_they_are_certain(config, frames):
    camera = fv.TimedCamera(config)
    for number, frame in enumerate(frames):
        # A pipelined array decides a frame when the next one enters, or the one after that, and sends its words later.
        assert camera.step(frame)["frame"].min(initial=number) >= number - 3
    assert camera.frames == len(frames)
    assert camera.finish()["frame"].min(initial=11) >= 9
    assert camera.frames == 0 and len(camera.finish()) == 0


def test_a_finished_or_reset_camera_has_seen_nothing(frames):
    camera = fv.TimedCamera({**RASTER, "temporal": {"reference": "last-sent"}}, sink_rate=(1, 3))
    assert (camera.design.width, camera.design.height) == (224, 224)
    first = stepped(camera, frames)
    assert first["clock"].min() < 1000 and {"pixels", "loss"} <= set(first["event"])
    camera.step(frames[3])
    assert (camera.frames, camera.design.width, camera.design.height) == (1, 83, 60)
    camera.reset()
    assert camera.frames == 0 and camera.design.width == 224
    assert np.array_equal(stepped(camera, frames), first)
    assert len(camera.step(np.zeros((40, 60), np.uint8))) and camera.design.width == 60


def test_a_lost_region_is_no_reference(frames):
    config = {**RASTER, "temporal": {"reference": "last-sent"}}
    camera = fv.Camera(config)
    active = [number for number, frame in enumerate(frames) for _ in range(camera.step(frame).active.sum())]
    lossless, lossy = fv.clocks(frames, config), fv.clocks(frames, config, sink_rate=(1, 8))

    def sent(rows):
        return rows[(rows["event"] == "pixels") & rows["is_last"] & ~rows["is_aborted"]]

    assert sorted(sent(lossless)["frame"]) == active and "loss" not in lossless["event"]
    # Lost regions are sent again in later frames, in which nothing changes there.
    lost, again = lossy[lossy["event"] == "loss"], sent(lossy)
    assert len(lost) > 0 and again["frame"].max() == 11
    assert set(zip(again["frame"].tolist(), again["region"].tolist(), strict=True)) - set(
        zip(sent(lossless)["frame"].tolist(), sent(lossless)["region"].tolist(), strict=True)
    )


def test_words_have_values_of_a_sink_with_stalls(frames):
    # The first stall begins when the first word is on the ports, which then stays there.
    free = fv.clocks(frames[:1], RASTER)
    clock = int(free["clock"][free["event"] == "pixels"][0])
    for stalls in ([(clock + 1, 40)], np.array([[clock + 1, 40]], np.uint16), np.array([[clock + 1, 40]], np.uint64)):
        rows = fv.clocks(frames[:1], RASTER, sink_stalls=stalls)
        words = rows[rows["event"] == "pixels"]
        assert (words["clock"][0], words["words"][0], words["clock"][1], words["first_word"][1]) == (clock, 1, clock + 41, 1)
    for none in ([], np.zeros((0, 2), int), None):
        assert np.array_equal(fv.clocks(frames[:1], RASTER, sink_stalls=none), free)
    nothing = fv.clocks(frames, RASTER, sink_rate=(0, 1))
    # One word waits on the ports for ever.
    assert nothing["words"].sum() == 1


def test_frames_come_at_their_times(frames):
    camera = fv.TimedCamera(clock_hz=1_000_000)
    times = [0, 50_000, 50_000, 60_000]
    rows = [camera.step(frame, time_us=time) for frame, time in zip(frames[:4], times, strict=True)]
    rows = np.concatenate([*rows, camera.step(frames[4]), camera.finish()])
    decided = rows[(rows["event"] == "decision") & (rows["region"] == 0)]
    start = decided["clock"] - decided["clock"][0]
    # The third frame follows the second, which has 64 pixels per region; the last comes 1/30 s after the one before.
    assert start.tolist() == [0, 50_000, 50_064, 60_000, 93_333]


def test_pixels_are_taken_in_any_layout(frames):
    expected = fv.clocks(frames, RASTER)
    wide = np.zeros((*frames.shape, 3), np.uint8)
    wide[..., 1] = frames
    for given in (np.asfortranarray(frames), wide[..., 1], frames[:, ::-1][:, ::-1]):
        assert np.array_equal(stepped(fv.TimedCamera(RASTER), given), expected)
    deep = {**RASTER, "frame": {"pixel_bits": 12}}
    words = frames.astype(np.uint16) << 4
    assert np.array_equal(stepped(fv.TimedCamera(deep), np.asfortranarray(words)), fv.clocks(words, deep))


def test_a_damaged_video_gives_what_there_is_and_warns(frames, tmp_path):
    path = tmp_path / "clip.y4m"
    header = b"YUV4MPEG2 W83 H60 F30:1 Cmono\n"
    path.write_bytes((header + b"".join(b"FRAME\n" + frame.tobytes() for frame in frames))[:-100])
    with pytest.warns(UserWarning, match="clip.y4m"):
        rows = fv.clocks(path, RASTER)
    assert np.array_equal(rows, fv.clocks(frames[:-1], RASTER))


CLOCK = "expected a whole number of Hz, 1 to 1000000000000, for example 100e6"
RATE = r"expected \(words, clocks\), whole numbers with at most as many words as clocks, for example \(1, 4\)"
STALLS = r"sink_stalls are an array of whole numbers of the shape \(stalls, 2\): the first clock of each stall, and its number of clocks; "
ORDER = "list stalls in order, without overlaps"


@pytest.mark.parametrize(("options", "error", "message"), [
    ({"clock_hz": 0}, ValueError, f"clock_hz = 0: {CLOCK}"),
    ({"clock_hz": 1.5}, ValueError, f"clock_hz = 1.5: {CLOCK}"),
    ({"clock_hz": float("nan")}, ValueError, f"clock_hz = nan: {CLOCK}"),
    ({"clock_hz": 2e12}, ValueError, f"clock_hz = 2000000000000.0: {CLOCK}"),
    ({"clock_hz": 10**400}, ValueError, f"clock_hz = 10*: {CLOCK}"),
    ({"clock_hz": "100MHz"}, TypeError, f"clock_hz = '100MHz': {CLOCK}"),
    ({"sink_rate": (2, 1)}, ValueError, rf"sink_rate = \(2, 1\): {RATE}"),
    ({"sink_rate": (0, 0)}, ValueError, rf"sink_rate = \(0, 0\): {RATE}"),
    ({"sink_rate": (-1, 4)}, ValueError, rf"sink_rate = \(-1, 4\): {RATE}"),
    ({"sink_rate": (0.5, 1)}, ValueError, rf"sink_rate = \(0.5, 1\): {RATE}"),
    ({"sink_rate": (1, 2, 3)}, ValueError, rf"sink_rate = \(1, 2, 3\): {RATE}"),
    ({"sink_rate": (1, 2**32)}, ValueError, rf"sink_rate = \(1, 4294967296\): {RATE}"),
    ({"sink_rate": "1/4"}, TypeError, f"sink_rate = '1/4': {RATE}"),
    ({"sink_rate": 0.25}, TypeError, f"sink_rate = 0.25: {RATE}"),
    ({"sink_rate": (1, 4), "sink_stalls": [(0, 1)]}, TypeError, "give sink_rate or sink_stalls, not both"),
    ({"sink_stalls": [(0, 4), (3, 1)]}, ValueError, rf"sink_stalls\[1\] begins at clock 3, but the stall before it ends at clock 4; {ORDER}"),
    ({"sink_stalls": [(9, 1), (0, 4)]}, ValueError, rf"sink_stalls\[1\] begins at clock 0, but the stall before it ends at clock 10; {ORDER}"),
    ({"sink_stalls": [(1, 1), (5, 0)]}, ValueError, r"sink_stalls\[1\] = \(5, 0\): expected a clock from 0 and a number of clocks from 1"),
    ({"sink_stalls": [(-1, 4)]}, ValueError, r"sink_stalls\[0\] = \(-1, 4\): expected a clock from 0 and a number of clocks from 1"),
    ({"sink_stalls": [(0.5, 1)]}, TypeError, STALLS + r"not of float64; convert them, for example with stalls.astype\(int\)"),
    ({"sink_stalls": [(2**64, 1)]}, TypeError, STALLS + "not of object"),
    ({"sink_stalls": [1, 2]}, ValueError, STALLS + r"not of the shape \(2,\)"),
    ({"sink_stalls": 3}, ValueError, STALLS + r"not of the shape \(\)"),
    ({"sink_stalls": [(1, 2, 3)]}, ValueError, STALLS + r"not of the shape \(1, 3\)"),
    ({"sink_stalls": [(1, 2), (3,)]}, ValueError, STALLS + ".*inhomogeneous"),
    ({"sink_stalls": "stalls.csv"}, TypeError, STALLS + r"not a path: numpy.loadtxt\(path, int, delimiter=\",\", skiprows=1, ndmin=2\)"),
])
def test_a_wrong_clock_or_sink_is_refused_with_what_would_be_right(options, error, message):
    for use in (lambda: fv.TimedCamera(RASTER, **options), lambda: fv.clocks("scene:street", RASTER, max_frames=1, **options)):
        with pytest.raises(error, match=message):
            use()


def test_the_table_of_stalls_in_a_message_can_be_read(tmp_path):
    path = tmp_path / "stalls.csv"
    path.write_text("clock,clocks\n2100,50\n")
    stalls = np.loadtxt(path, int, delimiter=",", skiprows=1, ndmin=2)
    options = {"max_frames": 1}
    expected = fv.clocks("scene:street", RASTER, sink_stalls=[(2100, 50)], **options)
    assert np.array_equal(fv.clocks("scene:street", RASTER, sink_stalls=stalls, **options), expected)


def test_a_wrong_frame_changes_nothing(frames):
    camera = fv.TimedCamera(RASTER, clock_hz=1_000_000)
    rows = [camera.step(frames[0], time_us=1000)]
    for frame, options, error, message in [
        (frames[0, :40], {}, ValueError, "the frame has 83x40 pixels, but this camera has taken frames of 83x60"),
        (frames[0].astype(float), {}, TypeError, "not float64"),
        (frames[0].astype(np.uint16), {}, TypeError, "the frame has dtype uint16, but the design has 8 bits per pixel"),
        (frames, {}, ValueError, "give the frames one by one"),
        (frames[0], {"time_us": 999}, ValueError, "time_us = 999 is before the time of the frame before, 1000; times never go back"),
        (frames[0], {"time_us": -1}, OverflowError, "time_us = -1: expected a whole number of microseconds"),
        (frames[0], {"time_us": 1.5}, TypeError, "time_us = 1.5: expected a whole number of microseconds"),
    ]:
        with pytest.raises(error, match=message):
            camera.step(frame, **options)
    assert camera.frames == 1
    rows += [camera.step(frames[1], time_us=34_000), camera.finish()]
    other = fv.TimedCamera(RASTER, clock_hz=1_000_000)
    assert np.array_equal(np.concatenate(rows), stepped(other, frames[:2], [1000, 34_000]))
    deep = fv.TimedCamera(frame={"pixel_bits": 9})
    with pytest.raises(ValueError, match=re.escape("pixel (3, 0) is 512; the largest value of 9 bits is 511")):
        deep.step(np.array([[0, 1, 2, 512] * 4] * 16, np.uint16))
    # It was no first frame, so the size is still open.
    assert (deep.frames, deep.design.width) == (0, 224)
    assert len(deep.finish()) == 0
    deep.step(np.zeros((40, 60), np.uint16))
    assert deep.design.width == 60


def test_what_has_no_clocks_is_refused(frames):
    with pytest.raises(TypeError, match="time_us = 5: a core without a clock takes its frames without a pause; .* clock_hz=100e6"):
        fv.TimedCamera(RASTER).step(frames[0], time_us=5)
    with pytest.raises(ValueError, match="images of a set do not follow one another; clocks needs a clip"):
        fv.clocks(frames, images="set")
    with pytest.raises(TypeError, match="clocks has no option clock, but clock_hz; its options are clock_hz, sink_rate, sink_stalls, max_frames"):
        fv.clocks("scene:street", clock=100e6)
    with pytest.raises(TypeError, match=r"clocks takes footage.* or frames.*\(frames, height, width\).*; not int"):
        fv.clocks(3)
    with pytest.raises(ValueError, match="array holds no frame"):
        fv.clocks(frames[:0])
    with pytest.raises(FileNotFoundError, match="input `nothing.mp4` does not exist"):
        fv.clocks("nothing.mp4")
    with pytest.raises(ValueError, match="unknown preset|papier"):
        fv.TimedCamera("papier")
    with pytest.raises(ValueError, match="frame.width"):
        fv.TimedCamera("raster").step(frames[0])


def test_times_beyond_every_clip_are_taken(frames):
    camera = fv.TimedCamera(RASTER, clock_hz=1e12, sink_rate=(1, 2))
    for _ in range(3):
        rows = camera.step(frames[0], time_us=2**64 - 1)
        assert rows["clock"].min() > 2**60 and rows["last_clock"].max() < 2**62
    assert len(camera.finish()) == 0


def test_a_camera_shows_itself(frames):
    camera = fv.TimedCamera(region={"size": 16})
    camera.step(frames[0])
    assert repr(camera).startswith("<foveate.TimedCamera ") and "1 frames seen" in repr(camera)
    assert camera.design.fingerprint in camera._repr_html_()
