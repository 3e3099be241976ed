# SPDX-License-Identifier: BSD-3-Clause
"""Turtlebot as an environment's robot: driven directly, without autopilot."""

from __future__ import annotations

import math
from collections.abc import Mapping
from pathlib import Path
from typing import Any

import numpy as np
import numpy.typing as npt

from sitl.physics.native.turtlebot.state import TICK_S
from sitl.turtlebots.native import Turtlebots, ticks_in
from sitl.vehicles.properties.property import Property
from sitl.vehicles.turtlebot import AIRFRAME, LIDAR, Lidar, TurtlebotAirframe
from sitl.worlds import World, planar

from ..actions import DRIVE, Action, Continuous, Discrete, Setpoint
from ..options import EnvOptionError
from .robot import Floats, Pose, Volume


class Turtlebot:
    """See ``Robot``.

    Args:
        world: world that the robots drive in.
        count: number of robots.
        airframe: properties of the robots.
        lidar: number of readings and field of view.
        physics: "native", or "pybullet": wheels that slip, walls that it slides along.

    Raises:
        EnvOptionError: no physics of this name.
        sitl.errors.MissingExtra: its library is not installed.
    """

    name = "turtlebot"
    tick = TICK_S
    step_time = 0.6
    """The Kobuki's command time-out: see docs/environments.md."""
    crash_range = 0.2
    setpoints: tuple[Setpoint, ...] = (DRIVE,)
    properties: Mapping[str, Property] = {prop.name: prop for prop in TurtlebotAirframe.known}
    digit_when_inf = 6

    def __init__(
        self,
        world: str | Path | World = "circuit2",
        count: int = 1,
        airframe: TurtlebotAirframe = AIRFRAME,
        lidar: Lidar = LIDAR,
        physics: str = "native",
    ) -> None:
        self._robots = robots = _fleet(physics)(world, count, airframe, lidar)
        self.count, self.scan = count, robots.scan
        self.volume = Volume(airframe.value("radius"), airframe.value("bottom"), airframe.value("top"))
        self.range_max = float(airframe.value("range_max"))
        self.angles = planar.angles(lidar.readings, lidar.field_of_view)
        self._bind()

    @property
    def world(self) -> World:
        """See ``Robot``."""
        return self._robots.worlds[0]

    @property
    def worlds(self) -> list[World]:
        """See ``TravellingRobot``."""
        return self._robots.worlds

    def enter(self, index: int, world: World) -> None:
        """See ``TravellingRobot``."""
        try:
            self._robots.enter(index, world)
        except ValueError as error:
            raise EnvOptionError(f"world {world.name!r}: {error}") from None
        self.floors[index] = world.floor_z

    def _bind(self) -> None:
        robots = self._robots
        self.floors = np.array([world.floor_z for world in robots.worlds])
        """See ``TravellingRobot``."""
        self.scan = robots.scan
        self._ticks, self._seconds = robots.ticks, -1.0
        self._commands, self._run = robots.commands, robots.advance_each
        self.collided = robots.fleet["body"]["collided"]

    @property
    def airframe(self) -> TurtlebotAirframe:
        """Properties that all robots start with."""
        return self._robots.airframe

    @property
    def robots(self) -> Turtlebots:
        """The simulated Turtlebots."""
        return self._robots

    @property
    def pose(self) -> Floats:
        """See ``Robot``."""
        b = self._robots.fleet["body"]
        return np.stack([b["north"], 0.0 - b["east"], 0.0 - b["down"], 0.0 - b["heading"]], axis=1)

    @property
    def velocity(self) -> Floats:
        """See ``Robot``."""
        b = self._robots.fleet["body"]
        return np.stack([b["speed"], np.zeros(self.count), np.zeros(self.count), 0.0 - b["yaw_rate"]], axis=1)

    @property
    def state(self) -> Floats:
        """See ``sitl.envs.senses.SensingRobot``: it knows where it is."""
        return np.concatenate([self.pose, self.velocity, np.zeros((self.count, 4))], axis=1)

    def true_state(self) -> Floats:
        """See ``sitl.envs.senses.SensingRobot``."""
        return self.state

    knows_truth = True
    """See ``AutopilotRobot.knows_truth``."""

    @property
    def camera_mount(self) -> tuple[float, float, float, float]:
        """See ``AutopilotRobot.camera_mount``."""
        airframe = self._robots.airframe
        return float(airframe.value("lidar_ahead")), 0.0, float(airframe.value("lidar_height")), 0.0

    def judged_state(self) -> Floats:
        """See ``sitl.envs.senses.SensingRobot``."""
        return self.state

    @property
    def time(self) -> Floats:
        """See ``Robot``."""
        out: Floats = 1e-6 * self._robots.fleet["time_us"]
        return out

    def action(self, form: str, setpoint: Setpoint) -> Action:
        """Discrete: the paper's forward, left and right. Else: 0 .. 0.3 m/s, +-0.3 rad/s."""
        if form != "discrete":
            return Continuous(DRIVE, (0.0, -0.3), (0.3, 0.3))
        return Discrete(DRIVE, {"forward": (0.3, 0.0), "left": (0.05, 0.3), "right": (0.05, -0.3)})

    def reset(self, index: int, pose: Pose, seed: int) -> None:
        """See ``Robot``."""
        self._robots.reset(index, pose, seed)

    def look(self, rows: npt.NDArray[np.bool_] | None = None) -> None:
        """See ``Robot``."""
        self._ticks[:] = 0 if rows is None else np.where(rows, 0, -1)
        self._seconds = -1.0
        self._run()

    def apply(self, setpoint: Setpoint, commands: Floats) -> None:
        """See ``Robot``."""
        self._commands[:] = commands

    def advance(self, seconds: float, rows: npt.NDArray[np.bool_] | None = None) -> None:
        """See ``Robot``."""
        if rows is not None:
            self._ticks[:] = np.where(rows, ticks_in(seconds), 0)
            self._seconds = -1.0
        elif seconds != self._seconds:
            self._ticks[:] = ticks_in(seconds)
            self._seconds = seconds
        self._run()

    def advance_late(
        self, seconds: float, waits: npt.NDArray[np.int64], rows: npt.NDArray[np.bool_] | None = None
    ) -> None:
        """See ``Robot``. A robot with a pending command also reads its lidar when the command takes effect: its noise
        advances."""
        moving = np.ones(self.count, np.bool_) if rows is None else rows
        first = np.where(moving, waits, 0)
        late, touched = self._commands.copy(), np.zeros(self.count, np.bool_)
        waiting = first > 0
        if waiting.any():
            self._commands[:] = math.nan
            self._ticks[:] = np.where(waiting, first, -1)
            self._run()
            touched = waiting & (self.collided != 0)
        rest = np.where(moving, ticks_in(seconds) - first, 0)
        self._commands[:] = late
        self._ticks[:] = np.where(moving & (rest == 0), -1, rest)
        self._seconds = -1.0
        self._run()
        self.collided[touched] = 1

    def photograph(self, index: int, width: int, height: int) -> Any:
        """An image by the physics engine's renderer, shape (height, width, 3), uint8; None when it has no renderer."""
        render = getattr(self._robots, "render", None)
        return None if render is None else render(index, width, height)

    def set_property(self, index: int, name: str, value: float) -> None:
        """See ``Robot``."""
        self._robots.set_property(index, name, value)

    def snapshot(self, index: int) -> Any:
        """See ``Robot``."""
        return self._robots.snapshot(index)

    def restore(self, index: int, snapshot: Any) -> None:
        """See ``Robot``."""
        try:
            self._robots.restore(snapshot, index)
        except (TypeError, ValueError) as error:
            raise EnvOptionError(f"snapshot cannot be restored: {error}") from None

    def close(self) -> None:
        """See ``Robot``."""
        self._robots.close()

    def __getstate__(self) -> dict[str, Any]:
        kept = ("count", "volume", "range_max", "angles", "_robots")
        return {name: vars(self)[name] for name in kept}

    def __setstate__(self, state: dict[str, Any]) -> None:
        vars(self).update(state)
        self._bind()


def _fleet(physics: str) -> type[Turtlebots]:
    """The class of Turtlebots for a physics engine."""
    if physics == "native":
        return Turtlebots
    if physics == "pybullet":
        from sitl.turtlebots.bullet import BulletTurtlebots

        return BulletTurtlebots
    raise EnvOptionError(f"physics {physics!r} cannot move a Turtlebot; 'native' and 'pybullet' can")
