# SPDX-License-Identifier: BSD-3-Clause
"""An environment with Safety-Gymnasium's interface: ``step`` returns the cost beside the reward, six values in all.

Of many robots: ``safety_vector``, which Gymnasium 0.29, as some libraries of safe learning want it, cannot load."""

from __future__ import annotations

from typing import Any

import gymnasium as gym

from .costs import TOTAL
from .options import EnvOptionError

COST_SUM = "cost_sum"
"""Safety-Gymnasium's key of the sum of costs in ``info``."""


def missing(env: Any) -> EnvOptionError:
    """The error for an environment that was made without costs."""
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
            raise missing(self.env)
        cost = info[COST_SUM] = float(info.pop(TOTAL))
        return observation, float(reward), cost, terminated, truncated, info
