# SPDX-License-Identifier: BSD-3-Clause
"""Turtlebots in a world: no autopilot, no MAVLink, commands in metres and radians a second.

Poses are in the frame of world files: x forward, y left, z up [m], yaw counter-clockwise from x [rad].
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from pathlib import Path
from typing import Any

import numpy as np
import numpy.typing as npt

from ..core.array_kernels import NarrowTable
from ..core.kernels import jit_disabled
from ..core.records import Records
from ..physics.native.turtlebot.compiled_fleet import Orders, advance, advance_apart
from ..physics.native.turtlebot.init import place
from ..physics.native.turtlebot.scan import Beams
from ..physics.native.turtlebot.state import TICK_US
from ..physics.native.turtlebot.state import Turtlebot as TurtlebotRecord
from ..vehicles.turtlebot import AIRFRAME, LIDAR, Lidar, TurtlebotAirframe
from ..worlds import World, load, planar
from ..worlds.geometry import Solids
from ..worlds.shapes import from_heading, from_ned, to_heading, to_ned

Pose = Sequence[float]
"""x, y [m], yaw [rad], or x, y, z [m], yaw [rad]."""


class Turtlebots:
    """Any number of Turtlebots, each alone; they do not see each other. All begin in the same world (``enter``).

    Args:
        world: name, .toml file or World.
        count: of robots.
        airframe: what all start with.
        lidar: rays and readings.

    Raises:
        WorldError: no such world.
        ValueError: fewer than one robot, or a lidar that cannot be.
    """

    def __init__(
        self,
        world: str | Path | World = "circuit2",
        count: int = 1,
        airframe: TurtlebotAirframe = AIRFRAME,
        lidar: Lidar = LIDAR,
    ) -> None:
        if count < 1:
            raise ValueError(f"count = {count} Turtlebots; it must be 1 or more")
        if not 1 <= lidar.readings <= lidar.rays or not 0.0 < lidar.field_of_view <= 2.0 * math.pi:
            raise ValueError(f"{lidar}: readings must be 1 .. rays, field_of_view above 0 and at most 2 pi rad")
        self.world = load(world)
        """That which they begin in."""
        self.worlds = [self.world] * count
        """That which each is in."""
        self.airframe = airframe
        self.lidar = lidar
        self.count = count
        self.fleet = TurtlebotRecord.fleet(count)
        self.fleet["airframe"] = airframe.record()
        self.scan: npt.NDArray[np.float32] = np.zeros((count, lidar.readings), np.float32)
        """Readings of the lidars [m], from right to left, inf for nothing in range; each call writes into it."""
        self.commands = np.full((count, 2), math.nan)
        self.ticks = np.zeros(count, np.int64)
        self._ready()
        for index in range(count):
            self.reset(index)
        self.look()

    def _ready(self) -> None:
        """What follows from the rest, and is not pickled."""
        self.views = [TurtlebotRecord.of(self.fleet, index) for index in range(self.count)]
        rays = planar.rays(self.lidar.rays, self.lidar.field_of_view)
        g = self.world.geometry
        fleet: Any = self.views if jit_disabled() else self.fleet
        beams = Beams(rays, np.empty_like(rays), np.empty(self.lidar.rays))
        self._arguments = fleet, Orders(self.commands, self.ticks), g.arrays, beams, self.scan
        self._advance = advance.bind(*self._arguments)
        self._world_addresses: npt.NDArray[np.int64] | None = None
        """See ``advance_in_worlds``; None: all are in the world that they begin in."""
        if any(world is not self.world for world in self.worlds):
            self._separate()

    def _separate(self) -> None:
        self._world_addresses = np.array([_addresses(world) for world in self.worlds])
        fleet, orders, _, beams, scan = self._arguments
        self._advance = advance_apart.bind(fleet, orders, self._world_addresses, beams, scan)

    def enter(self, index: int, world: World) -> None:
        """Let one robot be in another world from now on; ``reset`` puts it somewhere there."""
        self.worlds[index] = world
        if self._world_addresses is None:
            self._separate()
        else:
            self._world_addresses[index] = _addresses(world)

    def reset(self, index: int = 0, pose: Pose | None = None, seed: int = 0) -> None:
        """Put one robot at a pose, at rest; its scan is that of the next ``advance`` or ``look``.

        Args:
            index: of the robot.
            pose: None: the start pose of its world.
            seed: of its sensor noise.
        """
        start = self.worlds[index].start("turtlebot")
        x, y, z, yaw = (*start.position, start.yaw) if pose is None else full_pose(pose, start.position[2])
        place(self.views[index], *to_ned(x, y, z), math.remainder(to_heading(yaw), 2.0 * math.pi), seed)

    def advance(self, seconds: float) -> None:
        """Give each robot its row of ``commands``, move all on by simulated time, read their lidars.

        Raises:
            ValueError: not a whole number of physics steps of 0.01 s.
        """
        self.ticks[:] = ticks_in(seconds)
        self._advance()

    def advance_each(self) -> None:
        """The same, each robot by its own number of ``ticks``."""
        self._advance()

    @property
    def arguments(self) -> tuple[Records[TurtlebotRecord], Orders, Solids, Beams, NarrowTable]:
        """What ``fleet.advance_fleet`` is called with, while all are in the world that they begin in: for laws of
        others that call it; the arrays stay in place."""
        return self._arguments

    def look(self) -> None:
        """Read the lidars where the robots stand."""
        self.ticks[:] = 0
        self._advance()

    def snapshot(self, index: int = 0) -> tuple[bytes, bytes]:
        """All that ``restore`` needs for one robot to go on bit for bit."""
        return self.fleet[index].tobytes(), self.scan[index].tobytes()

    def restore(self, snapshot: tuple[bytes, bytes], index: int = 0) -> None:
        """Put one robot back to what a snapshot of it, or of another one, holds.

        Raises:
            ValueError: the snapshot is of other records or another number of readings.
        """
        record, scan = snapshot
        if len(record) != TurtlebotRecord.dtype.itemsize or len(scan) != self.scan[index].nbytes:
            raise ValueError("this snapshot is not of a Turtlebot with a lidar of this many readings")
        self.fleet[index] = np.frombuffer(record, TurtlebotRecord.dtype)[0]
        self.scan[index] = np.frombuffer(scan, np.float32)
        self.commands[index] = math.nan

    def set_property(self, index: int, name: str, value: float) -> None:
        """Replace a property of one robot (``sitl.vehicles.turtlebot.Properties``).

        Raises:
            AirframeError: no such property, or a value outside its limits.
        """
        AIRFRAME.changed(**{name: value})
        setattr(self.views[index].airframe, name, float(value))

    def pose(self, index: int = 0) -> tuple[float, float, float, float]:
        """x, y, z [m] and yaw [rad] of one robot."""
        b = self.views[index].body
        return (*from_ned(b.north, b.east, b.down), from_heading(b.heading))

    def close(self) -> None:
        """Let go of what is open: nothing."""

    def __getstate__(self) -> dict[str, Any]:
        made = ("views", "_advance", "_arguments", "_places")
        return {name: value for name, value in vars(self).items() if name not in made}

    def __setstate__(self, state: dict[str, Any]) -> None:
        vars(self).update(state)
        self._ready()


class Turtlebot:
    """One Turtlebot: ``command``, ``advance``, ``pose``, ``scan``.

    >>> robot = Turtlebot("circuit2")
    >>> robot.command(0.3, 0.0)
    >>> robot.advance(0.6)
    >>> round(robot.pose[0], 2)
    0.18
    """

    def __init__(
        self,
        world: str | Path | World = "circuit2",
        airframe: TurtlebotAirframe = AIRFRAME,
        lidar: Lidar = LIDAR,
    ) -> None:
        self.fleet = Turtlebots(world, 1, airframe, lidar)

    def reset(self, pose: Pose | None = None, seed: int = 0) -> None:
        """Put it at a pose (None: the world's start), at rest."""
        self.fleet.reset(0, pose, seed)
        self.fleet.look()

    def command(self, forward: float, turn: float) -> None:
        """Drive: forward speed [m/s], turn rate [rad/s] counter-clockwise. It holds for 0.6 s, as Kobuki's.

        Raises:
            ValueError: not finite numbers.
        """
        if not (math.isfinite(forward) and math.isfinite(turn)):
            raise ValueError(f"command({forward}, {turn}): both must be finite")
        self.fleet.commands[0] = forward, turn

    def advance(self, seconds: float) -> None:
        """Let simulated time pass, a whole number of 0.01 s."""
        self.fleet.advance(seconds)
        self.fleet.commands[0] = math.nan

    @property
    def time(self) -> float:
        """Simulated time since the reset [s]."""
        return 1e-6 * int(self.fleet.views[0].time_us)

    @property
    def pose(self) -> tuple[float, float, float, float]:
        """x, y, z [m], yaw [rad]."""
        return self.fleet.pose()

    @property
    def scan(self) -> npt.NDArray[np.float32]:
        """Readings of the lidar [m], from right to left, inf for nothing in range: a copy."""
        return self.fleet.scan[0].copy()

    @property
    def collided(self) -> bool:
        """Whether something stopped it during the last ``advance``."""
        return bool(self.fleet.views[0].body.collided)

    def snapshot(self) -> tuple[bytes, bytes]:
        """All that ``restore`` needs to go on bit for bit."""
        return self.fleet.snapshot()

    def restore(self, snapshot: tuple[bytes, bytes]) -> None:
        """Go back to a snapshot."""
        self.fleet.restore(snapshot)


def _addresses(world: World) -> tuple[int, int, int, int, int]:
    """The row of ``advance_in_worlds`` of a robot in this world, which has to stay."""
    g = world.geometry
    return g.solids.ctypes.data, len(g.solids), g.grid.ctypes.data, g.cells.ctypes.data, len(g.cells)


def full_pose(pose: Pose, z: float) -> tuple[float, float, float, float]:
    """x, y, z [m], yaw [rad] of a pose that may come without z.

    Raises:
        ValueError: not three or four finite numbers.
    """
    try:
        numbers = [float(n) for n in pose]
    except (TypeError, ValueError):
        numbers = []
    if len(numbers) not in (3, 4) or not all(map(math.isfinite, numbers)):
        raise ValueError(f"pose {pose!r} is not (x, y, yaw) or (x, y, z, yaw): finite numbers, metres and radians")
    return (numbers[0], numbers[1], z if len(numbers) == 3 else numbers[2], numbers[-1])


def ticks_in(seconds: float) -> int:
    """Physics steps in a time.

    Raises:
        ValueError: not a whole number of them, or negative.
    """
    ticks = round(seconds * 1e6 / TICK_US) if math.isfinite(seconds) else -1
    if ticks < 0 or abs(seconds * 1e6 - ticks * TICK_US) > 1e-3:
        raise ValueError(f"{seconds} s is not a whole number of the Turtlebot's physics steps of {1e-6 * TICK_US:g} s")
    return ticks
