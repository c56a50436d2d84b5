# SPDX-License-Identifier: MIT OR Apache-2.0
"""The results of the package and of the command line are equal, bit by bit."""
import json
import os
import struct

import numpy as np
import pandas
import pyarrow.parquet
import pytest
from PIL import Image

import foveate as fv
from conftest import ROOT

DESIGNS = {
    "paper": ({}, []),
    "seamless": ({"region": {"size": 5}}, ["--set", "region.size=5"]),
    "steady": ({"spatial": ["edge", "mad"]}, ["--set", "spatial=[{feature='edge'},{feature='mad'}]"]),
    "mad": ({"frame": {"pixel_bits": 12}}, ["--set", "frame.pixel_bits=12"]),
    "serial": ({"spatial": ["edge", {"feature": "flow", "radius": 2}]}, ["--set", "spatial=[{feature='edge'},{feature='flow',radius=2}]"]),
}


@pytest.mark.parametrize("preset", DESIGNS)
def test_a_run_equals_simulate(preset, command, tmp_path):
    keys, words = DESIGNS[preset]
    tables = ["--events", "parquet", "--rendered", "png"]
    command("simulate", "scene:street", "-p", preset, *words, "-o", tmp_path / "out", "--frames", 5, *tables, "--quiet")
    outcomes = list(fv.simulate("scene:street", fv.Camera(preset, **keys), max_frames=5))
    assert len(outcomes) == 5
    arrays = {"srs": "srs", "trs": "trs", "active": "active", "t_count": "changed"}
    for file, name in arrays.items():
        assert np.array_equal(np.load(tmp_path / f"out/{file}.npy"), [getattr(one, name) for one in outcomes]), name
    for feature in outcomes[0].scores:
        assert np.array_equal(np.load(tmp_path / f"out/score_{feature}.npy"), [one.scores[feature] for one in outcomes])
    file = tmp_path / "out/flow.npy"
    assert file.exists() == (preset == "serial") == (outcomes[0].displacements is not None)
    if file.exists():
        displacements = np.load(file)
        assert np.array_equal(displacements, [one.displacements for one in outcomes]) and displacements.dtype == np.int8
        assert displacements.min() == -2 and displacements.max() == 2
    bits = outcomes[0].design.pixel_bits
    for number, outcome in enumerate(outcomes):
        picture = np.asarray(Image.open(tmp_path / f"out/rendered/{number:06}.png")).astype(int)
        assert np.array_equal(picture if bits == 8 else picture >> (16 - bits), outcome.rendered)
    summary = json.loads((tmp_path / "out/summary.json").read_text())
    assert summary["design_fingerprint"] == outcomes[0].design.fingerprint


@pytest.mark.parametrize(("only_active", "preset"), [(False, "paper"), (True, "paper"), (False, "serial")])
def test_tables_equal_those_of_simulate(only_active, preset, command, tmp_path):
    keys, words = DESIGNS[preset]
    only = [*words, "--only", "active"] if only_active else words
    files = ["-o", tmp_path / "out", "--events", "parquet", "--rendered", "none"]
    command("simulate", "scene:street", "-p", preset, *files, "--frames", 4, *only, "--quiet")
    written = pyarrow.parquet.read_table(tmp_path / "out/events.parquet")
    outcomes = list(fv.simulate("scene:street", fv.Camera(preset, **keys), max_frames=4))
    arrow = fv.events(outcomes, only_active=only_active, kind="pyarrow")
    assert arrow.to_pydict() == written.to_pydict()
    assert [field.type for field in arrow.schema] == [field.type for field in written.schema]
    frame = fv.events(iter(outcomes), only_active=only_active, kind="pandas")
    pandas.testing.assert_frame_equal(frame.astype({"action": str}), written.to_pandas().astype({"action": str}))
    table = fv.events(outcomes, only_active=only_active)
    assert table.dtype.names == tuple(written.column_names)
    assert ("dx" in table.dtype.names) == ("dy" in table.dtype.names) == (preset == "serial")
    assert table.tolist() == [tuple(row.values()) for row in written.to_pylist()]


def test_steps_on_arrays_equal_a_run_over_their_pictures(frames, command, tmp_path):
    for number, frame in enumerate(frames):
        Image.fromarray(frame).save(tmp_path / f"{number:03}.png")
    camera = fv.Camera("steady")
    run = fv.simulate(str(tmp_path / "*.png"), camera)
    assert run.total == len(frames)
    for frame, seen in zip(frames, run, strict=True):
        outcome = camera.step(frame)
        assert np.array_equal(seen.frame, frame)
        assert np.array_equal(outcome.rendered, seen.rendered)
        assert np.array_equal(outcome.changed, seen.changed)
        assert (outcome.number, outcome.time_us, seen.name) == (seen.number, seen.time_us, str(tmp_path / f"{seen.number:03}.png"))
    assert run.problem is None and next(run, None) is None


@pytest.mark.skipif("FOVEATE_WHOLE" not in os.environ, reason="a design is synthesized; scripts/release.sh python runs it")
def test_explain_fidelity_estimate_and_check_are_those_of_the_command_line(command, tmp_path):
    words = ["scene:street", "--frame", 2, "--region", "3,4"]
    explanation = fv.explain("scene:street", "paper", frame=2, region=(3, 4))
    assert explanation == json.loads(command("explain", *words, "--json"))
    assert str(explanation) == command("explain", *words)
    design = fv.Design("bare", region={"size": 4}, frame={"width": 8, "height": 8})
    estimate = design.estimate()
    small = ["-p", "bare", "--set", "region.size=4", "--set", "frame.width=8", "--set", "frame.height=8"]
    assert estimate == json.loads(command("estimate", *small, "--json"))
    assert "LUT" in str(estimate)
    checked = json.loads(command("check", *small, "--json"))
    assert checked["fingerprint"] == design.fingerprint


def test_fidelity_is_that_of_explore(command, tmp_path):
    (tmp_path / "space.toml").write_text("[vary]\n\"region.size\" = [8, 16]\n")
    command("explore", tmp_path / "space.toml", "scene:street", "-o", tmp_path / "out", "--frames", 6, "--no-area", "--quiet")
    points = pandas.read_csv(tmp_path / "out/points.csv")
    assert len(points) == 2
    for size, flips in zip(points["region.size"], points["action_flips"], strict=True):
        found = fv.fidelity("scene:street", {"region": {"size": int(size)}}, ideal="paper", max_frames=6)
        assert found["action_flips"] == pytest.approx(flips, abs=1e-12)
        assert found.problem is None


def test_a_generated_core_is_that_of_the_command_line(command, tmp_path):
    command("generate", "-p", "bare", "--set", "region.size=4", "-o", tmp_path / "one", "--quiet")
    camera = fv.Camera("bare", region={"size": 4}, frame={"width": 224, "height": 224})
    files = camera.generate(tmp_path / "other")
    names = sorted(path.relative_to(tmp_path / "one") for path in (tmp_path / "one").rglob("*") if path.is_file())
    assert sorted(path.relative_to(tmp_path / "other") for path in files) == [name for name in names if name.name != ".foveate"]
    for name in names:
        assert (tmp_path / "one" / name).read_bytes() == (tmp_path / "other" / name).read_bytes()
    with pytest.raises(FileExistsError, match="is not empty.*force=True"):
        fv.generate(camera, tmp_path / "other")
    assert camera.generate(tmp_path / "other", force=True) == files


def test_a_network_behind_the_camera(command, tmp_path):
    network = ROOT / "networks/denoiser.onnx"
    words = ["infer", network, "scene:street", "-o", tmp_path / "out", "--frames", 3, "--mode", "truncate=0.02", "--outputs", "npy"]
    written = json.loads(command(*words, "--json", "--quiet"))
    found = fv.infer(network, "scene:street", max_frames=3, mode="truncate=0.02")
    assert found.summary["macs"] == written["macs"]
    assert found.summary["error"]["psnr"] == written["error"]["psnr"] and found.summary["error"]["different_frames"] == 2
    (name, output), = found.outputs.items()
    (file,) = (tmp_path / "out").rglob("*.npy")
    assert np.array_equal(output, np.load(file)) and len(output) == 3, name
    assert len(found.table("layers")) == len(pandas.read_csv(tmp_path / "out/layers.csv"))
    folder = found.folder
    assert (folder / "report.html").is_file()
    del found, output
    assert not folder.exists()
    with pytest.raises(ValueError, match="mode = \"sparse\": expected dense, exact"):
        fv.infer(network, "scene:street", mode="sparse")


def test_a_network_takes_arrays_as_it_takes_footage(frames, tmp_path):
    network = ROOT / "networks/denoiser.onnx"
    path = tmp_path / "clip.y4m"
    path.write_bytes(b"YUV4MPEG2 W83 H60 F30:1 Cmono\n" + b"".join(b"FRAME\n" + frame.tobytes() for frame in frames))
    options = {"max_frames": 7, "resize": (48, 40), "reference": True}
    expected = fv.infer(network, path, "steady", **options)
    for given in (frames, list(frames), tuple(frames), np.asfortranarray(frames)):
        found = fv.infer(network, given, "steady", **options)
        for name, output in expected.outputs.items():
            assert np.array_equal(found.outputs[name], output) and len(output) == 7, name
        assert found.summary["macs"] == expected.summary["macs"] and found.summary["inputs"] == ["array"]
    # Each image of a set is a first frame.
    every = fv.infer(network, frames[:3], images="set")
    assert all(np.array_equal(part[1], fv.infer(network, frames[1:2], images="set").outputs[name][0]) for name, part in every.outputs.items())
    found = fv.infer(network, frames[:2].astype(np.uint16) << 4, {"frame": {"pixel_bits": 12}})
    assert found.summary["frames"] == 2


@pytest.mark.parametrize(("inputs", "error", "message"), [
    (np.zeros((8, 8), np.uint8), TypeError, r"infer takes footage.* or frames.*\(frames, height, width\).*; not a ndarray of arrays of shape \(8,\)"),
    (np.zeros((2, 8, 8, 3), np.uint8), TypeError, r"arrays of shape \(8, 8, 3\)"),
    (np.zeros((2, 8, 8)), TypeError, "a frame has dtype uint8, or uint16 above 8 bits per pixel, not float64"),
    (np.zeros((2, 8, 8), np.uint16), TypeError, "dtype uint16, but the design has 8 bits"),
    ([np.zeros((8, 8), np.uint8), np.zeros((8, 9), np.uint8)], ValueError, r"array\[1\].*9x8|9x8"),
    (np.zeros((0, 8, 8), np.uint8), ValueError, "array holds no frame; at least one is needed"),
    ([], ValueError, "array holds no frame; at least one is needed"),
    (3, TypeError, "infer takes footage.*not int"),
])
def test_what_is_no_footage_is_refused_with_what_would_be_right(inputs, error, message):
    with pytest.raises(error, match=message):
        fv.infer(ROOT / "networks/denoiser.onnx", inputs)


def test_options_of_a_network_are_named_with_the_nearest():
    options = "network, inputs, camera, output, mode, tune, reference, accelerator, mean, scale, pictures, force, framing"
    options += ", whole_frames, noise, every, detect, boxes, max_frames"
    for wrong, meant in [("referense", ", but reference"), ("max_frame", ", but max_frames"), ("picture", ", but pictures"), ("zzz", "")]:
        with pytest.raises(TypeError, match=f"infer has no option {wrong}{meant}; its options are {options}, "):
            fv.infer(ROOT / "networks/denoiser.onnx", "scene:street", **{wrong: True})
    with pytest.raises(TypeError, match="fidelity has no option ideel, but ideal; its options are ideal, max_frames"):
        fv.fidelity("scene:street", ideel="paper")


def idx_set(folder):
    """Makes a labelled set of 12 images in IDX files."""
    chance = np.random.default_rng(3)
    images, labels = chance.integers(0, 256, (12, 28, 28), np.uint8), np.arange(12, dtype=np.uint8)
    images[:, :12] = 0
    for name, kind, array in [("images-idx3", 3, images), ("labels-idx1", 1, labels)]:
        header = struct.pack(f">BBBB{kind}I", 0, 0, 8, kind, *array.shape)
        (folder / f"train-{name}-ubyte").write_bytes(header + array.tobytes())
    return images, labels


def test_images_of_a_set_are_first_frames(command, tmp_path):
    images, labels = idx_set(tmp_path)
    command("simulate", tmp_path / "train-images-idx3-ubyte", "-o", tmp_path / "out", "--quiet")
    seen = list(fv.simulate(tmp_path / "train-images-idx3-ubyte"))
    assert [outcome.label for outcome in seen] == [str(label) for label in labels]
    for image, outcome, active in zip(images, seen, np.load(tmp_path / "out/active.npy"), strict=True):
        assert outcome.trs.all() and np.array_equal(outcome.active, active) and np.array_equal(outcome.frame, image)


def test_a_data_set_of_torch_equals_dataset(command, tmp_path):
    torch = pytest.importorskip("torch")
    from foveate.torch import RegionDataset

    images, labels = idx_set(tmp_path)
    command("dataset", tmp_path / "train-images-idx3-ubyte", "-o", tmp_path / "out", "--quiet")
    raw = (tmp_path / "out/train-images-idx3-ubyte").read_bytes()
    made = np.frombuffer(raw, np.uint8, offset=16).reshape(images.shape)
    pairs = list(zip(images, labels.tolist(), strict=True))
    for given in (pairs, [(Image.fromarray(one), label) for one, label in pairs], [(torch.from_numpy(one), label) for one, label in pairs]):
        regions = RegionDataset(given, fv.Camera(), tags=True)
        assert len(regions) == 12
        for number in range(12):
            image, tags, target = regions[number]
            assert np.array_equal(np.asarray(image), made[number]) and target == number
            assert np.array_equal(tags, np.load(tmp_path / "out/active.npy")[number])
            assert type(image) is type(given[number][0])
