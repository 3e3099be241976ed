# SPDX-License-Identifier: BSD-3-Clause
"""Now and then the table of a run plays greedily, and the best one is kept.

With a constant step size a table never settles: the last one may crash where one of some episodes before drove for
hours. Learning does not notice the checks: they draw nothing from its random numbers.
"""

from __future__ import annotations

from collections.abc import Callable
from functools import partial
from pathlib import Path
from typing import Any

import gymnasium as gym
import numpy as np

from .. import environments
from ..errors import AgentError
from ..evaluate import moved_starts
from ..runs.files import read_arrays, write_arrays
from .compiled_loop import CompiledLoop
from .learner import Learner
from .loop import learn_episode
from .outcome import Outcome

JITTER = 0.1
"""Distance by which starts are moved, in x and y [m] and yaw [rad]; from one start a robot without noise always does
the same."""
SEED = 2**31
"""Seed of starts, resets and choices between equal values; the same for every table."""


def loop_of(env: gym.Env[Any, Any], learner: Learner) -> Callable[..., Outcome]:
    """``learn_episode`` for these two, compiled where that is possible."""
    return CompiledLoop(env, learner) if CompiledLoop.suits(env) else partial(learn_episode, env, learner)


class Checks:
    """Evaluates the table of one run at intervals and keeps the best one.

    Args:
        env: environment that it learns in; it is reset for each check.
        learner: learner whose table plays; its settings say how often.
        path: path of the best table.
    """

    def __init__(self, env: gym.Env[Any, Any], learner: Learner, path: Path) -> None:
        self._learner, self._path = learner, path
        self._every, count = learner.settings.check_every, learner.settings.check_episodes
        self._best: tuple[float, ...] = ()
        if self._every == 0:
            return
        if path.exists():
            arrays = read_arrays(path)
            if "score" not in arrays:
                raise AgentError(f"{path} has no score: it is not the best table of a run")
            self._best = tuple(np.atleast_1d(arrays["score"]).tolist())
        self._player = Learner(learner.algorithm, learner.settings, learner.table, frozen=True)
        self._player.begin(0)
        self._play = loop_of(env, self._player)
        self._options: list[dict[str, Any] | None] = [None] * count
        if hasattr(env.unwrapped, "robot"):
            self._options = [{"pose": pose} for pose in moved_starts(env, count, SEED, JITTER)]

    def after(self, episodes: int) -> None:
        """Called after ``episodes`` episodes in all; checks the table when it is due."""
        if self._every == 0 or episodes % self._every:
            return
        score = self.score()
        if score > self._best:
            self._best = score
            extra = {"score": np.array(score), "episodes": np.array(episodes)}
            write_arrays(self._path, {**self._learner.table.arrays(), **extra})

    def score(self) -> tuple[float, ...]:
        """Score of the table, the most important figure first; greater is better."""
        player = self._player
        player.table = self._learner.table
        player.seed(SEED)
        seeds = (environments.seed_of(SEED, k) for k in range(len(self._options)))
        played = [self._play(seed, options) for seed, options in zip(seeds, self._options)]
        reward = float(np.mean([one.reward for one in played]))
        if player.settings.check_by == "crashes":
            return -float(sum(one.terminated for one in played)), reward
        return (reward,)
