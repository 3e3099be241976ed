# SPDX-License-Identifier: BSD-3-Clause
"""The sensors that every autopilot has, each at its rate."""

from __future__ import annotations

from ....core.kernels import law
from .. import atmosphere
from . import barometer, gps, imu, magnetometer, power


@law
def sense(p, sensors, tick, time_us, rng):
    """Write the samples that fall due in this tick."""
    if tick % imu.WALK_TICKS == 0:
        imu.walk(p, rng)
        power.sample(p, sensors)
    imu.sample(p, sensors, rng)
    if tick % int(p.derived.mag_period) == 1:
        magnetometer.sample(p, sensors, rng)
    if tick % int(p.derived.baro_period) == 1:
        atmosphere.update(p)
        barometer.sample(p, sensors, rng)
    gps.update(p, sensors, tick, time_us, rng)
    sensors.time_us = time_us
