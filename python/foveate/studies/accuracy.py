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
from foveate.studies.runs import Bench, Result, Run, complete
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
    def few(self) -> range:
        """The seeds of the figure."""
        return range(min(self.figure_seeds, self.seeds))


def study(bench: Bench, plan: Plan, *, jobs: int = 1, report: Callable[[str], None]) -> dict[str, Any]:
    """Make all missing runs. Return a summary of all runs, a dict for JSON."""
    cameras = [Regions(threshold) for threshold in plan.thresholds]
    complete(bench, [run for name in plan.sets for run in _figure(name, cameras, plan.few)], jobs=jobs, report=report)
    chosen = {name: _choose(bench, name, cameras, plan) for name in plan.sets}
    complete(bench, [run for name in plan.sets for camera in _finalists(chosen[name]) for run in _against(name, camera, range(plan.seeds))],
             jobs=jobs, report=report)
    return {"sets": [_summary(bench, name, cameras, chosen[name], plan) for name in plan.sets]}


def runs_of(bench: Bench, plan: Plan, summary: dict[str, Any]) -> list[dict[str, Any]]:
    """Return a row for every run of the summary, without the list of its images."""
    cameras = [Regions(threshold) for threshold in plan.thresholds]
    rows = []
    for entry in summary["sets"]:
        name = entry["set"]
        chosen = next(camera for camera in cameras if camera.name == entry["chosen"])
        wanted = _figure(name, cameras, plan.few)
        wanted += [run for camera in _finalists(chosen) for run in _against(name, camera, range(plan.seeds))]
        for run in dict.fromkeys(wanted):
            values = _result(bench, run).values
            rows.append({key: value for key, value in values.items() if key not in ("correct", "settings")})
    return rows


def _figure(name: str, cameras: Sequence[Regions], seeds: range) -> list[Run]:
    return [run for camera in cameras for run in _against(name, camera, seeds)]


def _finalists(chosen: Regions) -> list[Regions]:
    return [chosen, Regions(chosen.min_score, filter="none")]


def _against(name: str, camera: Regions, seeds: range) -> list[Run]:
    """Return the runs that judge a camera: trained on originals, trained on regions, and trained on originals but tested on regions."""
    return [Run(name, trained, tested, seed) for trained, tested in ((None, None), (camera, camera), (None, camera)) for seed in seeds]


def _result(bench: Bench, run: Run) -> Result:
    result = bench.result(run)
    assert result is not None, "it was completed"
    return result


def _choose(bench: Bench, name: str, cameras: Sequence[Regions], plan: Plan) -> Regions:
    def validation(camera: Regions | None) -> float:
        return float(np.mean([_result(bench, Run(name, camera, camera, seed)).validation for seed in plan.few]))

    originals = validation(None)
    lost = {camera: originals - validation(camera) for camera in cameras}
    within = [camera for camera in cameras if lost[camera] <= plan.margin]
    return max(within) if within else min(cameras, key=lambda camera: lost[camera])


def _summary(bench: Bench, name: str, cameras: Sequence[Regions], chosen: Regions, plan: Plan) -> dict[str, Any]:
    every, few = range(plan.seeds), plan.few
    figure = [_row(bench, name, trained, camera, few) for camera in cameras for trained in (camera, None)]
    table = [_row(bench, name, trained, camera, every) for camera in _finalists(chosen) for trained in (camera, None)]
    first = _result(bench, Run(name, None, None, 0)).values
    originals = [_result(bench, Run(name, None, None, seed)).test for seed in every]
    return {
        "set": name, "model": first["model"], "settings": first["settings"], "torch": first["torch"],
        "train_images": first["train_images"], "validation_images": first["validation_images"], "test_images": first["test_images"],
        "original": _interval(originals), "chosen": chosen.name, "margin": plan.margin, "table": table,
        # Only the seeds of the figure, so that its lines compare pairs.
        "figure_original": float(np.mean(originals[:len(few)])), "figure": figure,
    }


def _row(bench: Bench, name: str, trained: Regions | None, tested: Regions, seeds: range) -> dict[str, Any]:
    """Compare a way of training and testing with the originals, seed by seed."""
    before = [_result(bench, Run(name, None, None, seed)) for seed in seeds]
    after = [_result(bench, Run(name, trained, tested, seed)) for seed in seeds]
    images = bootstrap(np.stack([one.correct for one in before]), np.stack([one.correct for one in after]))
    difference = _interval([two.test - one.test for one, two in zip(before, after)])
    pairs = [_pair(seed, one, two) for seed, one, two in zip(seeds, before, after)]
    ends = [abs(end) for end in (*images, difference["low"], difference["high"]) if end is not None]
    return {
        "trained": name_of(trained), "tested": tested.name, "min_score": tested.min_score, "seeds": len(seeds),
        "accuracy": _interval([one.test for one in after]), "tests": [one.test for one in after],
        "difference": difference, "bootstrap": list(images), "largest": max(ends),
        "mcnemar": pairs, "significant": sum(pair["p"] < 0.05 for pair in pairs),
        "validation": float(np.mean([one.validation for one in after])),
        "active_share": after[0].values["active_share"], "sent_share": after[0].values["sent_share"],
    }


def _pair(seed: int, before: Result, after: Result) -> dict[str, Any]:
    lost, won = int((before.correct & ~after.correct).sum()), int((after.correct & ~before.correct).sum())
    return {"seed": seed, "only_original": lost, "only_regions": won, "p": mcnemar(lost, won)}


def _interval(values: Sequence[float]) -> dict[str, Any]:
    mean, low, high = t_interval(values)
    known = len(values) > 1
    return {"mean": mean, "low": low if known else None, "high": high if known else None}
