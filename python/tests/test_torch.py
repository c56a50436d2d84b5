# SPDX-License-Identifier: MIT OR Apache-2.0
"""Tests of the data sets and transforms of PyTorch."""
import copy
import pickle
import shutil
from concurrent.futures import ThreadPoolExecutor

import numpy as np
import pytest
from PIL import Image

import foveate as fv

torch = pytest.importorskip("torch")
import pyarrow.parquet as pq  # noqa: E402

from foveate.torch import RegionDataset, RegionEvents, RegionTransform  # noqa: E402


def images(count=20, shape=(28, 28)):
    generator = np.random.default_rng(4)
    made = generator.integers(0, 256, (count, *shape), np.uint8)
    made[:, : shape[0] // 2] = 30
    return made


def expected(image, **keys):
    return fv.Camera(region={"size": 7}, **keys).step(image, keep=True).rendered


def test_the_transform_gives_the_type_it_takes():
    transform = RegionTransform(fv.Camera(region={"size": 7}))
    (image,) = images(1)
    shown = expected(image)
    assert shown[:14].max() == 0 and shown[14:].any()
    assert np.array_equal(transform(image), shown)
    assert np.array_equal(np.asarray(transform(Image.fromarray(image))), shown)
    flat, stacked = transform(torch.from_numpy(image)), transform(torch.from_numpy(image)[None])
    assert np.array_equal(flat, shown) and stacked.shape == (1, 28, 28) and np.array_equal(stacked[0], shown)
    colour = np.stack([image, image // 2, image], axis=2)
    grey = expected(fv.luma(colour))
    assert np.array_equal(transform(colour), grey)
    assert np.array_equal(np.asarray(transform(Image.fromarray(colour))), grey)
    deep = RegionTransform({"region": {"size": 7}, "frame": {"pixel_bits": 16}})
    wide = image.astype(np.uint16) * 257
    assert np.array_equal(deep(wide), expected(wide, frame={"pixel_bits": 16}))


def test_every_image_is_a_first_frame_of_its_own_size():
    transform = RegionTransform("paper")
    assert transform.design.width == 224
    for shape in ((28, 28), (28, 28), (9, 50), (28, 28)):
        (image,) = images(1, shape)
        for _ in range(2):
            outcome = transform.outcome(image)
            assert outcome.trs.all() and outcome.number == 0
            assert np.array_equal(outcome.rendered, fv.Camera().step(image, keep=True).rendered)


def test_the_camera_is_neither_used_nor_changed():
    camera = fv.Camera(region={"size": 7})
    camera.step(images(1)[0])
    transform = RegionTransform(camera)
    transform(images(1, (9, 50))[0])
    assert camera.frames == 1 and camera.design.width == 28


def test_what_is_no_image_is_refused():
    transform = RegionTransform("paper")
    with pytest.raises(TypeError, match="torch.float32; a camera takes pixels of uint8, so put it before ToTensor"):
        transform(torch.zeros(1, 28, 28))
    with pytest.raises(ValueError, match=r"shape \(3, 28, 28\)"):
        transform(torch.zeros(3, 28, 28, dtype=torch.uint8))
    with pytest.raises(ValueError, match="unknown preset"):
        RegionTransform("papier")


def test_transforms_are_copied_pickled_and_shared_by_threads():
    transform = RegionTransform(fv.Camera(region={"size": 7}))
    clip = images()
    shown = [transform(image) for image in clip]
    for made in (copy.deepcopy(transform), pickle.loads(pickle.dumps(transform))):
        assert all(np.array_equal(made(image), one) for image, one in zip(clip, shown, strict=True))
    with ThreadPoolExecutor(4) as pool:
        assert all(np.array_equal(one, other) for one, other in zip(pool.map(transform, clip), shown, strict=True))


def batch(pair):
    """Collates a list for a DataLoader. It is defined here so that workers can be spawned."""
    return [torch.stack(list(part)) if torch.is_tensor(part[0]) else torch.tensor(part) for part in zip(*pair, strict=True)]


@pytest.mark.filterwarnings("ignore:This process .* is multi-threaded:DeprecationWarning")
@pytest.mark.parametrize("method", ["fork", "spawn"])
def test_loaders_with_workers(method):
    given = [(torch.from_numpy(image), number % 10) for number, image in enumerate(images())]
    regions = RegionDataset(given, fv.Camera(region={"size": 7}), tags=True)
    regions[0]
    loader = torch.utils.data.DataLoader(regions, batch_size=6, num_workers=2, multiprocessing_context=method, collate_fn=batch)
    seen, tags, targets = zip(*loader, strict=True)
    assert torch.cat(targets).tolist() == [number % 10 for number in range(20)]
    assert torch.cat(tags).shape == (20, 4, 4)
    for image, one in zip(images(), torch.cat(seen), strict=True):
        assert np.array_equal(one, expected(image))


def test_a_transform_follows_the_regions():
    given = [(image, 3) for image in images(2)]
    regions = RegionDataset(given, {"region": {"size": 7}}, transform=lambda image: image.astype(np.float32) / 255)
    assert len(regions) == 2 and regions[1][0].dtype == np.float32 and regions[1][1] == 3
    with pytest.raises(IndexError):
        regions[2]


@pytest.fixture(scope="module")
def clip_folder(command, tmp_path_factory):
    """Returns a function that makes the folder of a scene."""
    def make(name, *words):
        folder = tmp_path_factory.mktemp("clips") / name
        command("simulate", "scene:street", "--rendered", "none", "--quiet", "--events", "parquet", "-o", folder, *words)
        return folder

    return make


def test_region_events_are_the_rows_of_the_table(clip_folder):
    flow = ["--set", "hardware.organization='serial'", "--set", "spatial=[{feature='edge'},{feature='flow'}]"]
    for words in (["--frames", "9"], ["--frames", "6", "--only", "active"], ["--frames", "3", *flow]):
        folder = clip_folder("clip", *words)
        events = RegionEvents(folder)
        table = pq.read_table(folder / "events.parquet").to_pandas()
        assert len(events) == int(words[1])
        for number in range(len(events)):
            item, rows = events[number], table[table["frame"] == number]
            assert int(item["frame"]) == number and len(item["srs"]) == len(rows)
            assert np.array_equal(item["xy"], rows[["x", "y"]]) and np.array_equal(item["pixel_xy"], rows[["x0", "y0"]])
            assert np.array_equal(item["scores"], rows[[f"score_{name}" for name in events.features]])
            for key, column in (("srs", "srs"), ("trs", "trs"), ("changed", "t_count")):
                assert np.array_equal(item[key], rows[column])
            assert [fv.ACTIONS[code] for code in item["action"]] == list(rows["action"])
            assert ("displacement" in item) == ("dx" in table)
            if "dx" in table:
                assert np.array_equal(item["displacement"], rows[["dx", "dy"]])
        assert np.array_equal(events[-1]["xy"], events[len(events) - 1]["xy"])
        with pytest.raises(IndexError, match="frame 9"):
            events[max(9, len(events))]


def test_region_events_are_read_by_workers_and_in_groups(clip_folder, tmp_path):
    folder = clip_folder("clip", "--frames", "8")
    plain = RegionEvents(folder)
    # The same rows in small groups, so that frames lie in several.
    table = pq.read_table(folder / "events.parquet")
    small = tmp_path / "small"
    shutil.copytree(folder, small)
    pq.write_table(table, small / "events.parquet", row_group_size=783)
    loader = torch.utils.data.DataLoader(RegionEvents(small), batch_size=3, collate_fn=RegionEvents.collate, num_workers=2)
    batches = list(loader)
    assert [batch["frame"].tolist() for batch in batches] == [[0, 1, 2], [3, 4, 5], [6, 7]]
    for start, batch in zip((0, 3, 6), batches, strict=True):
        for place, number in enumerate(batch["frame"].tolist()):
            of_item = batch["batch"] == place
            assert torch.equal(batch["scores"][of_item], plain[start + place]["scores"])
            assert int(batch["t_us"][place]) == int(plain[number]["t_us"])


def test_frames_without_events_are_empty(clip_folder):
    folder = clip_folder("still", "--frames", "4", "--only", "active", "--set", "temporal.level=254", "--set", "temporal.min_count=64")
    events = RegionEvents(folder)
    counts = [len(item["srs"]) for item in (events[number] for number in range(4))]
    assert counts[0] > 0 and counts[1:] == [0, 0, 0]
    assert events[2]["xy"].shape == (0, 2) and int(events[2]["t_us"]) == 66_667
    none = RegionEvents(clip_folder("none", "--frames", "2", "--only", "active", "--set", "spatial.0.min_score=64"))
    assert [len(none[number]["srs"]) for number in range(2)] == [0, 0]


def test_a_folder_without_a_table_is_refused(clip_folder, tmp_path):
    with pytest.raises(FileNotFoundError, match="--events parquet writes it"):
        RegionEvents(tmp_path)
