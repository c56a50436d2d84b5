# SPDX-License-Identifier: MIT OR Apache-2.0
"""The cameras that a study compares, and the screens of their receivers for a whole set."""
from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from foveate import ACTIONS
from foveate._foveate import Camera
from foveate.studies.data import StudyError

__all__ = ["Regions", "Screens", "name_of", "render_screens"]

SUMMARIZE = ACTIONS.index("summarize")


@dataclass(frozen=True, order=True)
class Regions:
    """A camera: the preset ``paper``, whose feature is ``edge``, with these choices.

    Irrelevant regions send the means of ``means`` x ``means`` blocks; with 0 they send nothing.
    """

    min_score: int = 5
    size: int = 8
    neighborhood: str = "isolated"
    filter: str = "median3x3"
    means: int = 0

    @property
    def name(self) -> str:
        """The name of the camera in files and tables: all choices that differ from the preset."""
        return f"n{self.size}-edge{self.min_score}" + ("-shared" if self.neighborhood == "shared" else "") + (
            "-unfiltered" if self.filter == "none" else "") + (f"-means{self.means}" if self.means else "")

    def camera(self) -> Camera:
        """Return the camera with these choices."""
        periphery: dict[str, Any] = {"render": {"irrelevant": "mean"}, "periphery": {"blocks": self.means}} if self.means else {}
        try:
            return Camera("paper", region={"size": self.size, "neighborhood": self.neighborhood}, denoise={"filter": self.filter},
                          spatial={"feature": "edge", "level": 100, "min_score": self.min_score}, **periphery)
        except ValueError as problem:
            raise StudyError(f"camera {self.name}: {problem}") from None


def name_of(regions: Regions | None) -> str:
    """Return the name of a camera; None stands for the originals."""
    return "original" if regions is None else regions.name


@dataclass(frozen=True)
class Screens:
    """The screens of a receiver for a set.

    Attributes
    ----------
    images : array (count, height, width) of uint8
    active : float
        Share of the regions that were sent.
    sent : float
        Sent bytes as a share of the bytes of the originals: pixels of active regions without padding, means, and two
        bits for every region, as in ``summary.json`` of ``foveate simulate``.
    """

    images: NDArray[np.uint8]
    active: float
    sent: float


def render_screens(images: NDArray[np.uint8], regions: Regions | None) -> Screens:
    """Show every image to a camera as a first frame, as ``foveate dataset`` does."""
    if regions is None:
        return Screens(images, 1.0, 1.0)
    camera = regions.camera()
    rendered = np.empty_like(images)
    counts: NDArray[np.int64] | None = None
    summaries = 0
    for image, screen in zip(images, rendered):
        camera.reset()
        outcome = camera.step(image)
        screen[...] = outcome.rendered
        counts = outcome.active.astype(np.int64) if counts is None else counts + outcome.active
        summaries += int((outcome.action == SUMMARIZE).sum())
    assert counts is not None, "a part of a set has an image"
    pixels = int((counts * _pixels(counts.shape, images.shape[1:], regions.size)).sum())
    tags = -(-2 * counts.size * len(images) // 8)
    sent = pixels + regions.means ** 2 * summaries + tags
    return Screens(rendered, float(counts.sum() / (counts.size * len(images))), sent / images.size)


def _pixels(grid: tuple[int, ...], frame: tuple[int, ...], size: int) -> NDArray[np.int64]:
    """Return the number of pixels of each region that are not padding."""
    rows, columns = (np.minimum(size, side - size * np.arange(count)) for count, side in zip(grid, frame))
    return np.asarray(np.outer(rows, columns), np.int64)
