# SPDX-License-Identifier: BSD-3-Clause
"""Whether a crash was one: noise alone can push a reading below the range that counts as a crash."""

from __future__ import annotations

import math
from typing import Any

from sitl.core.algebra import euler_of
from sitl.envs.robots.autopilot import AutopilotRobot
from sitl.envs.robots.turtlebot import Turtlebot
from sitl.worlds.contact import clearance
from sitl.worlds.frames import to_ned

MARGIN = 0.05
"""Distance beyond the crash range from which a crash is a false alarm [m]."""
_HALF_SLICE = 0.01
"""Half height of the slice around the lidar that is looked at [m]."""


def is_false_alarm(env: Any) -> bool:
    """Whether the crash that ended the episode was a lidar reading only: nothing was touched, and nothing was near.

    Args:
        env: environment of this package; no crash is a false alarm where the robot's true position is unknown.
    """
    inner = env.unwrapped
    robot, limit = inner.robot, getattr(inner.task, "limit", math.inf)
    if robot.collided[0]:
        return False
    return lidar_distance(robot) > limit + MARGIN


def lidar_distance(robot: Any) -> float:
    """True horizontal distance from the lidar to the nearest solid at its height [m]; 0 where it is unknown."""
    if isinstance(robot, Turtlebot):
        x, y, z, yaw = robot.pose[0].tolist()
        figures = robot.robots.views[0].figures
        ahead = float(figures.lidar_ahead)  # type: ignore[attr-defined]
        place = (x + ahead * math.cos(yaw), y + ahead * math.sin(yaw), z + float(figures.lidar_height))  # type: ignore[attr-defined]
        north, east, down = to_ned(*place)
    elif isinstance(robot, AutopilotRobot) and robot.figures:
        v = robot.simulation(0).v
        body, (forward, right, below) = v.physics.body, v.physics.airframe.lidar_at
        heading = euler_of(body.q).yaw
        c, s = math.cos(heading), math.sin(heading)
        north, east, down = body.pos
        north, east = north + forward * c - right * s, east + forward * s + right * c
        down += below - robot.world.floor_z
    else:
        return 0.0
    return clearance(robot.world.geometry, north, east, down - _HALF_SLICE, down + _HALF_SLICE, 0.0).distance
