# SPDX-License-Identifier: BSD-3-Clause
"""Ids of environments, with what Gymnasium needs to know of each: data alone, so that registering loads nothing."""

from __future__ import annotations

from typing import NamedTuple


class Listed(NamedTuple):
    """One environment."""

    preset: str
    """Its options by this name (``presets.PRESETS``)."""
    steps: int
    """Steps after which an episode is truncated."""


MAX_EPISODE_STEPS = 1500
"""Of the paper's environments, as in its experiments. ``gym.make(..., max_episode_steps=-1)`` sets no limit, as in the
original environments."""

PAPER = {
    "GazeboCircuitTurtlebotLIDAR-v0": "circuit-turtlebot",
    "GazeboCircuit2TurtlebotLIDAR-v0": "circuit2-turtlebot",
    "GazeboMazeTurtlebotLIDAR-v0": "maze-turtlebot",
    "GazeboRoundTurtlebotLIDAR-v0": "round-turtlebot",
    "GazeboMazeErleRoverLIDAR-v0": "maze-erle-rover",
    "GazeboOfficeErleCopterLIDAR-v0": "office-erle-copter",
}
"""The paper's environments -> their presets (``paper.PRESETS``)."""

_STEPS = {
    "copter-hover": 200,
    "copter-reach-goal": 100,
    "rover-reach-goal": 100,
    "copter-waypoint": 200,
    "copter-course": 500,
    "copter-gates": 400,
    "copter-race": 900,
    "copter-trajectory": 400,
    "copter-follow": 400,
    "copter-land": 300,
    "copter-land-moving": 300,
    "copter-forest": 400,
    "copter-rooms": 600,
    "rover-waypoint": 300,
    "rover-course": 600,
    "rover-labyrinth": 1000,
    "rover-slalom": 400,
    "rover-race": 900,
    "rover-parking": 300,
}


def _id(preset: str) -> str:
    return "sitl/" + "".join(word.capitalize() for word in preset.split("-"))


NEW = {
    f"{_id(preset)}{form}-v0": Listed(preset + form.lower(), steps)
    for preset, steps in _STEPS.items()
    for form in ("", "Discrete")
}
"""Flight and driving tasks; "...Discrete" has discrete actions."""
