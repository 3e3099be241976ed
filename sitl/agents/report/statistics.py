# SPDX-License-Identifier: BSD-3-Clause
"""Statistics over seeds: interquartile mean with bootstrap intervals, probability of improvement, performance profiles.

Source: Agarwal et al., "Deep reinforcement learning at the edge of the statistical precipice", NeurIPS 2021; the
definitions are those of the authors' library rliable, the calculation is SciPy's. Rewards are not normalised, because
all compared runs come from one task. A single run has no spread: its intervals are nan. Functions that calculate an
interval or an interquartile mean raise MissingExtra where SciPy is not installed.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import Any

import numpy as np
import numpy.typing as npt

from sitl.errors import MissingExtra

Floats = npt.NDArray[np.float64]
RESAMPLES = 10_000
"""Number of bootstrap resamples."""


def scipy_stats() -> Any:
    """The module ``scipy.stats``. It is imported on first use, because the import takes about half a second.

    Raises:
        MissingExtra: SciPy is not installed.
    """
    try:
        from scipy import stats
    except ImportError:
        raise MissingExtra("intervals need scipy: pip install 'gym-sitl[report]'") from None
    return stats


def t_quantile(degrees: int) -> float:
    """97.5 % quantile of Student's t distribution: the half-width of a 95 % interval in standard errors."""
    return float(scipy_stats().t.ppf(0.975, degrees))


def mean_interval(samples: Floats) -> tuple[Floats, Floats]:
    """Mean over the first axis and the half-width of its 95 % interval (Student's t; nan of a single sample)."""
    count = samples.shape[0]
    mean = samples.mean(axis=0)
    if count < 2:
        return mean, np.full_like(mean, math.nan)
    return mean, t_quantile(count - 1) * samples.std(axis=0, ddof=1) / math.sqrt(count)


def difference(a: Floats, b: Floats) -> tuple[float, float]:
    """Mean of A less that of B, and half-width of its 95 % interval (Welch's); shapes (runs,).

    The half-width is nan when one of them is a single run. Degrees of freedom are rounded down, as published tables of
    t have them: the interval is a little wider than that of ``scipy.stats.ttest_ind``, which does not round.
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
    """Mean without the lowest and the highest quarter of the samples, along an axis; quarters are rounded down."""
    out: Floats = scipy_stats().trim_mean(samples, 0.25, axis=axis)
    return out


def _interval(
    statistic: Callable[..., Floats], samples: tuple[Floats, ...], seed: int, resamples: int
) -> tuple[Floats, Floats]:
    """Low and high end of a 95 % percentile bootstrap interval.

    Args:
        statistic: ``statistic(*samples, axis)`` reduces the last axis of each of its samples.
        samples: shapes (runs,); each is resampled independently of the others.
        seed: seed of the resampling.
        resamples: number of resamples.
    """
    result = scipy_stats().bootstrap(
        samples,
        statistic,
        axis=-1,
        vectorized=True,
        n_resamples=resamples,
        method="percentile",
        rng=np.random.default_rng(seed),
    )
    return result.confidence_interval.low, result.confidence_interval.high


def iqm_interval(scores: Floats, seed: int = 0, resamples: int = RESAMPLES) -> tuple[float, float, float]:
    """Interquartile mean of scores, and the ends of its 95 % bootstrap interval (nan of a single run).

    Args:
        scores: shape (runs,).
        seed: seed of the resampling.
        resamples: number of resamples.

    Returns:
        (interquartile mean, low end, high end).
    """
    value = float(interquartile_mean(scores))
    if len(scores) < 2:
        return value, math.nan, math.nan
    low, high = _interval(interquartile_mean, (scores,), seed, resamples)
    return value, float(low), float(high)


def improvement(a: Floats, b: Floats, axis: int = -1) -> Floats:
    """Probability that a run of A scores above a run of B, ties counting half; shapes (..., runs of A or of B)."""
    x, y = a[..., :, None], b[..., None, :]
    out: Floats = (x > y).mean(axis=(-2, -1)) + 0.5 * (x == y).mean(axis=(-2, -1))
    return out


def improvement_interval(a: Floats, b: Floats, seed: int = 0, resamples: int = RESAMPLES) -> tuple[float, float, float]:
    """``improvement`` with the ends of its 95 % bootstrap interval; nan when one of them is a single run."""
    value = float(improvement(a, b))
    if min(len(a), len(b)) < 2:
        return value, math.nan, math.nan
    low, high = _interval(improvement, (a, b), seed, resamples)
    return value, float(low), float(high)


def profile(scores: Floats, levels: Floats) -> Floats:
    """Share of the runs that score above each level; shapes (..., runs), (levels,) to (levels, ...)."""
    out: Floats = np.stack([(scores > level).mean(axis=-1) for level in levels])
    return out


def profile_interval(
    scores: Floats, levels: Floats, seed: int = 0, resamples: int = 2000
) -> tuple[Floats, Floats, Floats]:
    """``profile`` with the ends of its 95 % bootstrap interval at each level; nan of a single run."""
    fractions = profile(scores, levels)
    if len(scores) < 2:
        return fractions, np.full_like(fractions, math.nan), np.full_like(fractions, math.nan)
    return fractions, *_interval(lambda drawn, axis: profile(drawn, levels), (scores,), seed, resamples)


Z = 1.96
"""Quantile of the normal distribution for an interval of 95 %."""


def wilson(count: int, of: int) -> tuple[float, float]:
    """Ends of the 95 % interval of a share, 0 .. 1, of ``count`` in ``of`` independent trials.

    Source: Wilson, "Probable inference, the law of succession, and statistical inference", JASA 22, 1927.
    """
    p, n = count / of, float(of)
    middle, half = p + Z * Z / (2 * n), Z * math.sqrt(p * (1 - p) / n + Z * Z / (4 * n * n))
    low, high = ((middle + sign * half) / (1 + Z * Z / n) for sign in (-1, 1))
    return max(low, 0.0), min(high, 1.0)


def trained_interval(scores: Floats, seed: int = 0, resamples: int = 2000) -> tuple[float, float, float]:
    """Interquartile mean over trainings of their mean over episodes, and the ends of its 95 % bootstrap interval.

    All trainings play the same episodes, so both are drawn anew, with replacement and independently of each other:
    Owen, "The pigeonhole bootstrap", Annals of Applied Statistics 1, 2007. rliable's bootstrap would take the episodes
    for tasks and draw other trainings for each of them, which hides that trainings differ.

    Args:
        scores: of each episode, shape (trainings, episodes).
        seed: seed of the resampling.
        resamples: number of resamples.

    Returns:
        (interquartile mean, low end, high end); nan for the ends of a single training.
    """
    value = float(interquartile_mean(scores.mean(axis=1)))
    trainings, episodes = scores.shape
    if trainings < 2:
        return value, math.nan, math.nan
    rng = np.random.default_rng(seed)
    rows = rng.integers(trainings, size=(resamples, trainings))
    weights = rng.multinomial(episodes, np.full(episodes, 1.0 / episodes), size=resamples) / episodes
    means = np.take_along_axis(weights @ scores.T, rows, axis=1)
    low, high = np.percentile(interquartile_mean(means), (2.5, 97.5))
    return value, float(low), float(high)


def suite_interval(scores: Floats, seed: int = 0, resamples: int = RESAMPLES) -> tuple[float, float, float]:
    """Interquartile mean over all tasks and trainings, and the ends of its 95 % stratified bootstrap interval: the
    trainings of each task are drawn anew by themselves, as rliable does.

    Args:
        scores: one a training, shape (tasks, trainings).
        seed: seed of the resampling.
        resamples: number of resamples.
    """
    tasks, trainings = scores.shape
    value = float(interquartile_mean(scores.ravel()))
    if trainings < 2:
        return value, math.nan, math.nan
    rng = np.random.default_rng(seed)
    drawn = np.take_along_axis(scores[None], rng.integers(trainings, size=(resamples, tasks, trainings)), axis=2)
    low, high = np.percentile(interquartile_mean(drawn.reshape(resamples, -1)), (2.5, 97.5))
    return value, float(low), float(high)
