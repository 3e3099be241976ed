# SPDX-License-Identifier: BSD-3-Clause
"""Tries runs at home and under the changes of a plan, with the same episodes throughout."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from .. import environments, recipes
from ..errors import AgentError
from ..recipes import Recipe
from ..report.group import Group
from ..runs import folder as folders
from ..runs.backends import Workers
from ..runs.folder import RunFolder
from ..runs.local import OnProgress
from .change import Change
from .plan import Plan
from .transfer_ratio import Floats, Ratio, advantage, transfer_ratio
from .trial import Result, Trial, attempt

EPISODES = 50


@dataclass(frozen=True)
class Tried:
    """Results of a group of runs under one change, or without one."""

    rewards: Floats
    """Rewards, shape (seeds, episodes); (0, 0) when the change was refused."""
    crashed: Floats
    """1 for an episode with a crash, else 0; the same shape."""
    false_alarms: Floats
    """1 for a crash that was a lidar reading only, else 0; the same shape."""
    refused: str = ""
    seen: bool = False
    """Whether the randomisation that they were trained with covers the change."""
    boots: Sequence[int] = ()
    """Number of the boot that each episode began with, in all runs; (): see ``Result``."""

    @classmethod
    def of(cls, results: Sequence[Result]) -> Tried:
        """From the results of each seed."""
        refused = next((result.refused for result in results if result.refused), "")
        if refused:
            nothing = np.zeros((0, 0))
            return cls(nothing, nothing, nothing, refused)
        return cls(
            np.array([result.rewards for result in results]),
            np.array([result.crashed for result in results], np.float64),
            np.array([result.false_alarms for result in results], np.float64),
            seen=all(result.seen for result in results),
            boots=results[0].boots,
        )

    @property
    def mean(self) -> float:
        """Mean reward of an episode."""
        return float(self.rewards.mean())


@dataclass(frozen=True)
class Rehearsed:
    """Results of a group of runs that differ in their seeds only."""

    name: str
    runs: Sequence[RunFolder]
    home: Tried
    changes: Sequence[Change]
    tried: Sequence[Tried]
    """Results under each change."""

    def transfer_ratios(self) -> list[Ratio | None]:
        """Reward under each change relative to that without it; None where it was not played."""
        return [
            None if tried.refused else transfer_ratio(self.home.rewards, tried.rewards, self.home.boots)
            for tried in self.tried
        ]

    def advantages(self, first: Rehearsed) -> list[Ratio | None]:
        """Advantage over other runs under each change, see ``advantage``; None where one of the two was not played."""
        return [
            None if a.refused or b.refused else advantage(first.home.rewards, a.rewards, b.rewards, first.home.boots)
            for a, b in zip(first.tried, self.tried)
        ]


def trials_of(
    runs: Sequence[RunFolder],
    changes: Sequence[Change],
    episodes: int | None = None,
    seed: int = 0,
    jitter: float | None = None,
    boots: int | None = None,
) -> list[Trial]:
    """Trials without a change first, then under each change; one trial a run.

    Args:
        runs: runs of a group.
        changes: changes that are tried.
        episodes: episodes of a trial; None: as many as the run's evaluation has, ``EPISODES`` at most.
        seed: seed of the episodes.
        jitter, boots: see ``Trial``.
    """
    out = []
    for change in (None, *changes):
        for run in runs:
            count = episodes or min(run.config.evaluation.episodes, EPISODES)
            least = count if change is None or change.episodes is None else min(count, change.episodes)
            out.append(Trial(run.path, change, least, seed, jitter, boots))
    return out


def rehearse(
    groups: Sequence[Group],
    changes: Sequence[Change],
    episodes: int | None = None,
    seed: int = 0,
    jitter: float | None = None,
    on_progress: OnProgress = lambda index, message: None,
    pool: Workers | None = None,
    boots: int | None = None,
) -> list[Rehearsed] | None:
    """Try groups of runs; None when it was interrupted.

    Args:
        groups: names and runs.
        changes, episodes, seed, jitter, boots: see ``trials_of``.
        on_progress: called with the number of a trial and 1 for each of its episodes.
        pool: who flies the trials; None: this process.

    Raises:
        AgentError: a run cannot be played at home.
    """
    trials = [trials_of(group.runs, changes, episodes, seed, jitter, boots) for group in groups]
    pool = pool or Workers()
    found = pool.each(attempt, [trial for some in trials for trial in some], pool.jobs, on_progress)
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


PLAIN, RANDOMISED = "plain", "randomised"


def recipes_of(plan: Plan, steps: int | None = None) -> dict[str, Recipe]:
    """The plan's recipe as it is, and with its domain randomisation; both as long.

    Args:
        plan: with a recipe.
        steps: steps of a training; None: as the plan says, or else the recipe.

    Raises:
        AgentError: the plan says no recipe, or its randomisation is none of the robot's.
        MissingExtra: the algorithm needs what is not installed.
    """
    if "recipe" not in plan.training or not plan.randomise:
        raise AgentError(f"plan {plan.name}: a benchmark needs training.recipe and randomise")
    recipe = recipes.load(plan.training["recipe"])
    length: dict[str, Any] = {key: plan.training.get(key) for key in ("episodes", "steps")}
    if steps is not None:
        length = {"episodes": None, "steps": steps}
    if any(length.values()):
        recipe = replace(recipe, **length)
    env = environments.make(recipe.config())
    try:
        drawn = plan.randomisation(env.unwrapped.robot)  # type: ignore[attr-defined]
    finally:
        env.close()
    own = recipe.options.get("randomise") or {}
    name = f"{plan.name}-{{}}"
    return {
        PLAIN: replace(recipe, name=name.format(PLAIN)),
        RANDOMISED: replace(
            recipe, name=name.format(RANDOMISED), options={**recipe.options, "randomise": {**own, **drawn}}
        ),
    }
