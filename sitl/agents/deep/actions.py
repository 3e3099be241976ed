# SPDX-License-Identifier: BSD-3-Clause
"""Actions as networks give them: a number of a table, or numbers from -1 to 1."""

from __future__ import annotations

from typing import Any

import gymnasium as gym
import numpy as np
import numpy.typing as npt

from ..errors import AgentError

_TAKES = {"dqn": "discrete", "sac": "continuous"}


class Actions:
    """Converts the actions of a network to those of an environment.

    Args:
        space: space of the environment's actions.
        algorithm: "dqn", "ppo" or "sac".

    Raises:
        AgentError: the algorithm does not take such actions.
    """

    def __init__(self, space: gym.Space[Any], algorithm: str) -> None:
        form = "discrete" if isinstance(space, gym.spaces.Discrete) else "continuous"
        if form == "continuous" and not isinstance(space, gym.spaces.Box):
            raise AgentError(f"actions {space} are neither a table nor a box")
        if _TAKES.get(algorithm, form) != form:
            raise AgentError(f"{algorithm} learns {_TAKES[algorithm]} actions: --option action={_TAKES[algorithm]}")
        self.environment = space
        """Action space of the environment."""
        self._box = space if isinstance(space, gym.spaces.Box) else None
        self.space: gym.Space[Any] = (
            space if self._box is None else gym.spaces.Box(-1.0, 1.0, self._box.shape, np.float32)
        )
        """Action space of the network."""

    def to_environment(self, actions: npt.NDArray[Any]) -> npt.NDArray[Any]:
        """The environment's actions for the network's; both have a row a robot."""
        if self._box is None:
            return actions.astype(np.int64)
        low, high = self._box.low, self._box.high
        within = low + (0.5 * (np.clip(actions, -1.0, 1.0) + 1.0)).astype(np.float32) * (high - low)
        return np.clip(within, low, high)
