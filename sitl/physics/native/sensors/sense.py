# SPDX-License-Identifier: BSD-3-Clause
"""The sensors that every autopilot has, each at its rate."""

from __future__ import annotations

from ....core.border import Sensors
from ....core.kernels import law
from ....core.rng import Rng
from ..atmosphere import set_air
from ..records import Physics
from ..tick import Clock
from . import barometer, downward, gps, imu, magnetometer, power


@law
def sense(p: Physics, sensors: Sensors, rng: Rng, now: Clock) -> None:
    """Write the samples that fall due in this tick."""
    tick = now.tick
    if tick % imu.WALK_TICKS == 0:
        imu.walk(p.sensors, p.derived, rng)
        imu.drift(p.sensors, p.airframe, tick)
        power.sample(p.battery, sensors)
    imu.sample(p, sensors, rng)
    if tick % p.derived.mag_period == 1:
        magnetometer.sample(p, sensors, rng, now.time_us)
    if tick % p.derived.baro_period == 1:
        set_air(p.air, p.origin.alt - p.body.pos.z)
        barometer.sample(p, sensors, rng)
    gps.sample(p, sensors, now, rng)
    if p.downward.present:
        downward.sample(p, sensors, rng, now)
    sensors.time_us = now.time_us
