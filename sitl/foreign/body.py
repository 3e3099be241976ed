# SPDX-License-Identifier: BSD-3-Clause
"""The simulated motion as JSON lines for ArduPilot, which has its own sensor models and needs the true state."""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import Any

from ..bridge.ardupilot_json import motion
from ..core.algebra import euler_of
from ..core.constants import TICK_US
from ..core.elementary import atan2, hypot
from ..plants.plant import SimulatedVehicle

CLOCK_LEAD = 1e-9
"""Relative lead of the lines' clock.

ArduPilot adds each difference of two timestamps to a clock of whole microseconds and cuts off the rest: with
differences a rounding error below 2500 us it would lose a microsecond now and then. The lead, a microsecond in 1000 s,
outweighs rounding.
"""
_S = 1e-6 * (1.0 + CLOCK_LEAD)
_PLACE = 6
"""Where position, attitude and velocity begin in a motion."""
Motion = tuple[float, ...]


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

    def state(self) -> Motion:
        """Rates and force (means over the last tick), position, attitude, velocity: 16 numbers."""
        return self._motion()

    def lines(self, before: Motion, count: int) -> list[bytes]:
        """The last tick as JSON lines.

        The last line is the state at the end of the tick. Those before it are on the straight way there; rates and
        force are the tick's means in all of them, so that an IMU that sums them up gets the same.

        Args:
            before: state at its beginning; needed for more than one line.
            count: number of lines; the tick is cut into parts of whole microseconds.
        """
        slow = self._slow()
        if slow != self._seen:
            self._seen, self._extras = slow, self._others(slow)
        now, end_us, extras = self._motion(), self._clock(), self._extras
        if count == 1:
            return [motion.encode((end_us * _S, *now), extras)]
        place, began, began_us = now[_PLACE:], before[_PLACE:], end_us - TICK_US
        times, places = [], []
        for k in range(1, count):
            share = k / count
            times.append((began_us + k * TICK_US // count) * _S)
            places.append(tuple([a + share * (b - a) for a, b in zip(began, place)]))
        return motion.encode_parts([*times, end_us * _S], now[:_PLACE], [*places, place], extras)

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
        return math.remainder(atan2(east, north) - euler_of(body.q).yaw, 2.0 * math.pi), hypot(north, east)
