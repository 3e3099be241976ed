# SPDX-License-Identifier: BSD-3-Clause
"""Trains runs of Q-learning and Sarsa. A run that was interrupted goes on to the same bits as one that was not.

Now and then the table of a run plays greedily, and the best one is kept.

With a constant step size a table never settles: the last one may crash where one of some episodes before drove for
hours. Learning does not notice the checks: they draw nothing from its random numbers.
"""

from __future__ import annotations

import time
from collections.abc import Callable, Mapping
from copy import copy
from functools import partial
from pathlib import Path
from typing import Any

import gymnasium as gym
import numpy as np

from .. import environments
from ..errors import AgentError, ResumeError
from ..evaluate import moved_starts
from ..policies import OneEach
from ..runs.config import EPISODES, RunConfig
from ..runs.curriculum import Curriculum
from ..runs.episodes import Episode
from ..runs.files import read_arrays, write_arrays
from ..runs.folder import Keeper, RunFolder
from ..runs.watch import Watch
from .compiled_loop import CompiledLoop
from .learner import Learner, Outcome, learn_episode
from .settings import Settings
from .table import Table


class TablePolicy:
    """Takes the best action of each state; one of the best at random when there are more.

    Args:
        table: table of values.
        epsilon: probability of a random action.
        first_state_apart: see ``Settings``.
    """

    def __init__(self, table: Table, epsilon: float = 0.0, first_state_apart: bool = False) -> None:
        self.table, self.epsilon = table, epsilon
        self.unknown = 0
        """Number of look-ups of a state that is not in the table."""
        self._rng = np.random.default_rng(0)
        self._apart = table.size if first_state_apart else 0
        self._offset = 0

    def check(self, observations: gym.Space[Any], actions: gym.Space[Any]) -> None:
        """See ``Policy``."""
        wanted = Table.for_spaces(observations, actions)
        mine, theirs = (self.table.radix.tolist(), self.table.actions), (wanted.radix.tolist(), wanted.actions)
        if mine != theirs:
            raise AgentError(
                f"the table is for digits {mine[0]} and {mine[1]} actions; here are {theirs[0]} and {theirs[1]}"
            )

    def begin(self, seed: int) -> None:
        """See ``Policy``."""
        self._rng = np.random.default_rng(seed)
        self._offset = self._apart

    def act(self, observation: Any) -> int:
        """See ``Policy``."""
        row = self.table.row(self.table.key(observation) + self._offset)
        self._offset = 0
        if self.epsilon > 0.0 and self._rng.random() < self.epsilon:
            return int(self._rng.integers(len(row)))
        if not row.any():
            self.unknown += 1
        best = np.flatnonzero(row == row.max())
        return int(best[0] if len(best) == 1 else self._rng.choice(best))

    def many(self, count: int) -> OneEach:
        """See ``Policy``."""
        return OneEach([copy(self) for _ in range(count)])


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
        """Score of the table, the most important number first; greater is better."""
        player = self._player
        player.table = self._learner.table
        player.seed(SEED)
        seeds = (environments.seed_of(SEED, k) for k in range(len(self._options)))
        played = [self._play(seed, options) for seed, options in zip(seeds, self._options)]
        reward = float(np.mean([one.reward for one in played]))
        if player.settings.check_by == "crashes":
            return -float(sum(one.terminated for one in played)), reward
        return (reward,)


MODEL, BEST = "model.npz", "best.npz"
"""The table as it is, with all that a run needs to go on; the best one of the checks."""
LIBRARIES = ()
LENGTH = {"episodes": EPISODES}


def settings(algorithm: str, given: Mapping[str, Any]) -> dict[str, Any]:
    """See ``Algorithm``; "as_coded": true begins with what the paper's code did."""
    changed = dict(given)
    base = Settings.as_coded(algorithm) if changed.pop("as_coded", False) is True else Settings()
    return Settings.of({**base.as_dict(), **changed}).as_dict()


def check(config: RunConfig, observations: gym.Space[Any], actions: gym.Space[Any]) -> None:
    """See ``Algorithm``."""
    Table.for_spaces(observations, actions)


def train(folder: RunFolder, watch: Watch) -> None:
    """See ``Algorithm``."""
    config = folder.config
    env = environments.make(config)
    table = Table.for_spaces(env.observation_space, env.action_space)
    learner = Learner(config.algorithm, Settings.of(config.settings), table, config.seed)
    done, steps = _resume(folder, learner)
    seconds = environments.step_time(env)
    episode_of, by_steps = loop_of(env, learner), partial(learn_episode, env, learner)
    wants_steps = watch.shows(env)
    checks = Checks(env, learner, folder.path / BEST)
    curriculum = Curriculum(config.curriculum, env)

    def checkpoint() -> None:
        progress = {"episodes": np.array(done), "steps": np.array(steps)}
        write_arrays(folder.path / MODEL, {**learner.arrays(), **progress})

    keeper = Keeper(folder, watch, checkpoint)
    try:
        while not _is_done(config.episodes, done) and not _is_done(config.steps, steps) and not watch.stop:
            start = time.perf_counter()
            learner.begin(done)
            curriculum.follow(steps)
            outcome = (by_steps if wants_steps() else episode_of)(environments.seed_of(config.seed, done))
            checks.after(done + 1)
            row = Episode(
                done, outcome.steps, outcome.reward, learner.epsilon, int(outcome.terminated),
                round(outcome.steps * seconds, 6), time.perf_counter() - start,
            )  # fmt: skip
            done, steps = done + 1, steps + outcome.steps
            keeper.take(row)
        keeper.save()
    finally:
        env.close()


def policy(folder: RunFolder) -> TablePolicy:
    """See ``Algorithm``: the best table of the checks, or the last one where there were none."""
    apart = Settings.of(folder.config.settings).first_state_apart
    return TablePolicy(load_table(folder.path), first_state_apart=apart)


def load_table(path: str | Path) -> Table:
    """The table of a run's folder, or of a file.

    Raises:
        AgentError: there is none.
    """
    path = Path(path)
    if path.is_dir():
        path = path / BEST if (path / BEST).exists() else path / MODEL
    return Table.load(path)


def _resume(folder: RunFolder, learner: Learner) -> tuple[int, int]:
    """Restore the learner from the run's model; returns the episodes and steps done."""
    path = folder.path / MODEL
    if not path.exists():
        folder.episodes.keep(0)
        (folder.path / BEST).unlink(missing_ok=True)
        return 0, 0
    arrays = read_arrays(path)
    done = [arrays.get(name, np.zeros(0)) for name in ("episodes", "steps")]
    if any(number.shape != () or number.dtype.kind != "i" or number < 0 for number in done):
        raise ResumeError(f"{path} is a table without a run's state: it cannot be gone on with")
    try:
        learner.restore(arrays)
    except AgentError as error:
        raise ResumeError(f"{path} cannot be gone on with: {error}") from None
    episodes, steps = (int(number) for number in done)
    folder.episodes.keep(episodes)
    return episodes, steps


def _is_done(limit: int | None, count: int) -> bool:
    return limit is not None and count >= limit
