# SPDX-License-Identifier: BSD-3-Clause
"""A tabular learner: a table, the settings it learns by, random numbers. It chooses, learns, is saved and goes on."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any, NamedTuple

import gymnasium as gym
import numpy as np
import numpy.typing as npt

from sitl.core.kernels import jit_disabled
from sitl.core.records import Records
from sitl.core.rng import seed as seed_rng

from ..errors import AgentError
from .exploration import LearnerState, Memory, epsilon_in
from .learn import Move, choose_action, learn_step
from .settings import EXPLORATIONS, RULES, Settings
from .table import Table


class Learner:
    """Q-learning or Sarsa.

    Args:
        algorithm: "qlearn" or "sarsa".
        settings: hyper-parameters.
        table: what it has learnt already; it goes on with it.
        seed: seed of its random numbers.
        frozen: it plays greedily and does not learn.

    Raises:
        AgentError: no such algorithm.
    """

    def __init__(self, algorithm: str, settings: Settings, table: Table, seed: int = 0, frozen: bool = False) -> None:
        if algorithm not in RULES:
            raise AgentError(f"algorithm {algorithm!r}; a table is learnt by one of {', '.join(RULES)}")
        self.algorithm, self.settings, self.table = algorithm, settings, table
        self.record = LearnerState.fleet(1)
        self._view = view = LearnerState.of(self.record, 0)
        view.rule = RULES.index(algorithm)
        view.exploration = EXPLORATIONS.index(settings.exploration)
        view.first_visit, view.terminal_bootstrap = settings.first_visit, settings.terminal_bootstrap
        view.redraw, view.frozen = settings.redraw, frozen
        view.alpha, view.gamma = settings.alpha, settings.gamma
        view.states = len(table)
        self.seed(seed)
        self._records: Any = [view] if jit_disabled() else self.record

    @property
    def epsilon(self) -> float:
        """Probability of exploring."""
        return float(self._view.epsilon)

    @property
    def states(self) -> int:
        """Number of states in the table."""
        return int(self._view.states)

    def seed(self, seed: int) -> None:
        """Begin its random numbers anew."""
        seed_rng(self._view.rng, seed)

    def begin(self, episode: int) -> None:
        """An episode begins, the first being 0: epsilon is set."""
        s = self.settings
        self._view.epsilon = epsilon_in(episode, s.epsilon, s.epsilon_decay, s.epsilon_floor) * (not self._view.frozen)

    def arguments(self, new_states: int) -> tuple[Records[LearnerState], Memory]:
        """Record and table as ``learn`` takes them, with space for so many states more."""
        self.table.reserve(self.states, new_states)
        return self._records, self.table.memory

    def first_key(self, observation: Any) -> int:
        """Number of the state that an episode begins in."""
        return self.table.key(observation) + (self.table.size if self.settings.first_state_apart else 0)

    def choose(self, key: int) -> int:
        """The first action of an episode."""
        return choose_action.unchecked()(*self.arguments(1), int(key))

    def learn(self, key: int, action: int, reward: float, after: int, terminated: bool) -> int:
        """Learn from a step; returns the next action. See ``learn.learn``."""
        return learn_step.unchecked()(
            *self.arguments(1), Move(int(key), int(action), float(reward), int(after), bool(terminated))
        )

    def arrays(self) -> dict[str, npt.NDArray[Any]]:
        """All that ``restore`` needs to go on bit for bit."""
        return {**self.table.arrays(), "random": self.record["rng"]["s"][0].copy()}

    def restore(self, arrays: Mapping[str, npt.NDArray[Any]]) -> None:
        """Go back to what ``arrays`` gave.

        Raises:
            AgentError: it is of another kind of table, or has no random numbers.
        """
        random = self.record["rng"]["s"][0]
        stored = arrays.get("random", np.zeros(0))
        if stored.shape != random.shape or stored.dtype != random.dtype:
            raise AgentError("the model has no random numbers to go on with")
        table = Table.of_arrays(arrays)
        if table.radix.tolist() != self.table.radix.tolist() or table.actions != self.table.actions:
            raise AgentError(
                f"the model has digits {table.radix.tolist()} and {table.actions} actions; "
                f"the environment {self.table.radix.tolist()} and {self.table.actions}"
            )
        self.table = table
        self._view.states = len(table)
        self.record["rng"]["s"][0] = stored


class Outcome(NamedTuple):
    """Result of one episode."""

    steps: int
    reward: float
    """Sum."""
    terminated: bool
    """The episode ended by itself (a crash, in the paper's environments), not by the limit of steps."""


def learn_episode(
    env: gym.Env[Any, Any], learner: Learner, seed: int, options: dict[str, Any] | None = None
) -> Outcome:
    """Learn from an episode, after ``learner.begin``.

    Args:
        env: it must truncate its episodes (``gym.make(..., max_episode_steps=...)``).
        learner: the learner.
        seed: seed of the reset.
        options: options of the reset.
    """
    observation, _ = env.reset(seed=seed, options=options)
    key = learner.first_key(observation)
    action, steps, total = learner.choose(key), 0, 0.0
    while True:
        observation, reward, terminated, truncated, _ = env.step(action)
        after = learner.table.key(observation)
        following = learner.learn(key, action, float(reward), after, bool(terminated))
        key, action, steps, total = after, following, steps + 1, total + float(reward)
        if terminated or truncated:
            return Outcome(steps, total, bool(terminated))
