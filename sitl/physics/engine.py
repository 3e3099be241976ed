# SPDX-License-Identifier: BSD-3-Clause
"""A physics engine behind the border: what moves the body of one vehicle.

Everything that is not motion is common to all engines and compiled: clock, wind, rotors' forces (for engines that have
none of their own), battery, sensors. An engine takes a vehicle's record as native physics lays it out, reads the
actuators, moves the body by a tick, and writes the truth back.
"""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Callable
from dataclasses import dataclass
from typing import Any, ClassVar

import numpy as np

from ..errors import SitlError
from ..vehicles import Airframe
from ..worlds import World


def offset(dtype: Any, *path: str) -> int:
    """Of a field within a record [bytes]."""
    at = 0
    for name in path:
        dtype, more = dtype.fields[name][:2]
        at += more
    return at


Array = np.ndarray[Any, Any]


class EngineError(SitlError, ValueError):
    """An engine cannot simulate what was asked for; the message says what and which engine can."""


@dataclass(frozen=True)
class Laws:
    """The common part of a tick, compiled, bound to the vehicle."""

    begin: Callable[[], None]
    """First thing of a tick: clock and tick counter go on, wind, actuator controls become commands."""
    load: Callable[[], None]
    """Of a copter: one substep of its rotors; leaves force and torque on the body (FRD, gravity left out) in
    ``physics.motion.force`` [N] and ``physics.motion.torque`` [N m]. A rover has none: its drive and steering laws run
    in ``begin`` and leave ``physics.wheels``."""
    sense: Callable[[], None]
    """Last thing of a tick: accelerations from the change of velocity, battery, sensors."""


@dataclass(frozen=True)
class EngineVehicle:
    """What an engine gets of its vehicle: record, airframe, compiled laws and world."""

    v: Any
    """The record."""
    fleet: Array
    index: int
    """The record is ``fleet[index]``; its memory stays in place."""
    airframe: Airframe
    laws: Laws
    world: World | None = None
    floor: float = 0.0
    """Height of the floor in the world's frame [m]; ``body.pos[2]`` is 0 on it."""


class Engine(ABC):
    """One vehicle in one world of one engine.

    ``physics.body`` is the truth that everybody else reads. An engine writes, at the end of each tick: ``pos`` [m] and
    ``vel`` [m/s] (NED), ``q`` (body to NED), ``rates`` (body) [rad/s]; what its model has of ``rotors.power`` or
    ``wheels`` [SI, see the records]; and into ``physics.motion.contact`` the part of this tick's change of velocity
    that hard contacts gave (NED [m/s]; 0 where contacts are springs), which the accelerometer shows spread over 20 ms.
    Ran into a solid or hard onto the ground: ``obstacles.hit_count``, ``hit_speed``, ``hit_time_us``, ``touching``, and
    a copter's ``ground.hit_*`` and ``ground.state``, as native physics.

    Same vehicle, same actuators: same bits, on every repeat.
    """

    name: ClassVar[str]
    idle_parameters: tuple[str, ...] = ()
    """Beginnings of the names of SIM_ parameters that do nothing to it."""

    def __init__(self, vehicle: EngineVehicle) -> None:
        self.vehicle = vehicle

    @abstractmethod
    def place(self) -> None:
        """Put the body where the record says (``physics.body``), at rest: power-on. Properties may have changed."""

    @abstractmethod
    def move(self) -> None:
        """Move the body by one tick of 2500 us under ``actuators.controls``."""

    def tick(self) -> None:
        """One tick: actuators in, sensors out."""
        laws = self.vehicle.laws
        laws.begin()
        self.move()
        laws.sense()

    @abstractmethod
    def snapshot(self) -> bytes:
        """What the record does not hold: ``restore`` goes on from it bit for bit, also in another engine of an equal
        vehicle.

        Raises:
            EngineError: the engine cannot.
        """

    @abstractmethod
    def restore(self, state: bytes) -> None:
        """Go back to a snapshot; the record has been put back already."""

    def cast(self, origin: Array, directions: Array, ranges: Array, reach: float) -> bool:
        """Cast rays at the world: a lidar by the engine's own means.

        Args:
            origin: NED from the world's origin [m]; north, east, and down from z = 0 of the world's frame.
            directions: unit vectors NED, shape (3, n).
            ranges: filled, shape (n,) [m]; inf beyond ``reach`` or where nothing is.
            reach: [m].

        Returns:
            False when the engine leaves it to ``sitl.worlds.raycast``.
        """
        return False

    def render(self, width: int, height: int) -> Array | None:
        """A picture of the vehicle in its world by the engine's own renderer: uint8, shape (height, width, 3); None
        when it has none."""
        return None

    def close(self) -> None:
        """Let go of what the engine holds."""
        return
