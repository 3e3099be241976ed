# SPDX-License-Identifier: BSD-3-Clause
"""Robots by name. To add one, write a class that is a ``Robot`` and name it in ``ROBOTS``, or pass the class itself."""

from __future__ import annotations

import importlib
import inspect
from collections.abc import Callable, Mapping
from typing import Any

from sitl.worlds import World

from ..options import COMMON, EnvOptionError, unknown, unknown_option
from .robot import Robot

ROBOTS = {
    "turtlebot": "sitl.envs.robots.turtlebot:Turtlebot",
    "erle_copter": "sitl.envs.robots.autopilot:ErleCopter",
    "erle_rover": "sitl.envs.robots.autopilot:ErleRover",
    "autopilot": "sitl.envs.robots.autopilot:AutopilotRobot",
}
"""Name -> class."""
WORLDS = {"erle_copter": "office_erlecopter", "erle_rover": "maze_erlerover", "autopilot": "maze_erlerover"}
"""Name -> world where none is asked for; others have ``WORLD``."""
WORLD = "circuit2"


def world_of(robot: str | Callable[..., Robot]) -> str:
    """Name of the world that a robot fits in, for one that is to be in no other."""
    return WORLDS.get(_name(robot), WORLD) if isinstance(robot, str) else WORLD


def _name(robot: str) -> str:
    return robot.strip().lower().replace("-", "_")


def load(robot: str | Callable[..., Robot], world: World, count: int, options: Mapping[str, Any]) -> Robot:
    """Make a robot, or many.

    Args:
        robot: a name, or a class (any callable) that takes ``world``, ``count`` and its options.
        world: where.
        count: number of robots.
        options: options of this robot.

    Raises:
        EnvOptionError: no robot of that name, or it does not take such an option.
    """
    made: Callable[..., Robot]
    if isinstance(robot, str):
        name = _name(robot)
        if name not in ROBOTS:
            raise unknown("robot", robot, ROBOTS)
        module, attribute = ROBOTS[name].split(":")
        made = getattr(importlib.import_module(module), attribute)
    elif callable(robot):
        made = robot
    else:
        raise EnvOptionError(f"robot {robot!r} is neither a name ({', '.join(ROBOTS)}) nor a class")
    parameters = inspect.signature(made).parameters
    if not any(p.kind is p.VAR_KEYWORD for p in parameters.values()):
        if "boots" not in parameters and options.get("boots") == 1:  # as of ids -v0: without an autopilot there is none
            options = {name: value for name, value in options.items() if name != "boots"}
        for option in options:
            if option not in parameters:
                own = [p for p in parameters if p not in ("world", "count")]
                raise unknown_option(option, [*own, *COMMON, "render_mode"])
    return made(world=world, count=count, **options)
