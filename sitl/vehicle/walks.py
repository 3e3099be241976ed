# SPDX-License-Identifier: BSD-3-Clause
"""Other slow errors of receiver and barometer, as if they had been so since long.

All that the autopilot has measured stays as it is, and so does the filter with its innovations and covariance: it is
the vehicle that is elsewhere. A move then brings it back, and takes the estimate along. What does not fit is that a
walk's last steps depend on where it stands: over the filter's memory of some seconds, some hundredths of the change.
"""

from __future__ import annotations

from typing import Any

from ..core.vectors import Vec3
from ..physics.native.atmosphere import pressure

_STEP = 0.01
"""Heights apart, for the slope of the pressure [m]."""


def walk(p: Any, walks: tuple[float, float, float], flies: bool) -> None:
    """Put the body where what was measured is true with these errors.

    Args:
        p: physics of a vehicle.
        walks: receiver north, east, barometer, in standard deviations.
        flies: whether it can be at another height.
    """
    figures, sensors, here = p.airframe, p.sensors, p.body.pos
    north, east, high = walks
    receiver = sensors.gps[0]
    size = figures.noise_scale * figures.gps_drift_horizontal
    before = receiver.drift
    receiver.drift = Vec3(north, east, before.z)
    down = here.z
    if flies:
        change = figures.noise_scale * figures.baro_drift * (high - sensors.baro_drift)
        sensors.baro_drift = high
        altitude = p.place.alt - down
        down += change * _STEP / (pressure(altitude + _STEP) - pressure(altitude))
    p.body.pos = Vec3(here.x - size * (north - before.x), here.y - size * (east - before.y), down)
