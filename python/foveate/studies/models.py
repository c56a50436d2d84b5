# SPDX-License-Identifier: MIT OR Apache-2.0
"""The networks that studies train."""
from __future__ import annotations

from collections import OrderedDict
from importlib import import_module
from pathlib import Path

from foveate._extras import missing_package_error
from foveate.studies.data import StudyError

try:
    import torch
    from torch import Tensor, nn
except ModuleNotFoundError:
    raise missing_package_error("foveate.studies", "torch", "studies") from None

__all__ = ["MODELS", "make"]

MODELS = ("lenet5", "resnet18", "resnet50", "vgg16")


def lenet5(classes: int) -> nn.Sequential:
    """Make LeNet-5 with the layer names of its paper (LeCun et al. 1998), in today's variant.

    C1 pads, so that images of 28 x 28 take the place of 32 x 32. Sub-sampling is the maximum, activations are ReLU, C3 sees all six
    maps, and the output is linear. ReLU follows the maximum, where it has a quarter of the work and the same result.
    """
    return nn.Sequential(OrderedDict([
        ("c1", nn.Conv2d(1, 6, 5, padding=2)), ("s2", nn.MaxPool2d(2)), ("r2", nn.ReLU()),
        ("c3", nn.Conv2d(6, 16, 5)), ("s4", nn.MaxPool2d(2)), ("r4", nn.ReLU()), ("flat", nn.Flatten()),
        ("c5", nn.Linear(400, 120)), ("r5", nn.ReLU()), ("f6", nn.Linear(120, 84)), ("r6", nn.ReLU()), ("output", nn.Linear(84, classes)),
    ]))


class Grey(nn.Module):
    """A network for grey images around one for colour images, with the mean and scale of torchvision's trained networks."""

    mean: Tensor
    scale: Tensor

    def __init__(self) -> None:
        super().__init__()
        self.register_buffer("mean", torch.tensor([0.485, 0.456, 0.406])[:, None, None], persistent=False)
        self.register_buffer("scale", torch.tensor([0.229, 0.224, 0.225])[:, None, None], persistent=False)

    def forward(self, images: Tensor) -> Tensor:
        return (images - self.mean) / self.scale


def make(name: str, classes: int, side: int, weights: Path | None = None) -> nn.Module:
    """Make a network for grey images, with values from 0 to 1.

    Parameters
    ----------
    name : one of ``MODELS``
    classes : int
        Number of outputs.
    side : int
        Width and height of the images.
    weights : Path, optional
        A ``state_dict`` of torchvision's network, to start from. Layers of another shape, such as the output for 1,000 classes, are
        left out.
    """
    if name == "lenet5":
        if side != 28 or weights is not None:
            raise StudyError("lenet5 takes images of 28 x 28 pixels and no --weights: leave out --size and --weights, or choose another --model")
        return lenet5(classes)
    if name not in MODELS:
        raise StudyError(f"--model {name}: there is no such network; expected {', '.join(MODELS)}")
    try:
        networks = import_module("torchvision.models")
    except ImportError:
        raise StudyError(f"--model {name} needs torchvision: pip install torchvision") from None
    body: nn.Module = getattr(networks, name)(weights=None, num_classes=classes)
    if weights is not None:
        _load(body, weights)
    return nn.Sequential(Grey(), body)


def _load(body: nn.Module, weights: Path) -> None:
    try:
        loaded = torch.load(weights, map_location="cpu", weights_only=True)
    except Exception as problem:
        first = (str(problem).splitlines() or [type(problem).__name__])[0]
        raise StudyError(f"--weights {weights}: cannot be read as a state_dict of torch: {first}") from None
    state = body.state_dict()
    fitting = {key: value for key, value in loaded.items() if key in state and state[key].shape == value.shape} if isinstance(loaded, dict) else {}
    if len(fitting) < len(state) // 2:
        raise StudyError(f"--weights {weights}: has {len(fitting)} of {len(state)} tensors of this network; expected torchvision's state_dict of it")
    body.load_state_dict(fitting)
