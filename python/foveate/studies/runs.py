# SPDX-License-Identifier: MIT OR Apache-2.0
"""Runs of a study. Each is a file that appears whole and is named by its parameters, so that a restarted study continues.

A run trains a network on the output of one camera and tests it on that, or tests a trained network on the output of another camera.
"""
from __future__ import annotations

import hashlib
import json
import os
from collections.abc import Callable, Iterable
from dataclasses import asdict, dataclass
from functools import lru_cache
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from foveate._extras import missing_package_error
from foveate.studies import data, training
from foveate.studies.cameras import Regions, Screens, name_of, render_screens
from foveate.studies.data import DataSet, StudyError
from foveate.studies.models import make

try:
    import torch
    from torch import nn
except ModuleNotFoundError:
    raise missing_package_error("foveate.studies", "torch", "studies") from None

__all__ = ["RunFolder", "Result", "Run", "Settings", "complete", "write_whole"]


@dataclass(frozen=True)
class Settings:
    """The settings that all runs of a study share. The folder of the results is not one of them."""

    model: str = "lenet5"
    epochs: int = 3
    batch: int = 64
    rate: float = 0.001
    validation: int = 5000
    limit: float = 1.0
    size: int | None = None
    weights: str | None = None
    device: str = "cpu"


@dataclass(frozen=True)
class Run:
    """A run: one network on one set. A camera of None stands for the originals."""

    set: str
    trained: Regions | None
    tested: Regions | None
    seed: int

    @property
    def name(self) -> str:
        """The name of the run's file."""
        return f"{name_of(self.trained)}@{name_of(self.tested)}.s{self.seed:02}"


@dataclass(frozen=True)
class Result:
    """The result of a run."""

    values: dict[str, Any]

    @property
    def correct(self) -> NDArray[np.bool_]:
        """One flag per test image: the network was right."""
        bits = np.unpackbits(np.frombuffer(bytes.fromhex(self.values["correct"]), np.uint8))
        return bits[:self.values["test_images"]].astype(bool)

    @property
    def test(self) -> float:
        """Accuracy on the test images, 0 to 1."""
        return float(self.values["test_accuracy"])

    @property
    def validation(self) -> float:
        """Accuracy on the validation images, 0 to 1."""
        return float(self.values["validation_accuracy"])


class RunFolder:
    """The folder of a study's runs: makes runs, and writes and reads their results."""

    def __init__(self, folder: Path, source: Path, settings: Settings, *, alone: bool = False) -> None:
        self.folder, self.source, self.settings, self.alone = folder, source, settings, alone
        self.set = lru_cache(maxsize=2)(self._set)
        self.screens = lru_cache(maxsize=8)(self._screens)
        self.set_folder = lru_cache(maxsize=2)(self._set_folder)

    def __reduce__(self) -> Any:
        return _open_run_folder, (self.folder, self.source, self.settings, self.alone)

    def _set(self, name: str) -> DataSet:
        settings = self.settings
        return data.read(name, self.source, alone=self.alone, validation=settings.validation, limit=settings.limit, size=settings.size)

    def _screens(self, name: str, regions: Regions | None, part: str) -> Screens:
        split: data.Split = getattr(self.set(name), part)
        return render_screens(split.images, regions)

    def _set_folder(self, name: str) -> Path:
        """Return the folder of a set's runs, whose name depends on everything that they share: settings, images, version of torch."""
        parts = self.set(name)
        shared = hashlib.sha256(json.dumps([asdict(self.settings), torch.__version__], sort_keys=True).encode())
        for part in (parts.train, parts.validation, parts.test):
            shared.update(part.images.tobytes())
            shared.update(part.labels.tobytes())
        if self.settings.weights is not None:
            shared.update(Path(self.settings.weights).read_bytes())
        return self.folder / "runs" / f"{name}.{self.settings.model}.{shared.hexdigest()[:8]}"

    def path(self, run: Run) -> Path:
        """Return the path of a run's file."""
        return self.set_folder(run.set) / f"{run.name}.json"

    def result(self, run: Run) -> Result | None:
        """Return the result of a run, or None if it was not made."""
        path = self.path(run)
        if not path.is_file():
            return None
        try:
            return Result(json.loads(path.read_text()))
        except ValueError as error:
            raise StudyError(f"{path}: is not the result of a run ({error}); delete it to repeat the run") from None

    def network(self, name: str, trained: Regions | None, seed: int, *, fresh: bool = False) -> nn.Module:
        """Return a network with its initial weights, or as a run has trained it."""
        parts, settings = self.set(name), self.settings
        weights = None if settings.weights is None else Path(settings.weights)
        model = training.initial(lambda: make(settings.model, parts.classes, parts.train.images.shape[1], weights), seed)
        if not fresh:
            model.load_state_dict(torch.load(self._weights(name, trained, seed), map_location="cpu", weights_only=True))
        return model

    def make(self, run: Run) -> None:
        """Make a run, and write its result."""
        settings, parts = self.settings, self.set(run.set)
        if run.trained == run.tested:
            model = self.network(run.set, run.trained, run.seed, fresh=True)
            initial_digest = training.digest(model)
            split = data.Split(self.screens(run.set, run.trained, "train").images, parts.train.labels)
            training.train(model, split, epochs=settings.epochs, batch=settings.batch, rate=settings.rate, seed=run.seed, device=settings.device)
            target = self._weights(run.set, run.trained, run.seed)
            write_whole(target, lambda path: torch.save({key: value.cpu() for key, value in model.state_dict().items()}, path))
        else:
            model, initial_digest = self.network(run.set, run.trained, run.seed), None
        test = self.screens(run.set, run.tested, "test")
        validation_images = self.screens(run.set, run.tested, "validation").images
        validation = training.predict(model, validation_images, settings.device) == parts.validation.labels
        correct = training.predict(model, test.images, settings.device) == parts.test.labels
        values = {
            "set": run.set, "model": settings.model, "trained": name_of(run.trained), "tested": name_of(run.tested), "seed": run.seed,
            "settings": asdict(settings), "torch": torch.__version__, "initial_weights": initial_digest, "trained_weights": training.digest(model),
            "train_images": len(parts.train.labels), "validation_images": len(validation), "test_images": len(correct),
            "active_share": test.active, "sent_share": test.sent,
            "validation_accuracy": float(validation.mean()), "test_accuracy": float(correct.mean()),
            "correct": np.packbits(correct).tobytes().hex(),
        }
        text = json.dumps(values, indent=1) + "\n"
        write_whole(self.path(run), lambda path: path.write_text(text))

    def _weights(self, name: str, trained: Regions | None, seed: int) -> Path:
        return self.set_folder(name) / f"{name_of(trained)}.s{seed:02}.pt"


def _open_run_folder(folder: Path, source: Path, settings: Settings, alone: bool) -> RunFolder:
    return RunFolder(folder, source, settings, alone=alone)


def write_whole(target: Path, write: Callable[[Path], Any]) -> None:
    """Write a file with ``write(path)``, so that it appears whole or not at all."""
    target.parent.mkdir(parents=True, exist_ok=True)
    partial = target.with_name(f".{target.name}.{os.getpid()}")
    try:
        write(partial)
        os.replace(partial, target)
    finally:
        partial.unlink(missing_ok=True)


def complete(run_folder: RunFolder, runs: Iterable[Run], *, jobs: int = 1, report: Callable[[str], None]) -> None:
    """Make the missing results. Networks are trained before they are tested on other cameras."""
    runs = list(runs)
    for regions in dict.fromkeys(run.tested for run in runs):
        # An invalid camera is refused before any network is trained.
        if regions is not None:
            regions.camera()
    missing = [run for run in dict.fromkeys(runs) if run_folder.result(run) is None]
    for stage_runs in ([run for run in missing if run.trained == run.tested], [run for run in missing if run.trained != run.tested]):
        _run_stage(run_folder, stage_runs, jobs, report)


def _run_stage(run_folder: RunFolder, runs: list[Run], jobs: int, report: Callable[[str], None]) -> None:
    if jobs == 1 or len(runs) < 2:
        _one_thread()
        for number, run in enumerate(runs):
            run_folder.make(run)
            report(f"{number + 1} of {len(runs)}: {run.set} {run.name}")
        return
    from concurrent.futures import ProcessPoolExecutor, as_completed
    from multiprocessing import get_context

    with ProcessPoolExecutor(jobs, get_context("spawn"), _worker, (run_folder,)) as workers:
        futures = {workers.submit(_make, run): run for run in runs}
        try:
            for number, future in enumerate(as_completed(futures)):
                future.result()
                report(f"{number + 1} of {len(runs)}: {futures[future].set} {futures[future].name}")
        except BaseException:
            workers.shutdown(wait=False, cancel_futures=True)
            raise


_WORKER: list[RunFolder] = []


def _worker(run_folder: RunFolder) -> None:
    import signal

    # The waiting process handles Ctrl-C.
    signal.signal(signal.SIGINT, signal.SIG_IGN)
    _one_thread()
    _WORKER[:] = [run_folder]


def _make(run: Run) -> None:
    _WORKER[0].make(run)


def _one_thread() -> None:
    """Limit torch to one thread: sums of several threads may have other bits, and parallel processes are faster for small networks."""
    torch.set_num_threads(1)
