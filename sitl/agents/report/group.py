# SPDX-License-Identifier: BSD-3-Clause
"""What is compared: the same run with several seeds, under a name."""

from __future__ import annotations

from collections.abc import Sequence
from functools import cached_property
from pathlib import Path

import numpy as np

from ..errors import AgentError
from ..runs import folder as folders
from ..runs.config import RunConfig
from ..runs.folder import RunFolder
from .document import BLOCK, Floats, block_means, rewards_of


class Group:
    """Runs that differ in their seeds only.

    Args:
        name: in tables and pictures.
        runs: at least one.

    Raises:
        AgentError: they differ in more, or two have the same seed and so are one run.
    """

    def __init__(self, name: str, runs: Sequence[RunFolder]) -> None:
        self.name, self.runs = name, list(runs)
        self.config: RunConfig = folders.common(self.runs)
        by_seed: dict[int, RunFolder] = {}
        for run in self.runs:
            other = by_seed.setdefault(run.config.seed, run)
            if other is not run:
                raise AgentError(
                    f"{other.path} and {run.path} both have seed {run.config.seed}: the same run counts once"
                )

    @classmethod
    def load(cls, path: str | Path, name: str | None = None) -> Group:
        """The runs of a folder."""
        return cls(name or Path(path).resolve().name, folders.find(path))

    @cached_property
    def rewards(self) -> Floats:
        """Shape (seeds, episodes); those episodes that all seeds have. Raises AgentError, see ``rewards_of``."""
        return rewards_of(self.runs)

    @cached_property
    def lengths(self) -> list[int]:
        """Number of episodes of each seed."""
        return [len(run.episodes.rows()) for run in self.runs]

    def first(self, episodes: int) -> Group:
        """A copy with the first episodes only."""
        cut = Group(self.name, self.runs)
        cut.rewards = self.rewards[:, :episodes]
        return cut

    def blocks(self, block: int = BLOCK) -> Floats:
        """Means of each ``block`` episodes, shape (seeds, blocks)."""
        return block_means(self.rewards, block)

    def last(self, block: int = BLOCK) -> Floats:
        """Mean reward of the last ``block`` episodes of each seed, shape (seeds,)."""
        out: Floats = self.rewards[:, -block:].mean(axis=1)
        return out

    def whole(self) -> Floats:
        """Mean reward of all episodes of each seed, shape (seeds,)."""
        out: Floats = self.rewards.mean(axis=1)
        return out

    @cached_property
    def best(self) -> float:
        """The best episode of all, its reward."""
        return float(self.rewards.max())

    @cached_property
    def wall_s(self) -> Floats:
        """Wall time of each seed [s], shape (seeds,)."""
        return np.array([run.episodes.column("wall_s").sum() for run in self.runs])

    @cached_property
    def simulated_s(self) -> Floats:
        """Simulated time of each seed [s], shape (seeds,)."""
        return np.array([run.episodes.column("simulated_s").sum() for run in self.runs])


def unique_names(paths: Sequence[Path]) -> list[str]:
    """Names of folders, with as much of their path as tells them apart."""
    parts = [path.resolve().parts for path in paths]
    for depth in range(1, max(map(len, parts), default=1) + 1):
        names = ["/".join(p[-depth:]) for p in parts]
        if len(set(names)) == len(names):
            return names
    return [str(path) for path in paths]
