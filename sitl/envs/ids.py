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


class Described(NamedTuple):
    """A task."""

    steps: int
    """Steps after which an episode is truncated."""
    title: str
    """Of its page."""
    aim: str
    """What the robot is to do, in a sentence."""


TASKS = {
    "copter-hover": Described(200, "Hover in wind", "Hold a target position near the start in wind and gusts."),
    "copter-reach-goal": Described(
        100, "Fly to a goal (goal-conditioned)", "Fly to a random goal. The reward is sparse."
    ),
    "rover-reach-goal": Described(
        100, "Drive to a goal (goal-conditioned)", "Drive to a random goal. The reward is sparse."
    ),
    "copter-waypoint": Described(200, "Fly to a waypoint", "Fly to one random waypoint."),
    "copter-course": Described(500, "Fly a course of waypoints", "Pass five random waypoints in order."),
    "copter-gates": Described(
        400, "Race through gates", "Fly one lap through an oval of six gates, against the clock."
    ),
    "copter-race": Described(900, "Race three laps", "Fly three laps through the same six gates; info has lap times."),
    "copter-trajectory": Described(
        400, "Follow a figure of eight", "Track a point that moves along a figure of eight."
    ),
    "copter-follow": Described(400, "Follow a moving target", "Track a target that moves at random."),
    "copter-land": Described(300, "Land on a pad", "Land softly on a pad near the start."),
    "copter-land-moving": Described(300, "Land on a moving pad", "Land softly on a pad that moves at 0.5 m/s."),
    "copter-forest": Described(400, "Fly through a forest", "Fly to a waypoint among trees, by lidar."),
    "copter-rooms": Described(600, "Fly through rooms", "Fly to a waypoint in a house, by lidar."),
    "rover-waypoint": Described(300, "Drive to a waypoint", "Drive to one random waypoint."),
    "rover-course": Described(600, "Drive a course of waypoints", "Pass four random waypoints in order."),
    "rover-labyrinth": Described(1000, "Drive through a labyrinth", "Drive to a waypoint in a maze, by lidar."),
    "rover-slalom": Described(400, "Drive a slalom", "Pass poles on alternate sides."),
    "rover-race": Described(900, "Race two laps", "Drive two laps of a walled track, by lidar; info has lap times."),
    "rover-parking": Described(300, "Park in a bay", "Park in a free bay between cars, by lidar."),
}
"""Flight and driving tasks by the name of their presets."""
GOAL_CONDITIONED = ("copter-reach-goal", "rover-reach-goal")
"""Those whose observation has the goal, for hindsight replay."""


def camel_case(preset: str) -> str:
    """A task's name in its ids and on its page: "CopterHover" for "copter-hover"."""
    return "".join(word.capitalize() for word in preset.split("-"))


def _version(number: int) -> dict[str, Listed]:
    of_preset = f"-v{number}" if number else ""
    return {
        f"sitl/{camel_case(preset)}{form}-v{number}": Listed(preset + form.lower() + of_preset, task.steps)
        for preset, task in TASKS.items()
        for form in ("", "Discrete")
    }


NEW = _version(1)
"""Flight and driving tasks; "...Discrete" has discrete actions."""
FIRST = _version(0)
"""The same in their first version, for what was published with them: judged by the estimate, and ending early pays."""


def task_of(preset: str) -> str:
    """The task (``TASKS``) of an id's preset: "copter-hover" of "copter-hoverdiscrete-v1"."""
    return preset.removesuffix("-v1").removesuffix("discrete")
