# SPDX-License-Identifier: MIT OR Apache-2.0
"""Tests of the data sets and transforms of PyTorch."""
import copy
import pickle
from concurrent.futures import ThreadPoolExecutor

import numpy as np
import pytest
from PIL import Image

import foveate as fv

torch = pytest.importorskip("torch")
from foveate.torch import RegionDataset, RegionTransform  # noqa: E402


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
