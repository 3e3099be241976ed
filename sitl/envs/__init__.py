# SPDX-License-Identifier: BSD-3-Clause
"""Gymnasium environments: ``import sitl.envs``, then ``gymnasium.make``. Nothing heavy is loaded before that.

``sitl/Navigate-v1`` is any robot in any world. The paper's have its names ("...LIDAR-v0") and those of the original
code ("...Lidar-v0"). ``NEW`` are the flight and driving tasks, ``FIRST`` their first versions.
"""

from __future__ import annotations

import gymnasium as gym

from sitl.errors import LinkLostError, NotASimulatorError, NotReadyError

from .goals import WRAPPER, ForSingle
from .ids import FIRST, GOAL_CONDITIONED, MAX_EPISODE_STEPS, NEW, PAPER, Listed, task_of
from .options import EnvOptionError

__all__ = [
    "FIRST", "MAX_EPISODE_STEPS", "NEW", "PAPER", "EnvOptionError", "LinkLostError", "NotASimulatorError",
    "NotReadyError", "register",
]  # fmt: skip


def register() -> None:
    """Register every environment with Gymnasium; importing the package does it."""
    if "sitl/Navigate-v0" in gym.registry:
        return
    for name, options in (("sitl/Navigate-v0", {"judge": "estimate", "boots": 1}), ("sitl/Navigate-v1", {})):
        gym.register(
            name,
            entry_point="sitl.envs.navigate:Navigate",
            vector_entry_point="sitl.envs.vector:NavigateVector",
            max_episode_steps=MAX_EPISODE_STEPS,
            kwargs=options,
        )
    paper = {
        name: Listed(preset, MAX_EPISODE_STEPS)
        for paper_id, preset in PAPER.items()
        for name in (paper_id, paper_id.replace("LIDAR", "Lidar"))
    }
    for name, (preset, steps) in (paper | FIRST | NEW).items():
        gym.register(
            name,
            entry_point="sitl.envs.presets:PresetNavigate",
            vector_entry_point="sitl.envs.vector:PresetNavigateVector",
            max_episode_steps=steps,
            additional_wrappers=ForSingle((WRAPPER,)) if task_of(preset) in GOAL_CONDITIONED else (),
            kwargs={"preset": preset},
        )


register()
