# SPDX-License-Identifier: BSD-3-Clause
"""How much of a reward transfers, with bootstrap intervals over paired episodes and over seeds."""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np
import numpy.typing as npt

Floats = npt.NDArray[np.float64]
RESAMPLES = 2000


class Share(NamedTuple):
    """A figure and its 95 % interval."""

    value: float
    """nan where there is none: no reward at home."""
    low: float
    high: float


def resampled(home: Floats, changed: Floats, seed: int = 0, resamples: int = RESAMPLES) -> tuple[Floats, Floats]:
    """Mean rewards of bootstrap resamples, of both, shape (resamples,).

    Seeds are drawn where there is more than one, then episodes of each; an episode under the change comes with the
    same episode at home.

    Args:
        home, changed: rewards, shape (seeds, episodes); of ``home`` the first episodes, where ``changed`` has fewer.
        seed: of the drawing.
        resamples: how many.
    """
    rng = np.random.default_rng(seed)
    seeds, episodes = changed.shape
    rows = rng.integers(seeds, size=(resamples, seeds, 1))
    columns = rng.integers(episodes, size=(resamples, seeds, episodes))
    return home[rows, columns].mean(axis=(1, 2)), changed[rows, columns].mean(axis=(1, 2))


def share(home: Floats, changed: Floats) -> Share:
    """Mean reward under a change as a share of that at home, of the same episodes."""
    paired = home[:, : changed.shape[1]]
    if paired.mean() <= 0.0:
        return Share(math.nan, math.nan, math.nan)
    a, b = resampled(paired, changed)
    low, high = np.nanpercentile(b / np.where(a > 0.0, a, math.nan), [2.5, 97.5])
    return Share(float(changed.mean() / paired.mean()), float(low), float(high))


def advantage(home: Floats, first: Floats, other: Floats) -> Share:
    """By how much the mean reward of other runs is above that of the first ones under the same change, as a share of
    the first ones' reward at home: one measure for both, which a share of one's own home is not.

    Seeds of the two are drawn independently, as they were trained; episodes are the same.

    Args:
        home, first: of the first runs, shape (seeds, episodes).
        other: of the others, shape (other seeds, episodes).
    """
    episodes = min(first.shape[1], other.shape[1])
    base = float(home[:, :episodes].mean())
    if base <= 0.0:
        return Share(math.nan, math.nan, math.nan)
    rng = np.random.default_rng(0)
    columns = rng.integers(episodes, size=(RESAMPLES, 1, episodes))
    rows = [rng.integers(len(runs), size=(RESAMPLES, len(runs), 1)) for runs in (first, other)]
    means = [runs[picked, columns].mean(axis=(1, 2)) for runs, picked in zip((first, other), rows)]
    low, high = np.percentile((means[1] - means[0]) / base, [2.5, 97.5])
    return Share(float(other[:, :episodes].mean() - first[:, :episodes].mean()) / base, float(low), float(high))


def mean_of(shares: list[Share | None]) -> float:
    """Mean of the shares that there are; nan of none."""
    values = [s.value for s in shares if s is not None and not math.isnan(s.value)]
    return float(np.mean(values)) if values else math.nan
