# SPDX-License-Identifier: MIT OR Apache-2.0
"""Data sets and transforms for PyTorch: images as the receiver of a region camera shows them, and region events of clips.

Every image is a first frame, so every TRS is 1 and SRS alone decides, as in ``foveate dataset``. Needs ``torch``.
"""
from __future__ import annotations

import threading
from collections.abc import Sized
from typing import Any, Generic, Protocol, TypeVar, cast

import numpy as np

from foveate._extras import missing_package_error
from foveate._foveate import Camera, Design, Outcome, luma

try:
    import torch
    from torch.utils.data import Dataset
except ModuleNotFoundError:
    raise missing_package_error("foveate.torch", "torch", "torch") from None

from foveate._torch_events import RegionEvents

__all__ = ["RegionDataset", "RegionEvents", "RegionTransform"]

_T = TypeVar("_T")


class _ImageDataset(Protocol):
    def __getitem__(self, index: int, /) -> tuple[Any, Any]: ...
    def __len__(self) -> int: ...


class RegionTransform(Generic[_T]):
    """Show every image to a camera, and return the screen of the receiver.

    For ``torchvision.transforms.Compose``, before ``ToTensor``. It can be pickled, copied, and called from several threads.

    Parameters
    ----------
    camera : Camera, Design, preset, file or dict
        The camera. Its own state is neither used nor changed.

    Notes
    -----
    Takes and returns a picture of PIL, an array (height, width) of uint8 or uint16, or a tensor of uint8 with the shape
    (height, width) or (1, height, width). Colour pictures of PIL and arrays (height, width, 3) become grey first, by
    ``foveate.luma``. Regions that are not active are black.
    """

    def __init__(self, camera: Any) -> None:
        # This camera never steps, so that it can be pickled. Every thread has a camera of its own.
        self._camera = Camera(camera)
        self._local = threading.local()

    @property
    def design(self) -> Design:
        """The design of the camera."""
        return self._camera.design

    def __getstate__(self) -> dict[str, Any]:
        return {"_camera": self._camera}

    def __setstate__(self, state: dict[str, Any]) -> None:
        self.__dict__.update(state)
        self._local = threading.local()

    def outcome(self, image: Any) -> Outcome:
        """Show an image to the camera as a first frame.

        Parameters
        ----------
        image : PIL.Image.Image, array or tensor

        Returns
        -------
        Outcome
            The outcome, whose rendered frame is kept.
        """
        camera = getattr(self._local, "camera", None)
        if camera is None:
            camera = self._local.camera = Camera(self._camera)
        camera.reset()
        return cast(Outcome, camera.step(_grey_pixels(image), keep=True))

    def __call__(self, image: _T) -> _T:
        """Return the rendered frame of an image, in the type of the image."""
        return cast(_T, _in_type_of(image, self.outcome(image).rendered))

    def __repr__(self) -> str:
        return f"RegionTransform({self.design!r})"


class RegionDataset(Dataset[Any]):
    """A data set whose images are the screen of the camera's receiver.

    Parameters
    ----------
    dataset : sequence of (image, target)
        Any data set of torchvision's kind, whose images are pictures of PIL, arrays or tensors of uint8, see
        ``RegionTransform``: give it no ``ToTensor``.
    camera : Camera, Design, preset, file or dict
        The camera. Its own state is neither used nor changed.
    transform : callable, optional
        Applied to the rendered image, for example ``torchvision.transforms.ToTensor()``.
    tags : bool, default False
        Give ``(image, tags, target)`` instead of ``(image, target)``: ``tags`` is a tensor of bool, (rows, columns), true where the
        region is active.

    Examples
    --------
    >>> regions = RegionDataset(torchvision.datasets.MNIST("data"), Camera("paper", region={"size": 7}), transform=ToTensor())
    >>> loader = torch.utils.data.DataLoader(regions, batch_size=64, num_workers=2)
    """

    def __init__(self, dataset: _ImageDataset, camera: Any, *, transform: Any = None, tags: bool = False) -> None:
        self.dataset, self.transform, self.tags = dataset, transform, tags
        self.regions: RegionTransform[Any] = RegionTransform(camera)

    def __len__(self) -> int:
        return len(cast(Sized, self.dataset))

    def __getitem__(self, index: int) -> Any:
        image, target = self.dataset[index]
        outcome = self.regions.outcome(image)
        rendered = _in_type_of(image, outcome.rendered)
        if self.transform is not None:
            rendered = self.transform(rendered)
        return (rendered, torch.from_numpy(outcome.active), target) if self.tags else (rendered, target)


def _grey_pixels(image: Any) -> Any:
    """Return the pixels of an image as a grey array."""
    if isinstance(image, torch.Tensor):
        if image.is_floating_point():
            raise TypeError(f"the tensor has dtype {image.dtype}; a camera takes pixels of uint8, so put it before ToTensor")
        image = image.detach().cpu()
        return (image[0] if image.ndim == 3 and image.shape[0] == 1 else image).numpy()
    if hasattr(image, "getbands"):
        bands = image.getbands()
        if len(bands) > 1 or image.mode == "P":
            return luma(np.asarray(image.convert("RGB")))
        return np.asarray(image.convert("L") if image.mode == "1" else image)
    array = np.asarray(image)
    return luma(array) if array.ndim == 3 and array.shape[2] == 3 and array.dtype == np.uint8 else array


def _in_type_of(image: Any, rendered: Any) -> Any:
    """Return the rendered frame in the type of an image."""
    if isinstance(image, torch.Tensor):
        tensor = torch.from_numpy(rendered)
        return tensor[None] if image.ndim == 3 else tensor
    if hasattr(image, "getbands"):
        from PIL import Image

        return Image.fromarray(rendered)
    return rendered
