# SPDX-License-Identifier: BSD-3-Clause
"""Environments with Safety-Gymnasium's interface: ``step`` returns the cost beside the reward, six values in all."""

from __future__ import annotations

from typing import Any

import gymnasium as gym
import numpy as np
import numpy.typing as npt
from gymnasium.vector import VectorEnv, VectorWrapper

from .costs import TOTAL
from .options import EnvOptionError

COST_SUM = "cost_sum"
"""Safety-Gymnasium's key of the sum of costs in ``info``."""
Floats = npt.NDArray[np.float64]


def _missing(env: Any) -> EnvOptionError:
    return EnvOptionError(f'{env} tells no cost: make it with the option costs, as costs=["proximity", "tilt"]')


class SafetyEnv(gym.Wrapper[Any, Any, Any, Any]):
    """An environment whose ``step`` returns observation, reward, cost, terminated, truncated, info.

    ``info`` has "cost_sum" in place of "cost", as Safety-Gymnasium's environments, and "cost_NAME" of each.

    Args:
        env: made with the option ``costs``; wrappers of Gymnasium go inside of this one.
    """

    def step(self, action: Any) -> tuple[Any, float, float, bool, bool, dict[str, Any]]:  # type: ignore[override]
        """See above."""
        observation, reward, terminated, truncated, info = self.env.step(action)
        if TOTAL not in info:
            raise _missing(self.env)
        cost = info[COST_SUM] = float(info.pop(TOTAL))
        return observation, float(reward), cost, terminated, truncated, info


class SafetyVectorEnv(VectorWrapper):
    """The same of a vector environment: observations, rewards, costs, terminated, truncated, infos.

    The costs of a step that ends an episode are among ``costs`` in each autoreset mode.

    Args:
        env: made with the option ``costs``.
    """

    def __init__(self, env: VectorEnv[Any, Any, Any]) -> None:
        super().__init__(env)

    def step(self, actions: Any) -> tuple[Any, Any, Floats, Any, Any, dict[str, Any]]:  # type: ignore[override]
        """See above."""
        observations, rewards, terminated, truncated, infos = self.env.step(actions)
        costs = np.zeros(self.num_envs)
        told = [found for found in (infos, infos.get("final_info")) if isinstance(found, dict) and TOTAL in found]
        if not told and (self.num_envs > 0 and infos):
            raise _missing(self.env)
        for found in told:
            costs += np.where(found["_" + TOTAL], found[TOTAL], 0.0)
            found[COST_SUM], found["_" + COST_SUM] = found.pop(TOTAL), found.pop("_" + TOTAL)
        return observations, rewards, costs, terminated, truncated, infos
