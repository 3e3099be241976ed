# SPDX-License-Identifier: BSD-3-Clause
"""The sensors that every autopilot has, each at its rate."""

from __future__ import annotations

from ....core.kernels import law
from ..atmosphere import set_air
from ..records import Physics, Vehicle
from . import barometer, gps, imu, magnetometer, power


@law
def sense(v: Vehicle[Physics]) -> None:
    """Write the samples that fall due in this tick."""
    p, sensors, rng, tick = v.physics, v.sensors, v.rng, v.tick
    if tick % imu.WALK_TICKS == 0:
        imu.walk(p.sensors, p.derived, rng)
        power.sample(p.battery, sensors)
    imu.sample(p, sensors, rng)
    if tick % p.derived.mag_period == 1:
        magnetometer.sample(p, sensors, rng)
    if tick % p.derived.baro_period == 1:
        set_air(p.air, p.place.alt - p.body.pos.z)
        barometer.sample(p, sensors, rng)
    gps.sample(p, sensors, gps.Clock(tick, v.time_us), rng)
    sensors.time_us = v.time_us
