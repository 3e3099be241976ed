# SPDX-License-Identifier: BSD-3-Clause
"""A vehicle in a test: ``sitl.client.Client`` under the names of tests, with faults, mission files and goldens."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from contextlib import AbstractContextManager
from typing import Any

from sitl.client import Text, px4
from sitl.client.controls import check_finite

from .faulty import Faulty
from .golden import Golden
from .missions import MissionFlier

__tracebackhide__ = True

__all__ = ["Copter", "Rover", "Text", "Vehicle"]


class Vehicle(Golden, MissionFlier, Faulty):
    """What a test does with a vehicle. Times are simulated seconds, positions metres from home, heights above home.

    Whatever is awaited in vain raises an AssertionError that says what was seen last, when, and what the vehicle said.
    """

    @property
    def height(self) -> float:
        """Above home [m]."""
        return self.altitude

    def change_mode(self, name: str, timeout: float = 5.0) -> None:
        """Choose a mode, and wait until it is on, at most ``timeout`` [simulated s]."""
        self.set_mode(name, timeout)

    def wait_until(
        self,
        condition: Callable[[], Any],
        timeout: float,
        what: str = "the condition",
        last: Callable[[], str] = lambda: "",
        hold: float = 0.0,
    ) -> None:
        """``wait`` for a condition without an argument; ``timeout`` and ``hold`` in simulated seconds."""
        self.wait(lambda _: condition(), timeout, what, last, hold)

    # ------------------------------------------------------------------ positions, whose altitude is called height here

    def set_position(  # type: ignore[override]
        self, north: float, east: float, height: float | None = None, yaw: float | None = None
    ) -> None:
        """In GUIDED: go to a position from home [m], at a height above home (None: its present one) and a yaw [deg]."""
        check_finite(height=height)
        super().set_position(north, east, height, yaw)

    def wait_location(  # type: ignore[override]
        self,
        north: float,
        east: float,
        height: float | None = None,
        accuracy: float = 1.0,
        timeout: float = 120.0,
        hold: float = 0.0,
    ) -> None:
        """Until it is at a position from home [m], along the ground and in height each within ``accuracy``."""
        super().wait_location(north, east, height, accuracy, timeout, hold)

    def fly_to(
        self,
        north: float,
        east: float,
        height: float | None = None,
        yaw: float | None = None,
        accuracy: float = 1.0,
        timeout: float = 120.0,
    ) -> None:
        """``set_position`` (NED from home [m], yaw [deg]), and wait until it is there."""
        self.goto(north, east, height, yaw, accuracy, timeout)

    drive_to = fly_to

    # ------------------------------------------------------------------ parameters, sticks

    def parameter(self, name: str) -> float:
        """Ask the vehicle for a parameter's present value."""
        return self.params[name]

    def set_parameter(self, name: str, value: float) -> None:
        """Set a parameter, in its unit, and see that the vehicle took it."""
        self.params[name] = value

    def set_parameters(self, values: Mapping[str, float] | None = None, **more: float) -> None:
        """Set several, each in its unit."""
        self.params.update(values, **more)

    def parameters(self, values: Mapping[str, float] | None = None, **more: float) -> AbstractContextManager[None]:
        """``with copter.parameters(ANGLE_MAX=2000):`` sets parameters, and sets them back when the block is left."""
        return self.params.changed(values, **more)

    def set_rc(self, channels: Mapping[int, int] | None = None, **sticks: int) -> None:
        """Hold sticks: pulses [us] by channel, or ``roll=``, ``pitch=``, ``throttle=``, ``yaw=``, ``steering=``."""
        self.rc(channels, **sticks)


class Copter(Vehicle):
    """A copter."""

    def takeoff(self, height: float = 10.0, timeout: float = 60.0) -> None:
        """GUIDED, arm if need be, climb to a height above home [m], and wait until it is there."""
        check_finite(height=height)
        self.take_off(height, timeout)


class Rover(Vehicle):
    """A rover."""

    def start(self) -> None:
        """GUIDED and armed: ready to drive."""
        self.guided_and_armed()

    def stop(self, timeout: float = 30.0) -> None:
        """HOLD, and wait until it stands, at most ``timeout`` [simulated s]."""
        self.set_mode(px4.READY if self.telemetry.is_px4 else "HOLD")
        self.wait_groundspeed(0.0, 0.1, timeout, 1.0)
