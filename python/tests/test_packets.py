# SPDX-License-Identifier: MIT OR Apache-2.0
"""Packets of outcomes are those of the command line, and are decoded as on the command line."""
import csv

import numpy as np
import pytest

import foveate as fv
from conftest import equal

DESIGNS = {
    "paper": ("paper", {}, []),
    "ragged": ("paper", {"region": {"size": 24}}, ["--set", "region.size=24"]),
    "raw": ("paper", {"region": {"size": 24}, "render": {"payload": "raw"}}, ["--set", "region.size=24", "--set", "render.payload=raw"]),
    "summaries": ("fovea", {}, []),
    "deep": ("mad", {"frame": {"pixel_bits": 12}}, ["--set", "frame.pixel_bits=12"]),
    "flow": ("serial", {"spatial": ["edge", {"feature": "flow", "radius": 2}]}, ["--set", "spatial=[{feature='edge'},{feature='flow',radius=2}]"]),
}


def table(path):
    with open(path, newline="") as file:
        return list(csv.DictReader(file))


@pytest.mark.parametrize("scores", [False, True])
@pytest.mark.parametrize("name", DESIGNS)
def test_packets_and_counts_are_those_of_simulate(name, scores, command, tmp_path):
    preset, keys, words = DESIGNS[name]
    packets = "--packets=scores" if scores else "--packets"
    files = ["-o", tmp_path / "out", packets, "--rendered", "none", "--quiet"]
    command("simulate", "scene:street", "-p", preset, *words, "--frames", 5, *files)
    outcomes = list(fv.simulate("scene:street", fv.Camera(preset, **keys), max_frames=5))
    packets = [outcome.packets(scores=scores) for outcome in outcomes]
    assert b"".join(packets) == (tmp_path / "out/packets.bin").read_bytes()
    rows = table(tmp_path / "out/frames.csv")
    assert [outcome.sent_pixels for outcome in outcomes] == [int(row["pixels_forwarded"]) for row in rows]
    assert [outcome.sent_bytes for outcome in outcomes] == [len(outcome.packets()) for outcome in outcomes]
    assert all(outcome.sent_pixels > 0 for outcome in outcomes)


@pytest.mark.parametrize("name", DESIGNS)
def test_steps_send_what_a_run_sends(name):
    preset, keys, _ = DESIGNS[name]
    camera, kept = fv.Camera(preset, **keys), fv.Camera(preset, **keys)
    late = []
    for outcome in fv.simulate("scene:street", camera, max_frames=4):
        step = camera.step(outcome.frame, time_us=outcome.time_us)
        assert step.packets() == outcome.packets() and step.packets(scores=True) == outcome.packets(scores=True)
        late.append((kept.step(outcome.frame, time_us=outcome.time_us, keep=True), outcome))
    assert all(step.packets() == outcome.packets() for step, outcome in late)


def test_packets_of_a_step_are_read_before_the_next(frames):
    camera = fv.Camera()
    first, read = camera.step(frames[0]), fv.Camera().step(frames[0]).packets()
    assert first.packets() == read
    second = camera.step(frames[1])
    # The packets of the first outcome were read in time.
    assert first.packets(scores=True) and first.packets() == read
    camera.step(frames[2])
    with pytest.raises(RuntimeError, match=r"pixels are gone, because .*read outcome.packets\(\) before the next step, or keep it"):
        second.packets()
    assert second.sent_bytes > 0 and second.sent_pixels > 0


@pytest.mark.parametrize("scores", [False, True])
@pytest.mark.parametrize("name", DESIGNS)
def test_decoded_frames_are_those_that_were_sent(name, scores):
    preset, keys, _ = DESIGNS[name]
    camera = fv.Camera(preset, **keys)
    outcomes = list(fv.simulate("scene:street", camera, max_frames=5))
    decoding = fv.decode(b"".join(outcome.packets(scores=scores) for outcome in outcomes), camera)
    assert decoding.design is None
    decoded = list(decoding)
    assert decoding.losses == () and decoding.design == outcomes[0].design and len(decoded) == 5
    for frame, outcome in zip(decoded, outcomes, strict=True):
        for attribute in ("number", "time_us"):
            assert getattr(frame, attribute) == getattr(outcome, attribute)
        for attribute in ("srs", "trs", "active", "action", "rendered"):
            assert np.array_equal(getattr(frame, attribute), getattr(outcome, attribute)), attribute
        assert frame.rendered.dtype == outcome.rendered.dtype and frame.srs is frame.srs
        assert np.array_equal(frame.displacements, outcome.displacements) and frame.losses == ()
        assert (frame.scores is None) == (frame.changed is None) == (not scores)
        assert not scores or equal(frame, outcome)


def test_all_kinds_of_bytes_are_decoded(frames):
    camera = fv.Camera()
    data = camera.step(frames[0]).packets()
    for given in (bytearray(data), memoryview(data), np.frombuffer(data, np.uint8)):
        (frame,) = fv.decode(given, camera)
        assert frame.number == 0
    assert list(fv.decode(b"", camera)) == []
    for wrong, message in [("packets.bin", "not str; read the file"), (3, "not int"), (None, "not NoneType"), ([1, 2], "not list")]:
        with pytest.raises(TypeError, match=f"packets are bytes, {message}"):
            fv.decode(wrong, camera)


@pytest.mark.parametrize("seed", range(4))
def test_damage_is_reported_as_decode_reports_it(seed, command, tmp_path):
    camera, chance = fv.Camera("paper", region={"size": 16}), np.random.default_rng(seed)
    outcomes = list(fv.simulate("scene:street", camera, max_frames=8))
    stream = bytearray(b"".join(outcome.packets(scores=seed % 2 == 1) for outcome in outcomes))
    for start in chance.integers(0, len(stream) - 200, 3):
        stream[start : start + 90] = chance.bytes(90) if seed < 2 else b""
    # Another camera sends in between.
    stream += fv.Camera("paper").step(outcomes[0].frame).packets() + outcomes[1].packets()
    (tmp_path / "packets.bin").write_bytes(stream)
    with pytest.raises(Exception, match="non-zero exit status 1"):
        command("decode", tmp_path / "packets.bin", "-p", "paper", "--set", "region.size=16", "-o", tmp_path / "out", "--quiet")
    decoding = fv.decode(bytes(stream), camera)
    decoded = list(decoding)
    names = ("kind", "frame", "row", "column", "amount", "offset")
    losses = [["" if value is None else str(value) for value in loss[:6]] for loss in decoding.losses]
    assert losses == [list(row.values()) for row in table(tmp_path / "out/losses.csv")] and losses
    assert decoding.losses[0]._fields == (*names, "text") and str(decoding.losses[0]) == decoding.losses[0].text
    shown = [frame for frame in decoded if frame.time_us is not None]
    assert [str(frame.time_us) for frame in shown] == [row["t_us"] for row in table(tmp_path / "out/frames.csv")]
    assert np.array_equal([frame.active for frame in shown], np.load(tmp_path / "out/active.npy"))
    before_the_end = [loss for frame in decoded for loss in frame.losses]
    assert before_the_end == list(decoding.losses)[: len(before_the_end)]


def test_bytes_that_are_no_packets_are_a_loss():
    decoding = fv.decode(bytes(1000), "paper")
    assert list(decoding) == [] and sum(loss.amount for loss in decoding.losses) == 1000
    assert {loss.kind for loss in decoding.losses} == {"bytes"}


def test_the_stream_of_another_camera_is_refused(frames):
    packets = fv.Camera("paper").step(frames[0]).packets()
    with pytest.raises(ValueError, match="camera|design|fingerprint"):
        list(fv.decode(packets, fv.Camera("paper", region={"size": 16})))


def test_images_of_a_set_are_first_frames(command, tmp_path):
    chance = np.random.default_rng(2)
    (tmp_path / "set").mkdir()
    for number in range(3):
        (tmp_path / f"set/{number}.pgm").write_bytes(b"P5 8 8 255\n" + chance.bytes(64))
    files = ["-o", tmp_path / "out", "--packets", "--rendered", "none", "--quiet"]
    command("simulate", tmp_path / "set", "--images", "set", *files)
    outcomes = list(fv.simulate(tmp_path / "set", images="set"))
    packets = b"".join(outcome.packets() for outcome in outcomes)
    assert len(outcomes) == 3 and packets == (tmp_path / "out/packets.bin").read_bytes()
    for frame, outcome in zip(fv.decode(packets, "paper"), outcomes, strict=True):
        assert np.array_equal(frame.rendered, outcome.rendered)


def test_packets_have_the_version_of_the_map():
    chance = np.random.default_rng(3)
    camera = fv.Camera(frame={"width": 32, "height": 24}, zones={})
    first = camera.step(chance.integers(0, 256, (24, 32), "uint8"), keep=True)
    camera.zones = np.ones((3, 4), int)
    second = camera.step(chance.integers(0, 256, (24, 32), "uint8"))
    assert second.sent_pixels == 0
    assert [frame.map_version for frame in fv.decode(first.packets() + second.packets(), camera)] == [0, 1]
    # A camera without zones has no map.
    (plain,) = fv.decode(fv.Camera().step(np.zeros((8, 8), np.uint8)).packets())
    assert plain.map_version is None
