# SPDX-License-Identifier: BSD-3-Clause
"""Tries runs at home and under the changes of a plan, with the same episodes throughout."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from ..report.group import Group
from ..runs import folder as folders
from ..runs.folder import RunFolder
from ..runs.local import Told, each
from .change import Change
from .share import Floats, Share, advantage, share
from .trial import Result, Trial, attempt

EPISODES = 50
Each = Callable[..., list[Any]]
"""As ``sitl.agents.runs.local.each``."""


@dataclass(frozen=True)
class Tried:
    """Runs of a group under one change, or at home."""

    rewards: Floats
    """Shape (seeds, episodes); (0, 0) when it was refused."""
    crashed: Floats
    """1 for a crash; the same shape."""
    false_alarms: Floats
    """1 for a crash that was a reading only; the same shape."""
    refused: str = ""
    seen: bool = False
    """Whether the randomisation that they were trained with covers the change."""

    @classmethod
    def of(cls, results: Sequence[Result]) -> Tried:
        """Of one result for each seed."""
        refused = next((result.refused for result in results if result.refused), "")
        if refused:
            nothing = np.zeros((0, 0))
            return cls(nothing, nothing, nothing, refused)
        return cls(
            np.array([result.rewards for result in results]),
            np.array([result.crashed for result in results], np.float64),
            np.array([result.false_alarms for result in results], np.float64),
            seen=all(result.seen for result in results),
        )

    @property
    def mean(self) -> float:
        """Reward of an episode."""
        return float(self.rewards.mean())


@dataclass(frozen=True)
class Rehearsed:
    """What a group of runs, which differ in their seeds only, gave."""

    name: str
    runs: Sequence[RunFolder]
    home: Tried
    changes: Sequence[Change]
    tried: Sequence[Tried]
    """Under each change."""

    def shares(self) -> list[Share | None]:
        """Of the reward at home, under each change; None where it was not played."""
        return [None if tried.refused else share(self.home.rewards, tried.rewards) for tried in self.tried]

    def advantages(self, first: Rehearsed) -> list[Share | None]:
        """Over other runs under each change, see ``advantage``; None where one of the two was not played."""
        return [
            None if a.refused or b.refused else advantage(first.home.rewards, a.rewards, b.rewards)
            for a, b in zip(first.tried, self.tried)
        ]


def trials_of(
    runs: Sequence[RunFolder],
    changes: Sequence[Change],
    episodes: int | None = None,
    seed: int = 0,
    jitter: float | None = None,
) -> list[Trial]:
    """At home first, then under each change; for each, one trial a run.

    Args:
        runs: of a group.
        changes: that are tried.
        episodes: of a trial; None: as many as the run's evaluation has, ``EPISODES`` at most.
        seed: of the episodes.
        jitter: see ``Trial``.
    """
    out = []
    for change in (None, *changes):
        for run in runs:
            count = episodes or min(run.config.evaluation.episodes, EPISODES)
            least = count if change is None or change.episodes is None else min(count, change.episodes)
            out.append(Trial(run.path, change, least, seed, jitter))
    return out


def rehearse(
    groups: Sequence[Group],
    changes: Sequence[Change],
    episodes: int | None = None,
    seed: int = 0,
    jitter: float | None = None,
    jobs: int = 1,
    told: Told = lambda index, message: None,
    do: Each = each,
) -> list[Rehearsed] | None:
    """Try groups of runs; None when it was interrupted.

    Args:
        groups: names and runs.
        changes, episodes, seed, jitter: see ``trials_of``.
        jobs: how many processes.
        told: called with the number of a trial and 1 for each of its episodes.
        do: does the work for all trials, as ``sitl.agents.runs.local.each``.

    Raises:
        AgentError: a run cannot be played at home.
    """
    trials = [trials_of(group.runs, changes, episodes, seed, jitter) for group in groups]
    found = do(attempt, [trial for some in trials for trial in some], jobs, told)
    if any(result is None for result in found):
        return None
    out, first = [], 0
    for group, some in zip(groups, trials):
        folders.common(group.runs)
        results, first = found[first : first + len(some)], first + len(some)
        size = len(group.runs)
        home, *tried = [Tried.of(results[k : k + size]) for k in range(0, len(some), size)]
        out.append(Rehearsed(group.name, group.runs, home, list(changes), tried))
    return out
