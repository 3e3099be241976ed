# SPDX-License-Identifier: BSD-3-Clause
"""What an expert is: it shows how a task is done, by actions of the environment."""

from __future__ import annotations

from abc import ABC, abstractmethod
from typing import Any

import gymnasium as gym
import numpy as np
import numpy.typing as npt

from sitl.envs.actions import Discrete

Floats = npt.NDArray[np.float64]


class Expert(ABC):
    """Chooses the actions of an environment's episodes."""

    name: str
    """What it is called in a dataset."""
    about: str
    """What it does, for the dataset's description."""

    @abstractmethod
    def begin(self, seed: int) -> None:
        """An episode has begun, whose reset had this seed."""

    @abstractmethod
    def act(self, observation: Any) -> Any:
        """The next action."""


class Shown:
    """Velocities as actions of an environment.

    Args:
        action: of the environment, with ``nearest``: a box, or a table.
    """

    def __init__(self, action: Any) -> None:
        self._action = action
        self._owed = np.zeros(4)
        """Forward, left, up [m/s], turn [rad/s] that rows of a table have given too little so far."""

    def begin(self) -> None:
        """An episode begins."""
        self._owed[:] = 0.0

    def action_for(self, velocity: Floats) -> Any:
        """The action that asks for a velocity; what a row of a table gives less or more is made good by the next."""
        action = self._action
        if not isinstance(action, Discrete):
            return action.nearest(velocity)
        wanted = velocity + self._owed
        chosen = action.nearest(wanted)
        self._owed = np.clip(wanted - action.table[chosen], -1.0, 1.0)
        return chosen


def named(env: gym.Env[Any, Any]) -> str:
    """What an environment is called in messages."""
    return "the environment" if env.spec is None else env.spec.id
