# SPDX-License-Identifier: BSD-3-Clause
"""Turtlebots with physics by PyBullet; in all else as ``native``."""

from __future__ import annotations

import math
from typing import Any

import numpy as np

from ..physics.engine import EngineError
from ..physics.native.turtlebot.state import Turtlebot
from ..physics.pybullet.diff_drive import BulletTurtlebot
from ..worlds import World
from ..worlds.shapes import to_heading, to_ned
from .native import Pose, Turtlebots, full_pose, ticks_in


class BulletTurtlebots(Turtlebots):
    """See ``Turtlebots``: any number of robots, each alone in a world of its own of Bullet. They stand on the floor,
    whatever the z of a pose; a wall that is touched at a slant lets them slide along.

    Raises:
        MissingExtra: pybullet is not installed.
    """

    def _ready(self) -> None:
        self.views = [Turtlebot.of(self.fleet, index) for index in range(self.count)]
        self.robots = [BulletTurtlebot(v, self.world, self.lidar) for v in self.views]

    def enter(self, index: int, world: World) -> None:
        raise ValueError("physics 'pybullet' keeps a Turtlebot in the world that it was made in; 'native' does not")

    def reset(self, index: int = 0, pose: Pose | None = None, seed: int = 0) -> None:
        start = self.world.start("turtlebot")
        x, y, z, yaw = (*start.position, start.yaw) if pose is None else full_pose(pose, start.position[2])
        north, east, _ = to_ned(x, y, z)
        self.robots[index].place(north, east, math.remainder(to_heading(yaw), 2.0 * math.pi), seed)

    def advance(self, seconds: float) -> None:
        self.ticks[:] = ticks_in(seconds)
        self.advance_each()

    def advance_each(self) -> None:
        for index, robot in enumerate(self.robots):
            ticks = int(self.ticks[index])
            if ticks < 0:
                continue
            if ticks > 0:
                v, (forward, turn) = robot.v, self.commands[index].tolist()
                v.body.collided = False
                if not math.isnan(forward):
                    v.command.forward, v.command.turn, v.command.time_us = forward, turn, v.time_us
                robot.advance(ticks)
            robot.scan(self.scan[index])

    def look(self) -> None:
        self.ticks[:] = 0
        self.advance_each()

    def snapshot(self, index: int = 0) -> Any:
        return (*super().snapshot(index), self.robots[index].snapshot())

    def restore(self, snapshot: Any, index: int = 0) -> None:
        if len(snapshot) != 3:
            raise ValueError("this snapshot is not of a Turtlebot with physics by PyBullet")
        kept, scan, command = self.fleet[index].tobytes(), self.scan[index].copy(), self.commands[index].copy()
        super().restore(snapshot[:2], index)
        try:
            self.robots[index].restore(snapshot[2])
        except EngineError:
            self.fleet[index] = np.frombuffer(kept, Turtlebot.dtype)[0]
            self.scan[index], self.commands[index] = scan, command
            raise

    def set_property(self, index: int, name: str, value: float) -> None:
        super().set_property(index, name, value)
        self.robots[index].put()

    def render(self, index: int, width: int, height: int) -> Any:
        """A picture of one robot by Bullet's renderer: uint8, shape (height, width, 3)."""
        return self.robots[index].render(width, height)

    def close(self) -> None:
        """Give up what Bullet holds."""
        for robot in self.robots:
            robot.close()

    def __getstate__(self) -> dict[str, Any]:
        state = {name: value for name, value in super().__getstate__().items() if name != "robots"}
        return {**state, "_kept": [robot.snapshot() for robot in self.robots]}

    def __setstate__(self, state: dict[str, Any]) -> None:
        kept = state.pop("_kept")
        super().__setstate__(state)
        for robot, bullet in zip(self.robots, kept):
            robot.restore(bullet)
