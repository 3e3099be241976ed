# SPDX-License-Identifier: BSD-3-Clause
"""Statistics over seeds: interquartile mean with bootstrap intervals, probability of improvement, performance profiles.

Source: Agarwal et al., "Deep reinforcement learning at the edge of the statistical precipice", NeurIPS 2021; the
figures are those of the authors' library rliable. Rewards are taken as they are, not normalised: what is compared comes
from one task. One run has no spread to learn from, so that its intervals are nan.
"""

from __future__ import annotations

import math
from collections.abc import Callable

import numpy as np
import numpy.typing as npt

Floats = npt.NDArray[np.float64]
RESAMPLES = 10_000
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
    if degrees == 4:
        return 2.7764451
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


def difference(a: Floats, b: Floats) -> tuple[float, float]:
    """Mean of A less that of B, and half-width of its 95 % interval (Welch's); shapes (runs,).

    The half-width is nan when one of them is a single run. Degrees of freedom are rounded down.
    """
    apart = float(a.mean() - b.mean())
    if min(len(a), len(b)) < 2:
        return apart, math.nan
    x, y = float(a.var(ddof=1)) / len(a), float(b.var(ddof=1)) / len(b)
    if x + y == 0.0:
        return apart, 0.0
    degrees = (x + y) ** 2 / (x * x / (len(a) - 1) + y * y / (len(b) - 1))
    return apart, t_quantile(max(int(degrees), 1)) * math.sqrt(x + y)


def interquartile_mean(samples: Floats, axis: int = -1) -> Floats:
    """Mean of samples without the least and the greatest quarter of them, whose sizes are rounded down."""
    ordered = np.moveaxis(np.sort(samples, axis=axis), axis, -1)
    cut = ordered.shape[-1] // 4
    out: Floats = ordered[..., cut : ordered.shape[-1] - cut].mean(axis=-1)
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
        the figure, low and high end of its interval (nan of a single run).
    """
    rng = np.random.default_rng(seed)
    tasks, runs = samples.shape
    if runs < 2:
        return float(figure(samples[None])[0]), math.nan, math.nan
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
    """``improvement`` with the ends of its 95 % bootstrap interval; nan when one of them is a single run."""
    if min(len(a), len(b)) < 2:
        return improvement(a, b), math.nan, math.nan
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


def profile_interval(
    scores: Floats, levels: Floats, seed: int = 0, resamples: int = 2000
) -> tuple[Floats, Floats, Floats]:
    """``profile`` with the ends of its 95 % bootstrap interval at each level; nan of a single run."""
    shares = profile(scores, levels)
    runs = len(scores)
    if runs < 2:
        return shares, np.full_like(shares, math.nan), np.full_like(shares, math.nan)
    drawn = np.sort(scores[np.random.default_rng(seed).integers(runs, size=(resamples, runs))], axis=1)
    above = np.array([runs - np.searchsorted(row, levels, side="right") for row in drawn]) / runs
    low, high = np.percentile(above, [2.5, 97.5], axis=0)
    return shares, low, high
