# SPDX-License-Identifier: BSD-3-Clause
"""The greedy policy of a table."""

from __future__ import annotations

from typing import Any

import gymnasium as gym
import numpy as np

from ..errors import AgentError
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
