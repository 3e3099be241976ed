# SPDX-License-Identifier: BSD-3-Clause
"""Gymnasium environments: ``import sitl.envs``, then ``gymnasium.make``. Nothing heavy is loaded before that.

``sitl/Navigate-v0`` is any robot in any world; the others are the paper's, under its names ("...LIDAR-v0") and under
those of the original code ("...Lidar-v0").
"""

from __future__ import annotations

import gymnasium as gym

from sitl.errors import LinkLostError, NotASimulatorError, NotReadyError

from .options import EnvOptionError

__all__ = [
    "MAX_EPISODE_STEPS", "PAPER", "EnvOptionError", "LinkLostError", "NotASimulatorError", "NotReadyError", "register",
]  # fmt: skip

MAX_EPISODE_STEPS = 1500
"""Number of steps after which an episode is truncated, as in the paper's experiments. ``gym.make(...,
max_episode_steps=-1)`` sets no limit, as in the original environments."""

PAPER = {
    "GazeboCircuitTurtlebotLIDAR-v0": "circuit-turtlebot",
    "GazeboCircuit2TurtlebotLIDAR-v0": "circuit2-turtlebot",
    "GazeboMazeTurtlebotLIDAR-v0": "maze-turtlebot",
    "GazeboRoundTurtlebotLIDAR-v0": "round-turtlebot",
    "GazeboMazeErleRoverLIDAR-v0": "maze-erle-rover",
    "GazeboOfficeErleCopterLIDAR-v0": "office-erle-copter",
}
"""The paper's environments -> their presets (``paper.PRESETS``)."""


def register() -> None:
    """Register every environment with Gymnasium; importing the package does it."""
    if "sitl/Navigate-v0" in gym.registry:
        return
    gym.register(
        "sitl/Navigate-v0",
        entry_point="sitl.envs.navigate:Navigate",
        vector_entry_point="sitl.envs.vector:NavigateVector",
        max_episode_steps=MAX_EPISODE_STEPS,
    )
    for paper_id, preset in PAPER.items():
        for name in (paper_id, paper_id.replace("LIDAR", "Lidar")):
            gym.register(
                name,
                entry_point="sitl.envs.paper:PaperNavigate",
                vector_entry_point="sitl.envs.paper:PaperNavigateVector",
                max_episode_steps=MAX_EPISODE_STEPS,
                kwargs={"preset": preset},
            )


register()
