# SPDX-License-Identifier: MIT OR Apache-2.0
"""Tests of the significance of a difference between two ways of training.

There are three of them. A t interval over paired seeds tests whether other seeds would change the difference, a bootstrap over images
whether other test images would, and McNemar's test whether one pair of networks could differ by chance.
"""
from __future__ import annotations

import math
from collections.abc import Sequence
from typing import Any

import numpy as np
from numpy.typing import NDArray

__all__ = ["bootstrap", "mcnemar", "t_interval", "t_quantile"]

#: The 97.5 % quantiles of Student's t for 1 to 30 degrees of freedom.
_QUANTILES = (
    12.7062, 4.3027, 3.1824, 2.7764, 2.5706, 2.4469, 2.3646, 2.3060, 2.2622, 2.2281, 2.2010, 2.1788, 2.1604, 2.1448, 2.1314,
    2.1199, 2.1098, 2.1009, 2.0930, 2.0860, 2.0796, 2.0739, 2.0687, 2.0639, 2.0595, 2.0555, 2.0518, 2.0484, 2.0452, 2.0423,
)
#: The 97.5 % quantile of the normal distribution.
_NORMAL = 1.959964


def t_quantile(freedom: int) -> float:
    """Return the 97.5 % quantile of Student's t, exact to 4 digits.

    Above 30 degrees of freedom the first terms of its expansion at the normal distribution are enough (Abramowitz and Stegun 26.7.5).
    """
    if freedom < 1:
        raise ValueError(f"freedom = {freedom}: expected 1 or more")
    if freedom <= len(_QUANTILES):
        return _QUANTILES[freedom - 1]
    z = _NORMAL
    return z + (z**3 + z) / (4 * freedom) + (5 * z**5 + 16 * z**3 + 3 * z) / (96 * freedom * freedom)


def t_interval(differences: Sequence[float]) -> tuple[float, float, float]:
    """Return the mean of differences of paired runs, and the ends of its 95 % interval, which are nan for a single difference."""
    values = np.asarray(differences, float)
    mean = float(values.mean())
    if len(values) < 2:
        return mean, float("nan"), float("nan")
    half_width = t_quantile(len(values) - 1) * float(values.std(ddof=1)) / math.sqrt(len(values))
    return mean, mean - half_width, mean + half_width


def mcnemar(only_first: int, only_second: int) -> float:
    """Return the exact two-sided p of McNemar's test.

    Parameters
    ----------
    only_first, only_second : int
        Number of images that only the first network, or only the second one, gets right.

    Returns
    -------
    float
        Probability of a split at least as uneven, if each of these images were right in either network with equal probability.
    """
    count, smaller = only_first + only_second, min(only_first, only_second)
    outcomes = term = 1
    for index in range(smaller):
        term = term * (count - index) // (index + 1)
        outcomes += term
    return min(1.0, 2 * outcomes / (1 << count))


def bootstrap(first: NDArray[Any], second: NDArray[Any], *, rounds: int = 2000, seed: int = 0) -> tuple[float, float]:
    """Return the 95 % interval of the difference of accuracy, ``second`` minus ``first``, over draws of test images with replacement.

    Parameters
    ----------
    first, second : arrays (seeds, images) of bool
        Flags of the images that each network gets right. Images are drawn, the same for all networks; networks are not.
    """
    per_image = second.mean(axis=0) - first.mean(axis=0)
    generator = np.random.default_rng(seed)
    means = [per_image[generator.integers(0, len(per_image), len(per_image))].mean() for _ in range(rounds)]
    low, high = np.quantile(means, (0.025, 0.975))
    return float(low), float(high)
