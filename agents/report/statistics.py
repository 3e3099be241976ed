# SPDX-License-Identifier: BSD-3-Clause
"""Statistics over seeds: interquartile mean with bootstrap intervals, probability of improvement, performance profiles.

Source: Agarwal et al., "Deep reinforcement learning at the edge of the statistical precipice", NeurIPS 2021.
"""

from __future__ import annotations

import math
from collections.abc import Callable

import numpy as np
import numpy.typing as npt

Floats = npt.NDArray[np.float64]
RESAMPLES = 2000
"""Of a bootstrap."""


def t_quantile(degrees: int) -> float:
    """Of Student's distribution at 97.5 %: the half-width of a 95 % interval in standard errors."""
    if degrees < 1:
        return math.nan
    if degrees == 1:
        return 12.7062047
    if degrees == 2:
        return 4.3026527
    if degrees == 3:
        return 3.1824463
    z, n = 1.959963985, float(degrees)  # Cornish and Fisher's expansion
    z2 = z * z
    terms = (
        (z2 + 1.0) / 4.0,
        ((5.0 * z2 + 16.0) * z2 + 3.0) / 96.0,
        (((3.0 * z2 + 19.0) * z2 + 17.0) * z2 - 15.0) / 384.0,
        ((((79.0 * z2 + 776.0) * z2 + 1482.0) * z2 - 1920.0) * z2 - 945.0) / 92160.0,
    )
    return z * (1.0 + sum(term / n ** (k + 1) for k, term in enumerate(terms)))


def mean_interval(samples: Floats) -> tuple[Floats, Floats]:
    """Mean over the first axis and half-width of its 95 % interval (Student's); nan half-width of a single sample."""
    count = samples.shape[0]
    mean = samples.mean(axis=0)
    if count < 2:
        return mean, np.full_like(mean, math.nan)
    return mean, t_quantile(count - 1) * samples.std(axis=0, ddof=1) / math.sqrt(count)


def interquartile_mean(samples: Floats, axis: int = -1) -> Floats:
    """Mean of the middle half of samples; those at its edges count in part."""
    ordered = np.sort(samples, axis=axis)
    count = ordered.shape[axis]
    place = np.arange(count)
    weights = np.clip(np.minimum(place + 1.0, 0.75 * count) - np.maximum(place, 0.25 * count), 0.0, 1.0)
    out: Floats = np.average(ordered, axis=axis, weights=weights)
    return out


def bootstrap(
    samples: Floats, figure: Callable[[Floats], Floats], seed: int = 0, resamples: int = RESAMPLES
) -> tuple[float, float, float]:
    """A figure of scores and its 95 % interval: percentiles over stratified resamples.

    Args:
        samples: scores, shape (tasks, runs); runs are drawn anew within each task.
        figure: of arrays of shape (n, tasks, runs), shape (n,).
        seed: of the drawing.
        resamples: how many.

    Returns:
        the figure, low and high end of its interval.
    """
    rng = np.random.default_rng(seed)
    tasks, runs = samples.shape
    drawn = rng.integers(runs, size=(resamples, tasks, runs))
    figures = figure(np.take_along_axis(samples[None], drawn, axis=2))
    low, high = np.percentile(figures, [2.5, 97.5])
    return float(figure(samples[None])[0]), float(low), float(high)


def iqm(samples: Floats) -> Floats:
    """Interquartile mean over tasks and runs, for ``bootstrap``."""
    return interquartile_mean(samples.reshape(len(samples), -1))


def improvement(a: Floats, b: Floats) -> float:
    """Probability that a run of A scores above a run of B, ties counting half; shapes (runs,)."""
    above = a[:, None] > b[None, :]
    equal = a[:, None] == b[None, :]
    return float(above.mean() + 0.5 * equal.mean())


def improvement_interval(a: Floats, b: Floats, seed: int = 0, resamples: int = RESAMPLES) -> tuple[float, float, float]:
    """``improvement`` with the ends of its 95 % bootstrap interval."""
    rng = np.random.default_rng(seed)
    x = a[rng.integers(len(a), size=(resamples, len(a)))]
    y = b[rng.integers(len(b), size=(resamples, len(b)))]
    above = (x[:, :, None] > y[:, None, :]).mean(axis=(1, 2)) + 0.5 * (x[:, :, None] == y[:, None, :]).mean(axis=(1, 2))
    low, high = np.percentile(above, [2.5, 97.5])
    return improvement(a, b), float(low), float(high)


def profile(scores: Floats, levels: Floats) -> Floats:
    """Share of runs that score above each level; shapes (runs,), (levels,)."""
    out: Floats = (scores[:, None] > levels[None, :]).mean(axis=0)
    return out
