# SPDX-License-Identifier: BSD-3-Clause
"""A vehicle in a test: simulated in this process, commanded and observed by MAVLink bytes alone."""

from __future__ import annotations

from .faults import Faulty
from .golden import Golden
from .missions import MissionFlier
from .telemetry import Place, Text

__all__ = ["Copter", "Place", "Rover", "Text", "Vehicle"]

TAKEOFF = 22


class Vehicle(Golden, MissionFlier, Faulty):
    """What a test does with a vehicle. Times are simulated seconds, places metres from home, heights above home.

    Whatever is awaited in vain raises an AssertionError that says what was seen last, when, and what the vehicle said.
    """


class Copter(Vehicle):
    """A copter."""

    def takeoff(self, height: float = 10.0, timeout: float = 60.0) -> None:
        """GUIDED, arm if need be, climb to a height above home [m], and wait until it is there."""
        __tracebackhide__ = True
        if self.mode != "GUIDED":
            self.change_mode("GUIDED")
        if not self.armed:
            self.arm()
        self.command(TAKEOFF, 0, 0, 0, 0, 0, 0, height, name="the take-off")
        self.wait_altitude(height - max(0.5, 0.05 * height), height + 2.0, timeout)

    def land(self, timeout: float = 120.0) -> None:
        """LAND, and wait until it is disarmed."""
        __tracebackhide__ = True
        self.change_mode("LAND")
        self.wait_disarmed(timeout)

    def return_to_launch(self, timeout: float = 300.0) -> None:
        """RTL, and wait until it is disarmed."""
        __tracebackhide__ = True
        self.change_mode("RTL")
        self.wait_disarmed(timeout)


class Rover(Vehicle):
    """A rover."""

    def start(self) -> None:
        """GUIDED and armed: ready to drive."""
        __tracebackhide__ = True
        if self.mode != "GUIDED":
            self.change_mode("GUIDED")
        if not self.armed:
            self.arm()

    def stop(self, timeout: float = 30.0) -> None:
        """HOLD, and wait until it stands."""
        __tracebackhide__ = True
        self.change_mode("HOLD")
        self.wait_groundspeed(0.0, 0.1, timeout, 1.0)
