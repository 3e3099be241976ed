# SPDX-License-Identifier: BSD-3-Clause
"""A vector environment with Safety-Gymnasium's interface: see ``safety``."""

from __future__ import annotations

from typing import Any

import numpy as np
import numpy.typing as npt
from gymnasium.vector import VectorEnv, VectorWrapper

from .costs import TOTAL
from .safety import COST_SUM, missing

Floats = npt.NDArray[np.float64]


class SafetyVectorEnv(VectorWrapper):
    """A vector environment whose ``step`` returns observations, rewards, costs, terminated, truncated, infos.

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
        with_costs = [found for found in (infos, infos.get("final_info")) if isinstance(found, dict) and TOTAL in found]
        if not with_costs and infos:
            raise missing(self.env)
        for found in with_costs:
            costs += np.where(found["_" + TOTAL], found[TOTAL], 0.0)
            found[COST_SUM], found["_" + COST_SUM] = found.pop(TOTAL), found.pop("_" + TOTAL)
        return observations, rewards, costs, terminated, truncated, infos
