# SPDX-License-Identifier: MIT OR Apache-2.0
"""The study of accuracy against savings: bytes of the camera and MACs of the network, over thresholds, region sizes and windows.

Every image is a first frame. The network computes its difference from a black frame, so MACs are needed where a window has a pixel of an
active region; elsewhere the activations of a black frame are used.
"""
from __future__ import annotations

import tempfile
import warnings
from collections.abc import Callable, Sequence
from dataclasses import asdict, dataclass
from pathlib import Path
from typing import Any

import numpy as np

from foveate._work import infer
from foveate.studies.cameras import Regions
from foveate.studies.data import StudyError, write_idx
from foveate.studies.runs import Run, RunFolder, complete

__all__ = ["Plan", "study"]


@dataclass(frozen=True)
class Plan:
    """The runs of the study: ``seeds`` networks that learn from originals are tested on every camera, ``learned`` networks learn from its
    regions.

    MACs are counted on the first ``images`` of the test images.
    """

    sets: Sequence[str] = ("mnist", "fashion-mnist")
    sizes: Sequence[int] = (4, 7, 8, 14)
    thresholds: Sequence[int] = (1, 2, 5, 10)
    seeds: int = 3
    learned: int = 1
    images: int = 1000

    def cameras(self) -> dict[str, list[Regions]]:
        """Return the cameras in groups with common choices. All organizations give the same results, so they are not a choice."""
        kinds = {f"N = {size}": [Regions(score, size) for score in self.thresholds] for size in self.sizes}
        kinds["N = 8, windows of neighbors"] = [Regions(score, neighborhood="shared") for score in self.thresholds]
        kinds["N = 8, no median"] = [Regions(score, filter="none") for score in self.thresholds]
        for blocks in (1, 2, 4):
            kinds[f"N = 8, no median, {blocks}x{blocks} means"] = [Regions(score, filter="none", means=blocks) for score in self.thresholds]
        return kinds


def study(run_folder: RunFolder, plan: Plan, *, jobs: int = 1, report: Callable[[str], None]) -> dict[str, Any]:
    """Make all missing runs, and count MACs. Return a summary, a dict for JSON."""
    every, learned = range(plan.seeds), range(min(plan.learned, plan.seeds))
    cameras = [camera for kind in plan.cameras().values() for camera in kind]
    runs = [Run(name, None, None, seed) for name in plan.sets for seed in every]
    for name in plan.sets:
        runs += [Run(name, camera, camera, seed) for camera in cameras for seed in learned]
        runs += [Run(name, None, camera, seed) for camera in cameras for seed in every]
    complete(run_folder, runs, jobs=jobs, report=report)
    rows = []
    for name in plan.sets:
        macs = _macs(run_folder, name, cameras, plan.images, report)
        for kind, members in plan.cameras().items():
            rows += [_row(run_folder, name, kind, camera, macs[camera], every, learned) for camera in members]
    return {"settings": asdict(run_folder.settings), "seeds": plan.seeds, "learned": plan.learned, "images": plan.images, "rows": rows}


def _row(run_folder: RunFolder, name: str, kind: str, camera: Regions, macs: float, every: range, learned: range) -> dict[str, Any]:
    values = _values(run_folder, Run(name, None, camera, 0))
    return {
        "set": name, "kind": kind, "camera": camera.name, "region": camera.size, "min_score": camera.min_score,
        "neighborhood": camera.neighborhood, "filter": camera.filter, "means": camera.means,
        "active_share": values["active_share"], "sent_share": values["sent_share"], "macs_share": macs,
        "original_difference": _difference(run_folder, name, None, camera, every),
        "regions_difference": _difference(run_folder, name, camera, camera, learned),
    }


def _difference(run_folder: RunFolder, name: str, trained: Regions | None, tested: Regions, seeds: range) -> float | None:
    """Return the mean difference of accuracy from the originals, seed by seed."""
    if not seeds:
        return None
    return float(np.mean([_values(run_folder, Run(name, trained, tested, seed))["test_accuracy"]
                          - _values(run_folder, Run(name, None, None, seed))["test_accuracy"] for seed in seeds]))


def _values(run_folder: RunFolder, run: Run) -> dict[str, Any]:
    result = run_folder.result(run)
    assert result is not None, "it was completed"
    return result.values


def _macs(run_folder: RunFolder, name: str, cameras: Sequence[Regions], images: int, report: Callable[[str], None]) -> dict[Regions, float]:
    """Return the share of MACs that each camera needs. It depends only on masks, so one network is enough."""
    test = run_folder.set(name).test.images[:images]
    with tempfile.TemporaryDirectory(prefix="foveate-") as temporary:
        network, pictures = Path(temporary) / "network.onnx", Path(temporary) / "test-images-idx3-ubyte"
        export(run_folder, name, network)
        write_idx(pictures, test)
        shares = {}
        for number, camera in enumerate(cameras):
            macs = infer(network, pictures, camera.camera(), Path(temporary) / camera.name, mode="exact").summary["macs"]
            shares[camera] = float(macs["needed"] / macs["dense"])
            report(f"{number + 1} of {len(cameras)}: MACs of {name} {camera.name}")
    return shares


def export(run_folder: RunFolder, name: str, path: Path) -> None:
    """Write the network of seed 0 that learned from originals as ONNX."""
    import torch

    side = run_folder.set(name).test.images.shape[1]
    with warnings.catch_warnings():
        # The older exporter needs no other package; it warns that it is older.
        warnings.simplefilter("ignore")
        try:
            torch.onnx.export(run_folder.network(name, None, 0).eval(), (torch.zeros(1, 1, side, side),), str(path), opset_version=17,
                              dynamo=False, input_names=["picture"], output_names=["scores"])
        except ImportError:
            raise StudyError("counts of MACs need onnx: pip install onnx") from None
