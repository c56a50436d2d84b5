# SPDX-License-Identifier: MIT OR Apache-2.0
"""Tests of the studies, on small sets that are made here."""
from __future__ import annotations

import gzip
import json
import os
from fractions import Fraction
from math import comb
from pathlib import Path
from typing import Any

import numpy as np
import pytest

torch = pytest.importorskip("torch")
pytest.importorskip("matplotlib")

from foveate.studies import accuracy, statistics, tables, training  # noqa: E402
from foveate.studies.__main__ import main  # noqa: E402
from foveate.studies.cameras import Regions, render_screens  # noqa: E402
from foveate.studies.data import StudyError, read, read_idx, write_idx  # noqa: E402
from foveate.studies.models import lenet5  # noqa: E402
from foveate.studies.runs import Result, Run, RunFolder, Settings, complete, write_whole  # noqa: E402

SMALL = ["--epochs", "1", "--validation", "100", "--limit", "0.5"]
ACCURACY = [*SMALL, "--seeds", "2", "--figure-seeds", "1", "--thresholds", "1", "12"]


def make_half(count: int, seed: int) -> tuple[np.ndarray, np.ndarray]:
    """Makes images whose class is the place of a bright square, so that one epoch is enough to learn it."""
    draws = np.random.default_rng(seed)
    labels = draws.integers(0, 10, count).astype(np.uint8)
    images = draws.integers(0, 40, (count, 28, 28)).astype(np.uint8)
    for image, label in zip(images, labels, strict=True):
        x, y = 2 + 5 * (label % 5), 4 + 12 * (label // 5)
        image[y:y + 6, x:x + 5] = 250
    return images, labels


@pytest.fixture(scope="module")
def sets(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Makes one plain set, and one in torchvision's folders, gzipped."""
    folder = tmp_path_factory.mktemp("sets")
    for place, count, packed in (("mnist", 1200, False), ("FashionMNIST/raw", 700, True)):
        home = folder / place
        home.mkdir(parents=True)
        for name, images, seed in (("train", count, 1), ("t10k", 200, 2)):
            for kind, array in zip(("images-idx3", "labels-idx1"), make_half(images, seed), strict=True):
                path = home / f"{name}-{kind}-ubyte"
                write_idx(path, array)
                if packed:
                    path.with_name(path.name + ".gz").write_bytes(gzip.compress(path.read_bytes()))
                    path.unlink()
    return folder


@pytest.fixture(scope="module")
def finished_study(sets: Path, tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Runs the small study of accuracy once."""
    folder = tmp_path_factory.mktemp("accuracy") / "out"
    assert main(["accuracy", "-o", str(folder), "--data", str(sets), *ACCURACY]) == 0
    return folder


def read_files(folder: Path) -> dict[str, bytes]:
    return {str(path.relative_to(folder)): path.read_bytes() for path in sorted(folder.rglob("*")) if path.is_file()}


def test_a_study_writes_its_runs_tables_and_figure(finished_study: Path) -> None:
    names = read_files(finished_study)
    assert {"accuracy.csv", "accuracy.json", "accuracy.md", "accuracy.svg", "accuracy.png"} <= set(names)
    assert not [name for name in names if Path(name).name.startswith(".")]
    assert "Intervals cover seeds and images, not other training recipes" in names["accuracy.md"].decode()
    summary = json.loads(names["accuracy.json"])
    for entry in summary["sets"]:
        # Half of the images that are not used for validation, and half of the test images.
        assert entry["train_images"] == {"mnist": 550, "fashion-mnist": 300}[entry["set"]] and entry["test_images"] == 100
        assert [row["tested"] for row in entry["figure"]] == ["n8-edge1", "n8-edge1", "n8-edge12", "n8-edge12"]
        for row in entry["figure"]:
            assert row["difference"]["mean"] == pytest.approx(row["accuracy"]["mean"] - entry["figure_original"])
        assert entry["figure"][0]["sent_share"] >= entry["figure"][2]["sent_share"]
        for row in entry["table"]:
            assert row["seeds"] == 2 and len(row["tests"]) == 2
            assert row["difference"]["mean"] == pytest.approx(row["accuracy"]["mean"] - entry["original"]["mean"])
    rows = names["accuracy.csv"].decode().splitlines()
    runs = [name for name in names if name.endswith(".json") and "runs" in name]
    assert len(rows) - 1 == len(runs)


def test_a_second_start_makes_nothing_again(finished_study: Path, sets: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    before = read_files(finished_study)

    def never(*_: Any) -> None:
        raise AssertionError("a run was made again")

    with monkeypatch.context() as patch:
        patch.setattr(RunFolder, "make", never)
        assert main(["accuracy", "-o", str(finished_study), "--data", str(sets), *ACCURACY]) == 0
    assert read_files(finished_study) == before


def test_the_same_seeds_give_the_same_bytes_in_any_number_of_processes(finished_study: Path, sets: Path, tmp_path: Path) -> None:
    settings = Settings(epochs=1, validation=100, limit=0.5)
    runs = [Run("mnist", None, None, 0), Run("mnist", Regions(1), Regions(1), 0), Run("mnist", None, Regions(1), 0)]
    complete(RunFolder(tmp_path, sets, settings), runs, jobs=2, report=lambda _: None)
    new_files, study_files = read_files(tmp_path), read_files(finished_study)
    assert len(new_files) == 5
    # Weights are zip files of torch, whose digests are in the results.
    assert {name: text for name, text in new_files.items() if name.endswith(".json")}.items() <= study_files.items()


def test_runs_of_a_seed_are_paired(finished_study: Path) -> None:
    results = [json.loads(path.read_text()) for path in finished_study.glob("runs/mnist*/*.json")]
    initial_weights = {(result["seed"], result["initial_weights"]) for result in results if result["initial_weights"] is not None}
    assert len(initial_weights) == 2 and len({weights for _, weights in initial_weights}) == 2
    trained_weights = {(result["trained"], result["trained_weights"]) for result in results if result["seed"] == 0}
    assert len(trained_weights) == len({trained for trained, _ in trained_weights}) >= 3
    assert torch.equal(training.order(50, 1, 3), training.order(50, 1, 3))
    assert not torch.equal(training.order(50, 1, 3), training.order(50, 2, 3))
    assert sorted(training.order(50, 1, 3).tolist()) == list(range(50))


def test_other_settings_and_other_images_are_other_runs(sets: Path, tmp_path: Path) -> None:
    names = {RunFolder(tmp_path, sets, settings).set_folder("mnist").name
             for settings in (Settings(validation=100), Settings(validation=101), Settings(validation=100, epochs=9))}
    assert len(names) == 3


def test_an_interrupted_run_leaves_nothing(tmp_path: Path) -> None:
    def stopped(path: Path) -> None:
        path.write_text("half")
        raise KeyboardInterrupt

    with pytest.raises(KeyboardInterrupt):
        write_whole(tmp_path / "run.json", stopped)
    assert read_files(tmp_path) == {}


def test_ctrl_c_ends_in_one_line(sets: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]) -> None:
    def stopped(*_: Any) -> None:
        raise KeyboardInterrupt

    monkeypatch.setattr(RunFolder, "make", stopped)
    assert main(["accuracy", "-o", str(tmp_path / "out"), "--data", str(sets), *ACCURACY]) == 130
    assert capsys.readouterr().err.startswith("interrupted: the runs below ")


@pytest.mark.parametrize(("size", "means"), [(7, 0), (8, 2)])
def test_images_are_those_of_the_command_bit_for_bit(size: int, means: int, tmp_path: Path, command: Any) -> None:
    source = tmp_path / "t10k-images-idx3-ubyte"
    # Every image comes twice: the second one must not be a frame without changes.
    write_idx(source, np.repeat(make_half(50, 4)[0], 2, axis=0))
    keys = ["--set", "spatial=[{feature='edge', level=100, min_score=3}]", "--set", "denoise.filter='none'", "--set", f"region.size={size}"]
    keys += ["--set", "render.irrelevant='mean'", "--set", f"periphery.blocks={means}"] if means else []
    command("dataset", source, "-o", tmp_path / "out", *keys)
    screens = render_screens(read_idx(source), Regions(3, size, filter="none", means=means))
    assert np.array_equal(screens.images, read_idx(tmp_path / "out" / source.name))
    command_active = np.load(tmp_path / "out" / "active.npy")
    assert screens.active == pytest.approx(command_active.mean()) and 0 < screens.active < 1
    sent = json.loads((tmp_path / "out" / "summary.json").read_text())["bandwidth"]
    assert screens.sent == sent["region"]["bytes"] / sent["raw"]["bytes"]


def test_bytes_leave_out_padding() -> None:
    """Makes an image of 28 x 28 with one bright corner in the last region, of which 4 x 4 pixels are in the image."""
    images = np.zeros((3, 28, 28), np.uint8)
    images[1, 25:27, 25:27] = 255
    screens = render_screens(images, Regions(1, filter="none"))
    assert screens.active == 1 / 48
    # 3 images of 16 regions have 96 bits.
    assert screens.sent == (16 + 12) / (3 * 784)


def test_quantiles_are_those_of_scipy() -> None:
    known = {1: 12.7062047, 9: 2.2621572, 30: 2.0422725, 31: 2.0395134, 40: 2.0210754, 100: 1.9839715, 10000: 1.9602012}
    for freedom, quantile in known.items():
        assert statistics.t_quantile(freedom) == pytest.approx(quantile, abs=1.2e-4)
    with pytest.raises(ValueError, match="expected 1 or more"):
        statistics.t_quantile(0)


def test_an_interval_worked_out_by_hand() -> None:
    # Standard deviation 1, so half of it is 4.3027 / sqrt(3).
    assert statistics.t_interval([1, 2, 3]) == pytest.approx((2, -0.48416, 4.48416), abs=1e-4)
    mean, low, high = statistics.t_interval([0.5])
    assert mean == 0.5 and np.isnan(low) and np.isnan(high)


def test_mcnemar_is_a_sign_test() -> None:
    assert statistics.mcnemar(1, 9) == 2 * (1 + 10) / 1024
    assert statistics.mcnemar(5, 5) == 1 and statistics.mcnemar(0, 0) == 1
    for first, second in ((40, 60), (13, 2), (700, 800)):
        count = first + second
        tail = sum(comb(count, k) for k in range(min(first, second) + 1))
        assert statistics.mcnemar(first, second) == statistics.mcnemar(second, first) == float(Fraction(2 * tail, 2**count))


def test_a_bootstrap_is_as_wide_as_its_standard_error() -> None:
    generator = np.random.default_rng(3)
    first, second = generator.random((2, 4, 4000)) < 0.9
    low, high = statistics.bootstrap(first, second)
    differences = second.mean(0) - first.mean(0)
    assert (low + high) / 2 == pytest.approx(differences.mean(), abs=5e-4)
    assert high - low == pytest.approx(2 * 1.96 * differences.std() / 4000**0.5, rel=0.1)
    assert statistics.bootstrap(first, first) == (0, 0)


class KnownResults:
    """A folder of runs with known results."""

    def __init__(self, validation: dict[Regions | None, float]) -> None:
        self.validation = validation

    def result(self, run: Run) -> Result:
        # The test accuracy would lead to another choice.
        threshold = 0 if run.trained is None else run.trained.min_score
        return Result({"validation_accuracy": self.validation[run.trained], "test_accuracy": threshold / 100})


@pytest.mark.parametrize(("validation", "chosen"), [([0.99, 0.989, 0.985], 2), ([0.98, 0.98, 0.985], 3), ([0.97, 0.975, 0.974], 2)])
def test_a_threshold_is_chosen_on_validation_images(validation: list[float], chosen: int) -> None:
    cameras = [Regions(threshold) for threshold in (1, 2, 3)]
    run_folder: Any = KnownResults({None: 0.99, **dict(zip(cameras, validation, strict=True))})
    plan = accuracy.Plan(thresholds=(1, 2, 3), seeds=1, figure_seeds=1, margin=0.002)
    assert accuracy._choose_camera(run_folder, "mnist", cameras, plan).min_score == chosen


@pytest.mark.parametrize(("difference", "images", "words"), [
    ((-0.002, -0.005, 0.001), (-0.003, -0.001), "no difference larger than 0.50 points"),
    ((-0.002, -0.003, -0.001), (-0.004, 0.001), "no difference larger than 0.40 points"),
    ((-0.002, -0.003, -0.001), (-0.004, -0.0005), "a loss of 0.20 points, at most 0.40 points"),
    ((0.002, 0.001, 0.003), (0.0005, 0.002), "a gain of 0.20 points, at most 0.30 points"),
])
def test_words_need_both_intervals(difference: tuple[float, ...], images: tuple[float, float], words: str) -> None:
    ends = [abs(end) for end in (*difference[1:], *images)]
    row = {"trained": "n8-edge5", "tested": "n8-edge5", "bootstrap": images, "largest": max(ends),
           "difference": dict(zip(("mean", "low", "high"), difference, strict=True))}
    assert list(tables.verdict({"set": "mnist", "table": [row]})) == [f"mnist, regions, tested on n8-edge5: {words}"]


def test_lenet_has_its_layers() -> None:
    model = lenet5(10)
    # The kernels and biases of the paper of LeNet-5, with a C3 that uses all maps.
    sizes = {"c1": 156, "c3": 2416, "c5": 48120, "f6": 10164, "output": 850}
    assert {name: sum(one.numel() for one in layer.parameters()) for name, layer in model.named_children() if list(layer.parameters())} == sizes


def test_savings_beside_accuracy(finished_study: Path, sets: Path) -> None:
    pytest.importorskip("onnx")
    words = ["savings", "-o", str(finished_study), "--data", str(sets), "--sets", "mnist", *SMALL, "--seeds", "1", "--learned", "1"]
    assert main([*words, "--sizes", "8", "14", "--thresholds", "1", "--images", "4"]) == 0
    rows = json.loads((finished_study / "savings.json").read_text())["rows"]
    means = [f"n8-edge1-unfiltered-means{blocks}" for blocks in (1, 2, 4)]
    assert [row["camera"] for row in rows] == ["n8-edge1", "n14-edge1", "n8-edge1-shared", "n8-edge1-unfiltered", *means]
    for row in rows:
        assert 0 < row["macs_share"] <= 1 and row["regions_difference"] is not None
    assert (finished_study / "savings.svg").read_text().startswith("<?xml")


def test_pictures_and_a_larger_network(tmp_path: Path) -> None:
    pytest.importorskip("torchvision")
    pictures = pytest.importorskip("PIL.Image")
    draws = np.random.default_rng(5)
    for part, count in (("train", 8), ("test", 3)):
        for kind in ("blank", "noise"):
            (tmp_path / part / kind).mkdir(parents=True)
            for number in range(count):
                pixels = draws.integers(0, 256 if kind == "noise" else 20, (40, 50, 3)).astype(np.uint8)
                pictures.fromarray(pixels).save(tmp_path / part / kind / f"{number}.png")
    words = ["accuracy", "-o", str(tmp_path / "out"), "--data", str(tmp_path), "--sets", "pictures", "--model", "resnet18", "--size", "32"]
    assert main([*words, "--epochs", "1", "--validation", "4", "--batch", "6", "--seeds", "1", "--figure-seeds", "1", "--thresholds", "1"]) == 0
    [entry] = json.loads((tmp_path / "out" / "accuracy.json").read_text())["sets"]
    assert (entry["model"], entry["train_images"], entry["test_images"]) == ("resnet18", 12, 6)
    assert main([*words, "--weights", str(tmp_path / "test" / "noise" / "0.png")]) == 1


@pytest.mark.parametrize(("words", "message"), [
    (["--data", "DATA/none"], "error: mnist is not below DATA/none: put its four IDX files"),
    (["--data", "DATA", "--validation", "5000"], "error: --validation 5000: mnist has 1200 training images; expected 1 to 1199"),
    (["--data", "DATA", "--limit", "1.5"], "error: --limit 1.5: expected a share above 0 and up to 1"),
    (["--data", "DATA", "--seeds", "0"], "error: --seeds 0: expected 1 or more"),
    (["--data", "DATA", "--sets", "cifar"], "error: --sets cifar: there is no such set"),
    (["--data", "DATA", "--sets", "pictures", "--size", "32"], "error: DATA: has no folders train and test"),
    (["--data", "DATA", "--validation", "100", "--model", "alexnet", "--size", "28"], "error: --model alexnet: there is no such network"),
    (["--data", "DATA", "--device", "abacus"], "error: --device abacus: torch cannot use it: "),
    (["--data", "DATA", "--validation", "100", "--thresholds", "100"], "error: camera n8-edge100: "),
    (["--data", "DATA", "--validation", "100", "--size", "96"], "error: lenet5 takes images of 28 x 28 pixels"),
])
def test_what_cannot_be_done_is_said_in_one_line(words: list[str], message: str, sets: Path, tmp_path: Path,
                                                  capsys: pytest.CaptureFixture[str]) -> None:
    words = [word.replace("DATA", str(sets)) for word in words]
    assert main(["accuracy", "-o", str(tmp_path / "out"), *words]) == 1
    [line] = capsys.readouterr().err.splitlines()
    assert line.startswith(message.replace("DATA", str(sets)))


def test_damaged_files_are_refused(tmp_path: Path) -> None:
    good, labels = make_half(3, 1)
    write_idx(tmp_path / "good", good)
    assert np.array_equal(read_idx(tmp_path / "good"), good)
    content = (tmp_path / "good").read_bytes()
    for name, damaged in (("short", content[:-1]), ("long", content + b"0"), ("text", b"hello"), ("empty", b""), ("header", content[:9]),
                          ("gzip", gzip.compress(content)[:-20]), ("axes", b"\0\0\x08\x07" + content)):
        (tmp_path / name).write_bytes(damaged)
        with pytest.raises(StudyError, match=name):
            read_idx(tmp_path / name)
    write_idx(tmp_path / "labels", labels)
    assert read_idx(tmp_path / "labels").tolist() == labels.tolist()


def test_real_sets_are_found() -> None:
    folder = os.environ.get("FOVEATE_DATA")
    if folder is None:
        pytest.skip("FOVEATE_DATA names no folder with real images")
    for name in ("mnist", "fashion-mnist"):
        parts = read(name, Path(folder), alone=False, validation=5000, limit=1.0, size=None)
        assert [len(part.labels) for part in (parts.train, parts.validation, parts.test)] == [55000, 5000, 10000] and parts.classes == 10
        assert parts.train.images.shape[1:] == (28, 28)
