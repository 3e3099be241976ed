# SPDX-License-Identifier: BSD-3-Clause
"""Ratio of the reward under a change to that without it, with bootstrap intervals over paired episodes and seeds."""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import NamedTuple

import numpy as np
import numpy.typing as npt

Floats = npt.NDArray[np.float64]
Ints = npt.NDArray[np.int64]
RESAMPLES = 2000


class Ratio(NamedTuple):
    """A ratio and its 95 % interval."""

    value: float
    """nan when the reward without the change is not above 0."""
    low: float
    high: float


def times_drawn(boots: Sequence[int], rng: np.random.Generator, resamples: int = RESAMPLES) -> Floats | None:
    """How often each episode is in each of some resamples of boots, which come with all of their episodes, shape
    (resamples, episodes); None where no two episodes share a boot, or all do: then episodes are to be drawn.

    Errors of the sensors and of the estimate are alike in episodes that began with the same boot. A resample of single
    episodes would take them for independent, and its interval would be too narrow: the cluster bootstrap, Davison and
    Hinkley, "Bootstrap Methods and their Application", 1997, section 3.8.
    """
    kinds, which = np.unique(np.asarray(boots, np.int64), return_inverse=True)
    if len(kinds) < 2 or len(kinds) == len(which):
        return None
    counts = np.zeros((resamples, len(kinds)))
    np.add.at(counts, (np.arange(resamples)[:, None], rng.integers(len(kinds), size=counts.shape)), 1.0)
    return counts[:, which]


def drawn(rewards: Floats, rows: Ints, times: Floats) -> Floats:
    """Mean rewards of resamples, shape (resamples,).

    Args:
        rewards: shape (seeds, episodes).
        rows: seeds of each resample, shape (resamples, seeds, 1).
        times: see ``times_drawn``.
    """
    means: Floats = rewards[rows[:, :, 0]].mean(axis=1)
    out: Floats = (times * means).sum(axis=1) / times.sum(axis=1)
    return out


def resampled(
    home: Floats, changed: Floats, seed: int = 0, resamples: int = RESAMPLES, boots: Sequence[int] = ()
) -> tuple[Floats, Floats]:
    """Mean rewards of bootstrap resamples, both of shape (resamples,). SciPy's bootstrap cannot resample seeds and then
    paired episodes of each.

    Seeds are drawn where there is more than one, then episodes of each, or boots with all of their episodes; an episode
    under the change comes with the same episode at home.

    Args:
        home, changed: rewards, shape (seeds, episodes); of ``home`` the first episodes, where ``changed`` has fewer.
        seed: seed of the resampling.
        resamples: number of resamples.
        boots: number of the boot that each episode began with, at least as many as ``changed`` has episodes; (): none.
    """
    rng = np.random.default_rng(seed)
    seeds, episodes = changed.shape
    rows = rng.integers(seeds, size=(resamples, seeds, 1))
    times = times_drawn(boots[:episodes], rng, resamples)
    if times is not None:
        return drawn(home[:, :episodes], rows, times), drawn(changed, rows, times)
    columns = rng.integers(episodes, size=(resamples, seeds, episodes))
    return home[rows, columns].mean(axis=(1, 2)), changed[rows, columns].mean(axis=(1, 2))


def transfer_ratio(home: Floats, changed: Floats, boots: Sequence[int] = ()) -> Ratio:
    """Mean reward under a change relative to that without it, over the same episodes; shapes (seeds, episodes).
    ``boots``: see ``resampled``."""
    paired = home[:, : changed.shape[1]]
    if paired.mean() <= 0.0:
        return Ratio(math.nan, math.nan, math.nan)
    a, b = resampled(paired, changed, boots=boots)
    low, high = np.nanpercentile(b / np.where(a > 0.0, a, math.nan), [2.5, 97.5])
    return Ratio(float(changed.mean() / paired.mean()), float(low), float(high))


def advantage(home: Floats, first: Floats, other: Floats, boots: Sequence[int] = ()) -> Ratio:
    """Gain in mean reward of other runs over the first ones under the same change, relative to the first ones' reward
    without
    it. Both have the same reference, unlike two transfer ratios.

    Seeds of the two are drawn independently, as they were trained; episodes are the same.

    Args:
        home, first: of the first runs, shape (seeds, episodes).
        other: of the others, shape (other seeds, episodes).
        boots: see ``resampled``.
    """
    episodes = min(first.shape[1], other.shape[1])
    base = float(home[:, :episodes].mean())
    if base <= 0.0:
        return Ratio(math.nan, math.nan, math.nan)
    rng = np.random.default_rng(0)
    times = times_drawn(boots[:episodes], rng)
    columns = rng.integers(episodes, size=(RESAMPLES, 1, episodes))
    rows = [rng.integers(len(runs), size=(RESAMPLES, len(runs), 1)) for runs in (first, other)]
    if times is None:
        means = [runs[picked, columns].mean(axis=(1, 2)) for runs, picked in zip((first, other), rows)]
    else:
        means = [drawn(runs[:, :episodes], picked, times) for runs, picked in zip((first, other), rows)]
    low, high = np.percentile((means[1] - means[0]) / base, [2.5, 97.5])
    return Ratio(float(other[:, :episodes].mean() - first[:, :episodes].mean()) / base, float(low), float(high))


def mean_of(ratios: list[Ratio | None]) -> float:
    """Mean of the ratios that exist; nan of none."""
    values = [s.value for s in ratios if s is not None and not math.isnan(s.value)]
    return float(np.mean(values)) if values else math.nan
