# SPDX-License-Identifier: MIT OR Apache-2.0
"""Labelled images for studies: IDX files, torchvision's folders of IDX files, and pictures in folders. Nothing is downloaded."""
from __future__ import annotations

import gzip
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from foveate._foveate import luma

__all__ = ["DataSet", "Split", "StudyError", "read", "SETS"]

#: Sets of IDX files, and the names of their folders: torchvision's and plain ones.
SETS: dict[str, tuple[str, ...]] = {
    "mnist": ("MNIST/raw", "mnist", "mnist/raw"),
    "fashion-mnist": ("FashionMNIST/raw", "fashion-mnist", "fashion-mnist/raw"),
}
_PICTURES = (".jpg", ".jpeg", ".png", ".bmp", ".webp")


class StudyError(ValueError):
    """An error of a study, in one line for its user."""


@dataclass(frozen=True)
class Split:
    """Grey images (count, height, width) of uint8, and their labels of int64."""

    images: NDArray[np.uint8]
    labels: NDArray[np.int64]


@dataclass(frozen=True)
class DataSet:
    """A set in three parts: networks learn from ``train``, thresholds are chosen on ``validation``, and results are measured on ``test``."""

    name: str
    classes: int
    train: Split
    validation: Split
    test: Split


def read(name: str, folder: Path, *, alone: bool, validation: int, limit: float, size: int | None) -> DataSet:
    """Read a set.

    Parameters
    ----------
    name : "mnist", "fashion-mnist" or "pictures"
        ``pictures`` is ``train/CLASS/*`` and ``test/CLASS/*`` below the folder.
    folder : Path
        The folder with the files.
    alone : bool
        Whether this is the only set of the study, so that IDX files may be in the folder itself.
    validation : int
        Number of images at the end of the training images that are kept for validation.
    limit : float
        Share of every part that is used, from its beginning.
    size : int, optional
        Width and height to which images are scaled.
    """
    if name == "pictures":
        train, test, classes = _pictures(folder, size)
    else:
        train, test = _idx_halves(name, folder, alone)
        classes = int(train.labels.max()) + 1
        if size is not None:
            train, test = _scale(train, size), _scale(test, size)
    if not 0 < validation < len(train.labels):
        raise StudyError(f"--validation {validation}: {name} has {len(train.labels)} training images; expected 1 to {len(train.labels) - 1}")
    first = len(train.labels) - validation
    limited_splits = [_limited(part, limit) for part in (
        Split(train.images[:first], train.labels[:first]), Split(train.images[first:], train.labels[first:]), test)]
    return DataSet(name, classes, *limited_splits)


def read_idx(path: Path) -> NDArray[np.uint8]:
    """Read an array of bytes in the IDX format of MNIST, gzipped or not."""
    try:
        content = path.read_bytes()
        if content[:2] == b"\x1f\x8b":
            content = gzip.decompress(content)
    except (OSError, EOFError) as problem:
        raise StudyError(f"{path}: cannot be read: {problem}") from None
    if len(content) < 4 or content[:3] != b"\0\0\x08" or not 1 <= content[3] <= 3:
        raise StudyError(f"{path}: begins with {content[:4]!r}; expected an IDX file of bytes, b'\\x00\\x00\\x08' and 1 to 3 axes")
    start = 4 + 4 * content[3]
    shape = tuple(int(side) for side in np.frombuffer(content[:start], ">u4", offset=4)) if len(content) >= start else ()
    expected = int(np.prod(shape)) if shape else 1
    if not shape or len(content) - start != expected:
        raise StudyError(f"{path}: has {len(content)} bytes, but its header announces {start + expected}; the file is damaged")
    return np.frombuffer(content, np.uint8, offset=start).reshape(shape)


def write_idx(path: Path, array: NDArray[np.uint8]) -> None:
    """Write an array of bytes in the IDX format of MNIST."""
    header = bytes((0, 0, 8, array.ndim)) + np.array(array.shape, ">u4").tobytes()
    path.write_bytes(header + np.ascontiguousarray(array).tobytes())


def _idx_halves(name: str, folder: Path, alone: bool) -> tuple[Split, Split]:
    if name not in SETS:
        raise StudyError(f"--sets {name}: there is no such set; expected {', '.join(SETS)} or pictures")
    places = [folder / place for place in SETS[name]] + ([folder, folder / "raw"] if alone else [])
    set_folder = next((place for place in places if any((place / f"train-images-idx3-ubyte{end}").is_file() for end in ("", ".gz"))), None)
    if set_folder is None:
        searched = ", ".join(str(place) for place in places)
        raise StudyError(f"{name} is not below {folder}: put its four IDX files (train-images-idx3-ubyte and so on, gzipped or not) into one "
                         f"of {searched}; nothing is downloaded")
    return _idx_half(set_folder, "train"), _idx_half(set_folder, "t10k")


def _idx_half(set_folder: Path, half: str) -> Split:
    arrays: list[NDArray[np.uint8]] = []
    for kind, axes in (("images-idx3", 3), ("labels-idx1", 1)):
        names = [set_folder / f"{half}-{kind}-ubyte{end}" for end in ("", ".gz")]
        path = next((path for path in names if path.is_file()), None)
        if path is None:
            raise StudyError(f"{names[0]} is missing, also with .gz: put it beside the other files of the set")
        array = read_idx(path)
        if array.ndim != axes:
            raise StudyError(f"{path}: has {array.ndim} axes; expected {axes}")
        arrays.append(array)
    images, labels = arrays
    if len(images) != len(labels):
        raise StudyError(f"{set_folder}: {half} has {len(images)} images and {len(labels)} labels; expected as many labels as images")
    return Split(images, labels.astype(np.int64))


def _pictures(folder: Path, size: int | None) -> tuple[Split, Split, int]:
    """Return pictures in a fixed order without a pattern, so that the last ones are of all classes."""
    if size is None:
        raise StudyError("--size is missing: pictures need one size, such as --size 224")
    if not (folder / "train").is_dir() or not (folder / "test").is_dir():
        raise StudyError(f"{folder}: has no folders train and test; expected train/CLASS/* and test/CLASS/*; nothing is downloaded")
    classes = sorted(path.name for path in (folder / "train").iterdir() if path.is_dir())
    halves: list[Split] = []
    for half in ("train", "test"):
        files = [(path, label) for label, kind in enumerate(classes)
                 for path in sorted((folder / half / kind).glob("*")) if path.suffix.lower() in _PICTURES]
        if not files:
            raise StudyError(f"{folder / half}: holds no pictures; expected folders named after classes, with {', '.join(_PICTURES)}")
        order = np.random.default_rng(0).permutation(len(files))
        images = np.stack([_picture(files[index][0], size) for index in order])
        halves.append(Split(images, np.array([files[index][1] for index in order], np.int64)))
    return halves[0], halves[1], len(classes)


def _picture(path: Path, size: int) -> NDArray[np.uint8]:
    from PIL import Image

    try:
        with Image.open(path) as picture:
            scaled = picture.convert("RGB").resize((size, size), Image.Resampling.BILINEAR)
    except OSError as problem:
        raise StudyError(f"{path}: cannot be read as a picture: {problem}") from None
    return luma(np.asarray(scaled))


def _scale(split: Split, size: int) -> Split:
    import torch

    parts: list[Any] = []
    for start in range(0, len(split.images), 1000):
        tensor = torch.from_numpy(split.images[start:start + 1000].copy())[:, None].float()
        scaled = torch.nn.functional.interpolate(tensor, size=(size, size), mode="bilinear", align_corners=False, antialias=True)
        parts.append(scaled[:, 0].round().clamp(0, 255).to(torch.uint8).numpy())
    return Split(np.concatenate(parts), split.labels)


def _limited(split: Split, limit: float) -> Split:
    count = max(1, round(len(split.labels) * limit))
    return Split(split.images[:count], split.labels[:count])
