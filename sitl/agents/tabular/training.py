# SPDX-License-Identifier: BSD-3-Clause
"""Trains runs of Q-learning and Sarsa. A run that was interrupted goes on to the same bits as one that was not."""

from __future__ import annotations

import time
from collections.abc import Mapping
from pathlib import Path
from typing import Any

import gymnasium as gym
import numpy as np

from .. import environments
from ..errors import AgentError
from ..runs.config import EPISODES, RunConfig
from ..runs.episodes import Episode
from ..runs.files import read_arrays, write_arrays
from ..runs.folder import RunFolder
from ..runs.keeper import Keeper
from ..runs.watch import Watch
from .checks import Checks, loop_of
from .learner import Learner
from .policy import TablePolicy
from .settings import Settings
from .table import Table

MODEL, BEST = "model.npz", "best.npz"
"""The table as it is, with all that a run needs to go on; the best one of the checks."""
LIBRARIES = ()
LENGTH = {"episodes": EPISODES}


def settings(algorithm: str, given: Mapping[str, Any]) -> dict[str, Any]:
    """See ``Algorithm``; "as_coded": true begins with what the paper's code did."""
    figures = dict(given)
    base = Settings.as_coded(algorithm) if figures.pop("as_coded", False) is True else Settings()
    return Settings.of({**base.as_dict(), **figures}).as_dict()


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
    episode_of = loop_of(env, learner)
    checks = Checks(env, learner, folder.path / BEST)

    def checkpoint() -> None:
        progress = {"episodes": np.array(done), "steps": np.array(steps)}
        write_arrays(folder.path / MODEL, {**learner.arrays(), **progress})

    keeper = Keeper(folder, watch, checkpoint)
    try:
        while not _is_done(config.episodes, done) and not _is_done(config.steps, steps) and not watch.stop:
            start = time.perf_counter()
            learner.begin(done)
            outcome = episode_of(environments.seed_of(config.seed, done))
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
        raise AgentError(f"{path} is a table without a run's state: it cannot be gone on with")
    try:
        learner.restore(arrays)
    except AgentError as error:
        raise AgentError(f"{path} cannot be gone on with: {error}") from None
    episodes, steps = (int(number) for number in done)
    folder.episodes.keep(episodes)
    return episodes, steps


def _is_done(limit: int | None, count: int) -> bool:
    return limit is not None and count >= limit
