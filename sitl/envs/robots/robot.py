# SPDX-License-Identifier: BSD-3-Clause
"""The interface between an environment and its robots. An object is one robot or many, each alone in its world.

Poses are in the frame of world files: x forward, y left, z up [m], yaw counter-clockwise [rad].
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, Protocol, runtime_checkable

import numpy as np
import numpy.typing as npt

from sitl.vehicles.properties.property import Property
from sitl.worlds import World

from ..actions import Setpoint

if TYPE_CHECKING:
    from ..actions import Action

Floats = npt.NDArray[np.float64]
Pose = tuple[float, float, float, float]
"""x, y, z [m], yaw [rad]."""


@dataclass(frozen=True)
class Volume:
    """The vertical cylinder that a robot occupies."""

    radius: float
    """Radius [m]."""
    bottom: float
    """Height of the lower end above the z of the robot's pose [m]."""
    top: float
    """Height of the upper end above the z of the robot's pose [m]."""


class Robot(Protocol):
    """One robot or many. The class takes ``world``, ``count`` and its own options."""

    name: str
    count: int
    world: World
    """That of the first robot: of all, but for a ``TravellingRobot``."""
    volume: Volume
    tick: float
    """Resolution of time: an environment's step is a whole number of ticks [s]."""
    step_time: float
    """Default duration of a step [s]."""
    crash_range: float
    """Default range below which a reading is a crash [m]."""
    setpoints: tuple[Setpoint, ...]
    """Kinds of set-points that ``apply`` accepts; the first is the default."""
    properties: Mapping[str, Property]
    """Properties that ``set_property`` can change, with their limits."""
    range_max: float
    """Greatest finite reading [m]."""
    digit_when_inf: int
    """The paper's digit for a reading of inf [m]."""
    angles: Floats
    """Angles of the readings, counter-clockwise from straight ahead, shape (readings,) [rad]."""
    scan: npt.NDArray[np.float32]
    """Readings of the planar lidar [m], shape (count, readings), inf for nothing in range: each call writes into it."""

    @property
    def pose(self) -> Floats:
        """x, y, z [m], yaw [rad] in the world frame, shape (count, 4)."""

    @property
    def velocity(self) -> Floats:
        """Forward, left, up velocity [m/s], yaw rate [rad/s], shape (count, 4)."""

    @property
    def collided(self) -> npt.NDArray[np.int64]:
        """1 for each robot that hit something during the last ``advance``, shape (count,)."""

    @property
    def time(self) -> Floats:
        """Simulated time since the reset [s], shape (count,)."""

    def action(self, form: str, setpoint: Setpoint) -> Action:
        """The default actions of a form, "discrete", "continuous", or "agile" (with the limits that "normalised" has),
        for a kind of set-point."""

    def reset(self, index: int, pose: Pose, seed: int) -> None:
        """Put one robot at a pose, ready to move; call ``look`` or ``advance`` next. Deterministic in its arguments."""

    def look(self, rows: npt.NDArray[np.bool_] | None = None) -> None:
        """Read the lidars of these robots (None: all; shape (count,)) without advancing time."""

    def apply(self, setpoint: Setpoint, commands: Floats) -> None:
        """Set-points for the next ``advance``, in the units of ``setpoint``, shape (count, setpoint.width)."""

    def advance(self, seconds: float, rows: npt.NDArray[np.bool_] | None = None) -> None:
        """Advance these robots (None: all; shape (count,)) by simulated time [s], and read all lidars."""

    def set_property(self, index: int, name: str, value: Any) -> None:
        """Change a property of one robot, in the property's unit, before its ``reset``; a vector as a tuple."""

    def snapshot(self, index: int) -> Any:
        """State of one robot; after ``restore`` it continues bit for bit. Picklable."""

    def restore(self, index: int, snapshot: Any) -> None:
        """Restore one robot from a snapshot."""

    def close(self) -> None:
        """Close connections and engines."""


@runtime_checkable
class TravellingRobot(Protocol):
    """A robot that can begin its episodes in other worlds than that which it was made in."""

    worlds: list[World]
    """The world of each robot, shape (count,)."""
    floors: Floats
    """Height of each robot's floor [m], shape (count,)."""

    def enter(self, index: int, world: World) -> None:
        """One robot's next episode is in this world: ``reset`` or ``restore`` follows.

        Raises:
            EnvOptionError: it cannot be there.
        """


def world_of(robot: Any, index: int) -> World:
    """The world that one robot is in now."""
    worlds: list[World] | None = getattr(robot, "worlds", None)  # much quicker than to ask for the protocol
    found: World = robot.world if worlds is None else worlds[index]
    return found


def floors_of(robot: Any) -> Floats | float:
    """Height of each robot's floor [m], shape (count,); or that of all."""
    floors: Floats | None = getattr(robot, "floors", None)
    return float(robot.world.floor_z) if floors is None else floors


class LateRobot(Robot, Protocol):
    """A robot that supports the option ``latency``."""

    def advance_late(
        self, seconds: float, waits: npt.NDArray[np.int64], rows: npt.NDArray[np.bool_] | None = None
    ) -> None:
        """As ``advance`` (seconds [s]), but the set-point of robot i takes effect after ``waits[i]`` ticks, shape
        (count,).

        The previous set-point holds until then; for a whole step where the wait is as long as the step."""


@runtime_checkable
class PreparedRobot(Protocol):
    """A robot that is prepared at one pose and then put at others."""

    def prepare_at(self, pose: Pose) -> None:
        """Where it is prepared; before the first ``reset``."""


@runtime_checkable
class AskedRobot(Protocol):
    """A robot whose lidar readings may have to be asked for."""

    @property
    def is_live(self) -> bool:
        """Whether its time goes by while an environment thinks, as that of a vehicle at a connection does."""

    def use_scan(self, used: bool) -> None:
        """Whether anything reads them; before the first ``reset``."""
