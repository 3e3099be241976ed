# SPDX-License-Identifier: BSD-3-Clause
"""Rewards of runs as arrays, and their means over blocks of episodes, as the paper's table has them."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
import numpy.typing as npt

from ..errors import AgentError
from ..runs.folder import RunFolder

Floats = npt.NDArray[np.float64]
BLOCK = 200
"""Episodes of the paper's blocks."""


def rewards_of(runs: Sequence[RunFolder]) -> Floats:
    """Rewards of the episodes of runs, shape (runs, episodes); those episodes that all have.

    Raises:
        AgentError: a run has none, or one whose reward is no number.
    """
    rows = [run.episodes.column("reward") for run in runs]
    for run, row in zip(runs, rows):
        if not len(row):
            raise AgentError(f"{run.path} has no episodes yet")
        if not np.isfinite(row).all():
            first = int(np.argmin(np.isfinite(row)))
            raise AgentError(f"{run.path}: the reward of episode {first} is {row[first]}; such runs cannot be compared")
    shortest = min(map(len, rows))
    return np.array([row[:shortest] for row in rows])


def block_means(rewards: Floats, block: int = BLOCK) -> Floats:
    """Means of each ``block`` episodes; the last block may be shorter.

    Args:
        rewards: shape (..., episodes).
        block: episodes.
    """
    starts = range(0, rewards.shape[-1], block)
    return np.stack([rewards[..., start : start + block].mean(axis=-1) for start in starts], axis=-1)


def block_names(episodes: int, block: int = BLOCK) -> list[str]:
    """Names of the blocks of ``block_means``: "0 to 200" are episodes 0 .. 199; the last block may be shorter."""
    return [f"{start} to {min(start + block, episodes)}" for start in range(0, episodes, block)]


def moving_mean(rewards: Floats, window: int) -> Floats:
    """Mean of each episode and those before it, up to ``window`` of them; shape as given."""
    sums = np.concatenate([np.zeros((*rewards.shape[:-1], 1)), np.cumsum(rewards, axis=-1)], axis=-1)
    last = np.arange(1, rewards.shape[-1] + 1)
    first = np.maximum(last - window, 0)
    out: Floats = (sums[..., last] - sums[..., first]) / (last - first)
    return out
