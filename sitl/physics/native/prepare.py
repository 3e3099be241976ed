# SPDX-License-Identifier: BSD-3-Clause
"""What follows from the properties that all airframes have; and how the kinds compute theirs."""

from __future__ import annotations

import math
from typing import NamedTuple

from ...core.constants import TICK_S
from ...core.elementary import exp
from ...core.kernels import law
from ...vehicles.properties.body import Properties
from .records import Derived
from .sensors.imu import WALK_TICKS


class Step(NamedTuple):
    """A step of a first-order Gauss-Markov process."""

    decay: float
    """What is left over of it."""
    deviation: float
    """Standard deviation of the noise that is added."""


@law
def whole_ticks(seconds: float) -> int:
    """Seconds as a whole number of ticks, at least 1."""
    return max(math.floor(seconds / TICK_S + 0.5), 1)


@law
def decay(time_constant: float, dt: float) -> float:
    """What is left of a first-order error after ``dt`` [s]; nothing without a time constant [s]."""
    if time_constant <= 0.0:
        return 0.0
    return exp(-dt / time_constant)


@law
def drift_step(correlation_time: float, dt: float) -> Step:
    """A step ``dt`` [s] of a drift of standard deviation 1."""
    left = decay(correlation_time, dt)
    return Step(left, math.sqrt(1.0 - left * left))


@law
def walk_step(random_walk: float, correlation_time: float, dt: float) -> Step:
    """A step ``dt`` [s] of a bias that wanders by ``random_walk`` [unit/s/sqrt(Hz)]; without a correlation time [s] it
    is a pure random walk.
    """
    if correlation_time <= 0.0:
        return Step(1.0, random_walk * math.sqrt(dt))
    left = exp(-dt / correlation_time)
    return Step(left, random_walk * math.sqrt(0.5 * correlation_time * (1.0 - left * left)))


@law
def prepare_shared(a: Properties, d: Derived) -> None:
    """Fill the part of ``d`` that follows from battery and sensors."""
    d.charge_per_amp = 0.0
    if a.battery_capacity > 0.0:
        d.charge_per_amp = TICK_S / (3600.0 * a.battery_capacity)
    scale = a.noise_scale
    per_sample = math.sqrt(1.0 / TICK_S)
    d.acc_noise = scale * a.acc_noise_density * per_sample
    d.gyro_noise = scale * a.gyro_noise_density * per_sample
    walk = walk_step(a.acc_random_walk, a.acc_bias_time, WALK_TICKS * TICK_S)
    d.acc_bias_decay, d.acc_bias_step = walk.decay, scale * walk.deviation
    walk = walk_step(a.gyro_random_walk, a.gyro_bias_time, WALK_TICKS * TICK_S)
    d.gyro_bias_decay, d.gyro_bias_step = walk.decay, scale * walk.deviation
    d.gps_period = whole_ticks(1.0 / a.gps_rate)
    d.gps_delay = math.floor(a.gps_delay / TICK_S + 0.5)
    d.gps_start = whole_ticks(a.gps_start)
    d.gps_fix = whole_ticks(a.gps_fix_time)
    drift = drift_step(a.gps_drift_time, d.gps_period * TICK_S)
    d.gps_drift_decay, d.gps_drift_step = drift.decay, drift.deviation
    d.baro_period = max(whole_ticks(1.0 / a.baro_rate), 2)
    drift = drift_step(a.baro_drift_time, d.baro_period * TICK_S)
    d.baro_drift_decay, d.baro_drift_step = drift.decay, drift.deviation
    d.mag_period = max(whole_ticks(1.0 / a.mag_rate), 2)
