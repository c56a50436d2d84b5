# SPDX-License-Identifier: MIT OR Apache-2.0
"""The paper's study of accuracy: networks that learn from regions beside networks that learn from originals.

Every threshold is tried with a few seeds. One is chosen on the validation images, and tried with all seeds, with and without the
camera's median. Test images decide nothing.
"""
from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from foveate.studies.cameras import Regions, name_of
from foveate.studies.runs import Result, Run, RunFolder, complete
from foveate.studies.statistics import bootstrap, mcnemar, t_interval

__all__ = ["Plan", "runs_of", "study"]


@dataclass(frozen=True)
class Plan:
    """The runs of the study: all ``seeds`` at the chosen threshold, the first ``figure_seeds`` at each of ``thresholds``.

    The chosen threshold is the largest that loses at most ``margin`` of validation accuracy, 0 to 1, or else the one that loses least.
    """

    sets: Sequence[str] = ("mnist", "fashion-mnist")
    thresholds: Sequence[int] = tuple(range(1, 11))
    seeds: int = 10
    figure_seeds: int = 3
    margin: float = 0.002

    @property
    def figure_seed_range(self) -> range:
        """The seeds of the figure."""
        return range(min(self.figure_seeds, self.seeds))


def study(run_folder: RunFolder, plan: Plan, *, jobs: int = 1, report: Callable[[str], None]) -> dict[str, Any]:
    """Make all missing runs. Return a summary of all runs, a dict for JSON."""
    cameras = [Regions(threshold) for threshold in plan.thresholds]
    complete(run_folder, [run for name in plan.sets for run in _figure_runs(name, cameras, plan.figure_seed_range)], jobs=jobs, report=report)
    chosen = {name: _choose_camera(run_folder, name, cameras, plan) for name in plan.sets}
    final_runs = [run for name in plan.sets for camera in _final_cameras(chosen[name]) for run in _paired_runs(name, camera, range(plan.seeds))]
    complete(run_folder, final_runs, jobs=jobs, report=report)
    return {"sets": [_summary(run_folder, name, cameras, chosen[name], plan) for name in plan.sets]}


def runs_of(run_folder: RunFolder, plan: Plan, summary: dict[str, Any]) -> list[dict[str, Any]]:
    """Return a row for every run of the summary, without the list of its images."""
    cameras = [Regions(threshold) for threshold in plan.thresholds]
    rows = []
    for entry in summary["sets"]:
        name = entry["set"]
        chosen = next(camera for camera in cameras if camera.name == entry["chosen"])
        runs = _figure_runs(name, cameras, plan.figure_seed_range)
        runs += [run for camera in _final_cameras(chosen) for run in _paired_runs(name, camera, range(plan.seeds))]
        for run in dict.fromkeys(runs):
            values = _result(run_folder, run).values
            rows.append({key: value for key, value in values.items() if key not in ("correct", "settings")})
    return rows


def _figure_runs(name: str, cameras: Sequence[Regions], seeds: range) -> list[Run]:
    return [run for camera in cameras for run in _paired_runs(name, camera, seeds)]


def _final_cameras(chosen: Regions) -> list[Regions]:
    return [chosen, Regions(chosen.min_score, filter="none")]


def _paired_runs(name: str, camera: Regions, seeds: range) -> list[Run]:
    """Return the runs that judge a camera: trained on originals, trained on regions, and trained on originals but tested on regions."""
    return [Run(name, trained, tested, seed) for trained, tested in ((None, None), (camera, camera), (None, camera)) for seed in seeds]


def _result(run_folder: RunFolder, run: Run) -> Result:
    result = run_folder.result(run)
    assert result is not None, "it was completed"
    return result


def _choose_camera(run_folder: RunFolder, name: str, cameras: Sequence[Regions], plan: Plan) -> Regions:
    def validation(camera: Regions | None) -> float:
        return float(np.mean([_result(run_folder, Run(name, camera, camera, seed)).validation for seed in plan.figure_seed_range]))

    originals = validation(None)
    losses = {camera: originals - validation(camera) for camera in cameras}
    accepted = [camera for camera in cameras if losses[camera] <= plan.margin]
    return max(accepted) if accepted else min(cameras, key=lambda camera: losses[camera])


def _summary(run_folder: RunFolder, name: str, cameras: Sequence[Regions], chosen: Regions, plan: Plan) -> dict[str, Any]:
    all_seeds, figure_seeds = range(plan.seeds), plan.figure_seed_range
    figure = [_summary_row(run_folder, name, trained, camera, figure_seeds) for camera in cameras for trained in (camera, None)]
    table = [_summary_row(run_folder, name, trained, camera, all_seeds) for camera in _final_cameras(chosen) for trained in (camera, None)]
    first = _result(run_folder, Run(name, None, None, 0)).values
    originals = [_result(run_folder, Run(name, None, None, seed)).test for seed in all_seeds]
    return {
        "set": name, "model": first["model"], "settings": first["settings"], "torch": first["torch"],
        "train_images": first["train_images"], "validation_images": first["validation_images"], "test_images": first["test_images"],
        "original": _interval(originals), "chosen": chosen.name, "margin": plan.margin, "table": table,
        # Only the seeds of the figure, so that its lines compare pairs.
        "figure_original": float(np.mean(originals[:len(figure_seeds)])), "figure": figure,
    }


def _summary_row(run_folder: RunFolder, name: str, trained: Regions | None, tested: Regions, seeds: range) -> dict[str, Any]:
    """Compare a way of training and testing with the originals, seed by seed."""
    originals = [_result(run_folder, Run(name, None, None, seed)) for seed in seeds]
    results = [_result(run_folder, Run(name, trained, tested, seed)) for seed in seeds]
    images = bootstrap(np.stack([result.correct for result in originals]), np.stack([result.correct for result in results]))
    difference = _interval([regions_result.test - result.test for result, regions_result in zip(originals, results)])
    pairs = [_mcnemar_pair(seed, result, regions_result) for seed, result, regions_result in zip(seeds, originals, results)]
    ends = [abs(end) for end in (*images, difference["low"], difference["high"]) if end is not None]
    return {
        "trained": name_of(trained), "tested": tested.name, "min_score": tested.min_score, "seeds": len(seeds),
        "accuracy": _interval([result.test for result in results]), "tests": [result.test for result in results],
        "difference": difference, "bootstrap": list(images), "largest": max(ends),
        "mcnemar": pairs, "significant": sum(pair["p"] < 0.05 for pair in pairs),
        "validation": float(np.mean([result.validation for result in results])),
        "active_share": results[0].values["active_share"], "sent_share": results[0].values["sent_share"],
    }


def _mcnemar_pair(seed: int, before: Result, after: Result) -> dict[str, Any]:
    only_original, only_regions = int((before.correct & ~after.correct).sum()), int((after.correct & ~before.correct).sum())
    return {"seed": seed, "only_original": only_original, "only_regions": only_regions, "p": mcnemar(only_original, only_regions)}


def _interval(values: Sequence[float]) -> dict[str, Any]:
    mean, low, high = t_interval(values)
    has_interval = len(values) > 1
    return {"mean": mean, "low": low if has_interval else None, "high": high if has_interval else None}
