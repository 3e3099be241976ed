# SPDX-License-Identifier: BSD-3-Clause
"""The simulated motion as JSON lines for ArduPilot, which has its own sensor models and needs the true state."""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import Any

from ..bridge.ardupilot_json import motion
from ..core.algebra import euler_of
from ..plants.plant import SimulatedVehicle

CLOCK_LEAD = 1e-9
"""Relative lead of the lines' clock.

ArduPilot adds each difference of two timestamps to a clock of whole microseconds and cuts off the rest: with
differences a rounding error below 2500 us it would lose a microsecond now and then. The lead, a microsecond in 1000 s,
outweighs rounding.
"""
_S = 1e-6 * (1.0 + CLOCK_LEAD)


class BodyLines:
    """Encodes JSON lines for one vehicle.

    Args:
        vehicle: the vehicle.
    """

    def __init__(self, vehicle: SimulatedVehicle) -> None:
        reader = vehicle.reader
        self._clock = reader.field("time_us")
        body = (f"physics.body.{name}" for name in ("rates_mean", "specific_force", "pos", "q", "vel"))
        self._motion = reader.fields(*body)
        self._slow = reader.fields(
            "sensors.rangefinder_count", "sensors.battery_voltage", "sensors.battery_current", "physics.wind.vel"
        )
        airframe = vehicle.airframe
        self._range_max = float(airframe.value("rangefinder_max"))
        self._range: Callable[[], float] = reader.field("sensors.rangefinder_range")
        self._v: Any = vehicle.v
        self._seen: tuple[Any, ...] = ()
        self._extras = ""

    def line(self) -> bytes:
        """The motion now as a JSON line: the state at the end of a tick."""
        slow = self._slow()
        if slow != self._seen:
            self._seen, self._extras = slow, self._others(slow)
        return motion.encode((self._clock() * _S, *self._motion()), self._extras)

    def _others(self, slow: tuple[Any, ...]) -> str:
        """Range-finder, battery, and apparent wind when there is wind; they change less often than the motion."""
        readings, voltage, current, *wind = slow
        reading = None
        if readings > 0 and self._range_max > 0.0:  # out of range is farther than the sensor sees
            reading = min(float(self._range()), self._range_max + 1.0)
        return motion.extra(reading, (voltage, current), self._vane(wind) if any(wind) else None)

    def _vane(self, wind: list[float]) -> tuple[float, float]:
        """Apparent wind: direction that it comes from, clockwise from the nose [rad], and speed [m/s]."""
        body = self._v.physics.body
        north, east = body.vel.x - wind[0], body.vel.y - wind[1]
        return math.remainder(math.atan2(east, north) - euler_of(body.q).yaw, 2.0 * math.pi), math.hypot(north, east)
