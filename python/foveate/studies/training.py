# SPDX-License-Identifier: MIT OR Apache-2.0
"""Training for a fixed number of epochs. Runs of one seed are paired: they have the same initial weights and the same order of images."""
from __future__ import annotations

import hashlib
import os
from typing import Any

import numpy as np
from numpy.typing import NDArray

from foveate._extras import missing_package_error
from foveate.studies.data import Split, StudyError

try:
    import torch
    from torch import Tensor, nn
except ModuleNotFoundError:
    raise missing_package_error("foveate.studies", "torch", "studies") from None

__all__ = ["check_device", "digest", "initial", "order", "predict", "train"]

#: Number of images of a forward pass without training.
_PREDICTION_BATCH = 250


def initial(make: Any, seed: int) -> nn.Module:
    """Make a network with ``make()``, whose initial weights depend only on the seed."""
    with torch.random.fork_rng(devices=[]):
        torch.manual_seed(seed)
        model: nn.Module = make()
    return model


def order(count: int, epoch: int, seed: int) -> Tensor:
    """Return the order of the images of an epoch, which depends only on the seed."""
    return torch.from_numpy(np.random.default_rng((seed, epoch)).permutation(count))


def train(model: nn.Module, split: Split, *, epochs: int, batch: int, rate: float, seed: int, device: str = "cpu") -> None:
    """Train a network with Adam, at a rate that falls to 0 over the run.

    The last weights are the result. No choice is made during the run, so only ``split`` has an influence.
    """
    # Some layers of large networks have no deterministic form on GPUs. Torch warns then, and runs are paired all the same.
    torch.use_deterministic_algorithms(True, warn_only=device != "cpu")
    model.to(device).train()
    images = torch.from_numpy(np.array(split.images)).to(device)[:, None]
    labels = torch.from_numpy(split.labels).to(device)
    optimizer = torch.optim.Adam(model.parameters(), rate, fused=True)
    steps, step = epochs * -(-len(labels) // batch), 0
    # Dropout needs this seed.
    torch.manual_seed(seed)
    for epoch in range(epochs):
        shuffled = order(len(labels), epoch, seed).to(device)
        for start in range(0, len(labels), batch):
            batch_indices = shuffled[start:start + batch]
            optimizer.param_groups[0]["lr"] = rate * (1 - step / steps)
            optimizer.zero_grad(set_to_none=True)
            torch.autograd.backward(nn.functional.cross_entropy(model(images[batch_indices].float() / 255), labels[batch_indices]))
            optimizer.step()
            step += 1


def check_device(device: str) -> None:
    """Raise an error for a device that this machine does not have."""
    # Products of matrices on GPUs are deterministic only with this variable, which is read when the device is first used.
    os.environ.setdefault("CUBLAS_WORKSPACE_CONFIG", ":4096:8")
    try:
        torch.empty(1, device=device)
    except (RuntimeError, AssertionError) as problem:
        raise StudyError(f"--device {device}: torch cannot use it: {str(problem).splitlines()[0]}") from None


def predict(model: nn.Module, images: NDArray[np.uint8], device: str = "cpu") -> NDArray[np.int64]:
    """Return the predicted class of every image."""
    model.to(device).eval()
    parts = []
    with torch.inference_mode():
        for start in range(0, len(images), _PREDICTION_BATCH):
            batch = torch.from_numpy(np.array(images[start:start + _PREDICTION_BATCH])).to(device)[:, None]
            parts.append(model(batch.float() / 255).argmax(1).cpu().numpy())
    return np.concatenate(parts)


def digest(model: nn.Module, *, length: int | None = 16) -> str:
    """Return a digest of all weights, to compare two networks."""
    state = hashlib.sha256()
    for name, tensor in model.state_dict().items():
        state.update(name.encode())
        state.update(tensor.detach().cpu().contiguous().numpy().tobytes())
    return state.hexdigest()[:length]
