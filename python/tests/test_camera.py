# SPDX-License-Identifier: MIT OR Apache-2.0
"""Tests of cameras: configuration, state, and refused values."""
import copy
import pickle
import re

import numpy as np
import pytest
import tomllib

import foveate as fv
from conftest import equal


def test_a_configuration_is_a_preset_a_file_a_dict_a_design_or_a_camera(tmp_path):
    expected = fv.Design("paper", region={"size": 16}, temporal={"reference": "last-sent"})
    (tmp_path / "camera.toml").write_text('[region]\nsize = 16\n[temporal]\nreference = "last-sent"\n')
    values = {"region": {"size": np.int64(16)}, "temporal": {"reference": "last-sent"}}
    for given in (tmp_path / "camera.toml", str(tmp_path / "camera.toml"), values, expected, fv.Camera(expected)):
        assert fv.Design(given) == expected == fv.Camera(given).design
        assert hash(fv.Design(given)) == hash(expected)
    assert expected != fv.Design() and fv.Design("paper") == fv.Design() == fv.Design({})
    assert tomllib.loads(expected.toml())["region"]["size"] == 16
    assert set(fv.presets()) >= {"paper", "bare", "steady", "serial"}


def test_a_table_that_is_none_changes_nothing():
    keys = dict.fromkeys(["frame", "region", "denoise", "spatial", "decision", "temporal", "render", "periphery", "zones", "hardware"])
    assert fv.Design("paper", **keys) == fv.Design("paper") == fv.Camera("paper", **keys).design
    with pytest.raises(ValueError, match="regions"):
        fv.Design(regions={})


def test_features_are_names_dicts_or_lists():
    assert fv.Design(spatial="mad").features == ("mad",)
    assert fv.Design(spatial={"feature": "edge", "level": 50}).features == ("edge",)
    both = fv.Design(spatial=["edge", {"feature": "variance", "min_score": 2.5}], decision={"combine": "all"})
    assert both.features == ("edge", "variance")
    assert tomllib.loads(both.toml())["spatial"][1]["min_score"] == 2.5


def test_a_depth_scales_the_thresholds_of_a_preset_as_the_command_line_does(command):
    design = fv.Design("corner", frame={"pixel_bits": 12})
    import json

    checked = json.loads(command("check", "-p", "corner", "--set", "frame.pixel_bits=12", "--json"))
    assert checked["fingerprint"] == design.fingerprint


WRONG = [
    (("papier",), {}, ValueError, "unknown preset `papier`; presets are paper"),
    (("nothing.toml",), {}, FileNotFoundError, "cannot read the configuration `nothing.toml`"),
    ((3,), {}, TypeError, "the name of a preset .* not int"),
    ((), {"region": {"size": 99}}, ValueError, r"`region.size` = 99 is out of range; the valid range is 2..=64"),
    ((), {"region": {"sice": 9}}, ValueError, "sice.*size"),
    ((), {"region": 8}, TypeError, "region takes a dict"),
    ((), {"regions": {"size": 8}}, ValueError, "regions"),
    ((), {"region": {"size": 2**70}}, ValueError, "beyond the range"),
    ((), {"region": {"size": [1]}}, ValueError, "region.size"),
    ((), {"region": {"size": "8\n[hardware]"}}, ValueError, "region.size"),
    ((), {"region": {"size": object()}}, TypeError, "region.size takes a number"),
    (({"region": {"size": 8.5}},), {}, ValueError, "region.size"),
    ((), {"spatial": 3}, TypeError, "not iterable"),
    ((), {"spatial": []}, ValueError, "spatial"),
]


@pytest.mark.parametrize("arguments, keys, error, message", WRONG, ids=[message for *_, message in WRONG])
def test_what_is_no_configuration_is_refused_by_name(arguments, keys, error, message):
    for made in (fv.Camera, fv.Design):
        with pytest.raises(error, match=message):
            made(*arguments, **keys)


def test_the_size_is_that_of_the_first_frame_until_a_reset(frames):
    camera = fv.Camera()
    assert (camera.design.width, camera.design.height) == (224, 224)
    first = camera.step(frames[0])
    assert (camera.design.width, camera.design.height) == (83, 60)
    assert first.active.shape == (8, 11) == (camera.design.rows, camera.design.columns)
    with pytest.raises(ValueError, match="30x20 pixels, but this camera has taken frames of 83x60"):
        camera.step(np.zeros((20, 30), np.uint8))
    assert camera.frames == 1
    camera.reset()
    assert camera.frames == 0 and camera.design.width == 224
    assert camera.step(np.zeros((20, 30), np.uint8)).active.shape == (3, 4)
    with pytest.raises(ValueError, match="frame.width"):
        fv.Camera(frame={"width": 40, "height": 20}).step(np.zeros((20, 30), np.uint8))


def test_a_reset_camera_has_seen_nothing(frames):
    camera = fv.Camera("steady")
    fresh = [camera.step(frame, keep=True) for frame in frames]
    camera.reset()
    for frame, expected in zip(frames, fresh, strict=True):
        assert equal(camera.step(frame), expected)


def test_a_rendered_frame_is_there_until_the_next_step_or_kept(frames):
    camera = fv.Camera()
    first = camera.step(frames[0])
    second = camera.step(frames[1])
    with pytest.raises(RuntimeError, match="read outcome.rendered before the next step"):
        assert first.rendered.any()
    read = second.rendered
    kept = camera.step(frames[2], keep=True)
    camera.step(frames[3])
    assert second.rendered is read
    other = fv.Camera()
    for frame in frames[:3]:
        last = other.step(frame)
    assert np.array_equal(kept.rendered, last.rendered)
    last_of_reset = other.step(frames[3])
    other.reset()
    with pytest.raises(RuntimeError, match="was reset"):
        assert last_of_reset.rendered.any()


def test_arrays_outlive_everything(frames):
    camera = fv.Camera()
    outcome = camera.step(frames[0])
    arrays = [outcome.srs, outcome.rendered, outcome.scores["edge"], outcome.changed]
    copies = [array.copy() for array in arrays]
    assert outcome.srs is outcome.srs and outcome.scores is outcome.scores
    for frame in frames[1:]:
        camera.step(frame)
    del outcome, camera
    for array, expected in zip(arrays, copies, strict=True):
        assert np.array_equal(array, expected) and array.flags.writeable


def test_outcomes_agree_with_themselves(frames):
    camera = fv.Camera()
    for frame in frames:
        outcome = camera.step(frame)
        assert np.array_equal(outcome.active, outcome.srs & outcome.trs)
        assert np.array_equal(outcome.action == fv.ACTIONS.index("forward"), outcome.active)
        assert outcome.changed.max() <= 64 and outcome.scores["edge"].dtype == np.int64
    assert outcome.design == camera.design and outcome.frame is None and outcome.name is None


FLOW = {"spatial": ["edge", {"feature": "flow", "radius": 2}], "hardware": {"organization": "serial"}}


def test_displacements_are_those_of_a_pan():
    chance = np.random.default_rng(5)
    scene = chance.integers(0, 256, (80, 80), np.uint8)
    camera = fv.Camera("paper", denoise={"filter": "none"}, **FLOW)
    # The content moves by one pixel to the left and two down.
    outcomes = [camera.step(scene[20 - 2 * t : 60 - 2 * t, 10 + t : 58 + t]) for t in range(4)]
    for outcome, expected in zip(outcomes, [(0, 0)] + 3 * [(-1, 2)], strict=True):
        displacements = outcome.displacements
        assert displacements.dtype == np.int8 and displacements.shape == (5, 6, 2)
        assert (displacements == expected).all()
        assert displacements is outcome.displacements and displacements.flags.writeable
    assert (outcomes[1].scores["flow"] > 0).all()


def test_without_flow_there_are_no_displacements(frames):
    assert fv.Camera().step(frames[0]).displacements is None
    (outcome,) = fv.simulate("scene:street", max_frames=1)
    assert outcome.displacements is None


def test_times_of_steps(frames):
    camera = fv.Camera()
    assert [camera.step(frames[0]).time_us, camera.step(frames[1]).time_us] == [0, 33_333]
    assert camera.step(frames[2], time_us=50_000).time_us == 50_000
    # Two frames may have the same time, and frames without one continue from the last given time.
    assert camera.step(frames[3], time_us=50_000).time_us == 50_000
    assert [camera.step(frame).time_us for frame in frames[4:7]] == [83_333, 116_667, 150_000]
    with pytest.raises((OverflowError, TypeError)):
        camera.step(frames[7], time_us=-1)


def test_times_never_go_back(frames):
    camera = fv.Camera()
    camera.step(frames[0], time_us=1_000)
    with pytest.raises(ValueError, match="time_us = 999 is before the time of the frame before, 1000; times never go back"):
        camera.step(frames[1], time_us=999)
    # A refused frame changes nothing.
    assert camera.frames == 1
    assert camera.step(frames[1]).time_us == 34_333
    camera.reset()
    assert camera.step(frames[0], time_us=5).time_us == 5
    with pytest.raises(ValueError, match="frames of 83x60"):
        camera.step(np.zeros((8, 8), np.uint8), time_us=2**63)
    assert camera.step(frames[1], time_us=2**64 - 1).time_us == camera.step(frames[2]).time_us == 2**64 - 1


@pytest.mark.parametrize("time, error", [(-1, OverflowError), (2**64, OverflowError), (1.5, TypeError), ("1", TypeError)])
def test_times_are_whole_microseconds(frames, time, error):
    with pytest.raises(error, match=f"time_us = {re.escape(repr(time))}: expected a whole number of microseconds, 0 to 18446744073709551615"):
        fv.Camera().step(frames[0], time_us=time)


def test_hardware_of_a_camera_has_the_size_of_its_frames(frames, tmp_path):
    camera = fv.Camera("bare", region={"size": 16})
    asked = "this camera has no size yet: .*first frame.*or give the size, frame="
    uses = [
        lambda: camera.generate(tmp_path / "core"),
        lambda: fv.generate(camera, tmp_path / "core"),
        camera.estimate,
        lambda: fv.estimate(camera),
        camera.registers,
    ]
    for use in uses:
        with pytest.raises(ValueError, match=asked):
            use()
    assert not (tmp_path / "core").exists()
    camera.step(frames[0])
    camera.generate(tmp_path / "core")
    assert (fv.Design(tmp_path / "core" / "design.toml").width, fv.Design(tmp_path / "core" / "design.toml").height) == (83, 60)
    camera.reset()
    with pytest.raises(ValueError, match=asked):
        fv.generate(camera, tmp_path / "other")
    # A frame with only one of its two sizes is refused.
    with pytest.raises(ValueError, match=asked):
        fv.Camera(frame={"width": 64}).generate(tmp_path / "other")
    # A design has the size in its file, or that of the paper.
    fv.generate("bare", tmp_path / "other")
    assert fv.Design(tmp_path / "other" / "design.toml").width == 224


def test_a_camera_is_copied_before_its_first_frame_only(frames):
    camera = fv.Camera("steady", threads=2, region={"size": 4})
    for made in (pickle.loads(pickle.dumps(camera)), copy.deepcopy(camera)):
        assert made.design == camera.design
    assert equal(made.step(frames[0]), camera.step(frames[0]))
    for how in (pickle.dumps, copy.copy, copy.deepcopy):
        with pytest.raises(TypeError, match="has seen 1 frames, which a copy would not have"):
            how(camera)
    design = pickle.loads(pickle.dumps(camera.design))
    assert design == camera.design and copy.copy(design) == design
    # A design with an open size has an open size after pickling, too.
    free = pickle.loads(pickle.dumps(fv.Design("steady")))
    assert fv.Camera(free).step(frames[0]).active.shape == (8, 11)
    with pytest.raises(TypeError, match="cannot be pickled"):
        pickle.dumps(camera.step(frames[1]))


@pytest.mark.parametrize("threads", [-1, 257, 1000000, 10**30, np.int64(-4)])
def test_threads_have_a_range(threads):
    with pytest.raises(ValueError, match=f"threads = {re.escape(repr(threads))}: expected 1 to 256, or 0, which takes one per processor"):
        fv.Camera(threads=threads)


def test_threads_are_a_whole_number():
    for threads in ("2", 1.5, None, [1]):
        with pytest.raises(TypeError, match=f"threads = {re.escape(repr(threads))}: expected 1 to 256, or 0"):
            fv.Camera(threads=threads)
    for threads in (0, 256, np.uint8(3)):
        assert fv.Camera(threads=threads).step(np.zeros((8, 8), np.uint8)).number == 0
    copy, arguments = fv.Camera(threads=3).__reduce__()
    with pytest.raises(ValueError, match="threads = 4000"):
        copy(arguments[0], 4000)


def test_threads_change_no_bit():
    chance = np.random.default_rng(5)
    clip = chance.integers(0, 256, (3, 400, 600), np.uint8)
    one, four = fv.Camera("seamless"), fv.Camera("seamless", threads=4)
    for frame in clip:
        assert equal(one.step(frame), four.step(frame))


def test_everything_shows_itself(frames):
    camera = fv.Camera(region={"size": 16})
    assert repr(camera).startswith("<foveate.Camera ") and "0 frames seen" in repr(camera)
    outcome = camera.step(frames[0])
    assert repr(outcome) == "<foveate.Outcome of frame 0: 24 of 6x4 regions active>"
    assert "6 x 4 = 24" in camera._repr_html_() and camera.design.fingerprint in camera.design._repr_html_()
    assert outcome._repr_html_().count("data:image/png;base64") == 2
    camera.step(frames[1])
    # The rendered frame is no longer there, but the decisions are.
    assert camera.step(frames[2])._repr_html_().count("rendered") == 2
    late = camera.step(frames[3])
    camera.step(frames[4])
    assert late._repr_html_().count("rendered") == 0 and "active green" in late._repr_html_()
    run = fv.simulate("scene:street", max_frames=2)
    assert repr(run).startswith("<foveate.Run of 2 frames")
    assert next(run)._repr_html_().count("data:image/png") == 3


def test_the_range_of_luma_is_an_option(tmp_path):
    pixels = np.where(np.indices((16, 16))[1] % 4 < 2, 16, 40).astype(np.uint8)
    frame = b"FRAME\n" + pixels.tobytes() + bytes(128)
    (tmp_path / "a.y4m").write_bytes(b"YUV4MPEG2 W16 H16 F25:1 C420 XCOLORRANGE=LIMITED\n" + 2 * frame)
    # The gradients are 96 as the luma was coded, and 112 in the full range; the threshold is 100.
    for luma, relevant in [(None, False), ("coded", False), ("full", True)]:
        outcomes = list(fv.simulate(tmp_path / "a.y4m", "bare", luma=luma))
        assert len(outcomes) == 2 and all(outcome.srs.all() == relevant for outcome in outcomes)
        assert all(outcome.srs.any() == relevant for outcome in outcomes)


def test_footage_that_cannot_be_read_is_refused_as_on_the_command_line(tmp_path):
    with pytest.raises(FileNotFoundError, match="input `nothing.mp4` does not exist; check the path"):
        fv.simulate("nothing.mp4")
    (tmp_path / "text.mp4").write_text("no video")
    with pytest.raises(ValueError, match="text.mp4"):
        fv.simulate(tmp_path / "text.mp4")
    with pytest.raises(ValueError, match="unknown scene|scene"):
        fv.simulate("scene:moon")
    with pytest.raises(TypeError, match=r"or frames, which are an array of shape \(frames, height, width\)"):
        fv.simulate(np.zeros((4, 4), np.uint8))
    for options, message in [
        ({"max_frames": 0}, "max_frames = 0"),
        ({"resize": (0, 5)}, "resize"),
        ({"crop": (4, 4)}, "crop"),
        ({"start": "soon"}, "start = soon"),
        ({"images": "many"}, "images = many"),
        ({"luma": "wide"}, "luma = wide"),
    ]:
        with pytest.raises(ValueError, match=message):
            fv.simulate("scene:street", **options)
    with pytest.raises(TypeError, match="simulate has no option frame_count; its options are max_frames"):
        fv.simulate("scene:street", frame_count=3)
    with pytest.raises(IndexError):
        fv.explain("scene:street", frame=0, region=(99, 0))
    with pytest.raises(ValueError, match="no outcomes"):
        fv.events([])
    with pytest.raises(TypeError, match="made of outcomes"):
        fv.events([3])
    with pytest.raises(ValueError, match="two designs"):
        fv.events([*fv.simulate("scene:street", max_frames=1), *fv.simulate("scene:street", "mad", max_frames=1)])


def test_a_file_that_is_skipped_is_told(tmp_path):
    for number in range(2):
        (tmp_path / f"{number}.pgm").write_bytes(b"P5 8 8 255\n" + bytes([number]) * 64)
    assert len(list(fv.simulate(tmp_path))) == 2
    (tmp_path / "2.tif").write_bytes(b"II*\0" + bytes(8))
    with pytest.warns(UserWarning, match="2.tif` is skipped: images of the type TIFF are not read"):
        run = fv.simulate(tmp_path)
    assert len(list(run)) == 2


def test_a_damaged_video_gives_what_there_is_and_warns(frames, tmp_path):
    path = tmp_path / "clip.y4m"
    header = b"YUV4MPEG2 W83 H60 F30:1 Cmono\n"
    whole = header + b"".join(b"FRAME\n" + frame.tobytes() for frame in frames)
    path.write_bytes(whole[:-100])
    run = fv.simulate(path)
    with pytest.warns(UserWarning, match="clip.y4m"):
        outcomes = list(run)
    assert len(outcomes) == len(frames) - 1 and run.problem


def test_zones_are_an_array_of_codes():
    frames = np.random.default_rng(3).integers(0, 256, (4, 24, 32), "uint8")
    plain, camera = fv.Camera(frame={"width": 32, "height": 24}), fv.Camera(frame={"width": 32, "height": 24}, zones={})
    assert plain.zones is None and camera.zones.shape == (3, 4) and not camera.zones.any()
    zones = np.zeros((3, 4), int)
    zones[0], zones[2, 1] = 1, 3
    camera.zones = zones
    assert camera.zones.dtype == np.uint8 and (camera.zones == zones).all()
    for frame in frames:
        expected, outcome = plain.step(frame), camera.step(frame)
        assert not outcome.srs[0].any() and outcome.srs[2, 1]
        assert (outcome.srs[1] == expected.srs[1]).all() and (outcome.changed == expected.changed).all()
    camera.reset()
    assert (camera.zones == zones).all()
    camera.zones = zones.tolist()
    with pytest.raises(ValueError, match=r"shape \(3, 4\).*not of shape \(4, 3\)"):
        camera.zones = zones.T
    with pytest.raises(ValueError, match="4 is no class"):
        camera.zones = zones + 3
    with pytest.raises(TypeError, match="float64"):
        camera.zones = zones * 1.0
    with pytest.raises(ValueError, match="zones={}"):
        plain.zones = zones
    with pytest.raises(ValueError, match="no size yet"):
        fv.Camera(zones={}).zones = zones


def test_zones_of_a_configuration_are_those_of_its_areas():
    keen = {"spatial": [{"feature": "edge", "min_score": 1}], "temporal": {"level": 2}}
    areas = [{"class": "off", "rectangle": [0, 0, 32, 8]}, {"class": "keen", "polygon": [[16, 8], [32, 8], [32, 24], [16, 24]]}]
    camera = fv.Camera(frame={"width": 32, "height": 24}, zones={"areas": areas, "keen": keen})
    assert camera.zones.tolist() == [[1, 1, 1, 1], [0, 0, 2, 2], [0, 0, 2, 2]]
    assert fv.Camera(camera.design).zones.tolist() == camera.zones.tolist()
    assert pickle.loads(pickle.dumps(camera)).zones.tolist() == camera.zones.tolist()


@pytest.mark.parametrize("size", [{"frame": {"width": 32, "height": 24}}, {}])
def test_a_copy_has_the_zones_that_were_set(size):
    frame = np.random.default_rng(4).integers(0, 256, (24, 32), "uint8")
    camera = fv.Camera(**size, zones={})
    camera.step(frame)
    camera.reset()
    camera.zones = np.arange(12).reshape(3, 4) % 4
    camera.zones = camera.zones[:, ::-1]
    for made in (copy.copy(camera), copy.deepcopy(camera), pickle.loads(pickle.dumps(camera))):
        assert (made.zones == camera.zones).all() and made.design == camera.design
        outcome = made.step(frame, keep=True)
        camera.reset()
        # The packets carry the version of the map.
        assert outcome.packets() == camera.step(frame, keep=True).packets()
        made.reset()
        camera.reset()
        assert (made.zones == camera.zones).all()


def test_a_frame_of_a_wrong_type_changes_nothing():
    camera = fv.Camera(frame={"pixel_bits": 6}, zones={})
    camera.step(np.zeros((16, 16), "uint8"))
    camera.zones = np.ones((2, 2), int)
    camera.reset()
    with pytest.raises(TypeError, match="uint16"):
        camera.step(np.zeros((24, 24), "uint16"))
    assert (camera.zones == 1).all() and camera.zones.shape == (2, 2)


def test_a_map_stays_in_the_folder_of_its_file_beside_other_keys(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    (tmp_path / "designs").mkdir()
    pixels = bytes([1, 0, 0, 2])
    (tmp_path / "designs" / "map.pgm").write_bytes(b"P5 2 2 255\n" + pixels)
    (tmp_path / "map.pgm").write_bytes(b"P5 2 2 255\n" + bytes([3] * 4))
    (tmp_path / "designs" / "camera.toml").write_text("frame = { width = 16, height = 16 }\nzones = { map = \"map.pgm\" }\n")
    for zones in ({"keen": {"temporal": {"level": 2}}}, {}, None):
        assert fv.Camera("designs/camera.toml", zones=zones).zones.ravel().tolist() == list(pixels)
    assert (fv.Camera("designs/camera.toml", zones={"map": "map.pgm"}).zones == 3).all()
    with pytest.raises(ValueError, match="zones.map.*zones.classes.*leave one"):
        fv.Camera("designs/camera.toml", zones={"classes": ["00", "00"]})
