# SPDX-License-Identifier: BSD-3-Clause
"""Figures that follow from those that all airframes have; and how the kinds compute theirs."""

from __future__ import annotations

import math

from ...core.kernels import law
from .sensors.imu import WALK_TICKS
from .tick import TICK_S


@law
def whole_ticks(seconds):
    """Seconds as a whole number of ticks, at least 1."""
    return max(math.floor(seconds / TICK_S + 0.5), 1)


@law
def decay(time_constant, dt):
    """What is left of a first-order error after dt [s]; nothing without a time constant."""
    if time_constant <= 0.0:
        return 0.0
    return math.exp(-dt / time_constant)


@law
def _walk(random_walk, correlation_time, dt):
    """(left over, standard deviation added) of a step dt of a drift; a pure random walk without a time."""
    if correlation_time <= 0.0:
        return (1.0, random_walk * math.sqrt(dt))
    left = math.exp(-dt / correlation_time)
    return (left, random_walk * math.sqrt(0.5 * correlation_time * (1.0 - left * left)))


@law
def prepare_shared(p):
    """Fill the part of ``p.derived`` that follows from battery and sensors in ``p.airframe``."""
    a, d = p.airframe, p.derived
    d.charge_per_amp = 0.0
    if a.battery_capacity > 0.0:
        d.charge_per_amp = TICK_S / (3600.0 * float(a.battery_capacity))
    scale = float(a.noise_scale)
    per_sample = math.sqrt(1.0 / TICK_S)
    d.acc_noise = scale * float(a.acc_noise_density) * per_sample
    d.gyro_noise = scale * float(a.gyro_noise_density) * per_sample
    left, added = _walk(float(a.acc_random_walk), float(a.acc_bias_time), WALK_TICKS * TICK_S)
    d.acc_bias_decay, d.acc_bias_step = left, scale * added
    left, added = _walk(float(a.gyro_random_walk), float(a.gyro_bias_time), WALK_TICKS * TICK_S)
    d.gyro_bias_decay, d.gyro_bias_step = left, scale * added
    d.gps_period = whole_ticks(1.0 / float(a.gps_rate))
    d.gps_delay = math.floor(float(a.gps_delay) / TICK_S + 0.5)
    d.gps_start = whole_ticks(float(a.gps_start))
    d.gps_fix = whole_ticks(float(a.gps_fix_time))
    left = decay(float(a.gps_drift_time), float(d.gps_period) * TICK_S)
    d.gps_drift_decay, d.gps_drift_step = left, math.sqrt(1.0 - left * left)
    d.baro_period = max(whole_ticks(1.0 / float(a.baro_rate)), 2)
    left = decay(float(a.baro_drift_time), float(d.baro_period) * TICK_S)
    d.baro_drift_decay, d.baro_drift_step = left, math.sqrt(1.0 - left * left)
    d.mag_period = max(whole_ticks(1.0 / float(a.mag_rate)), 2)
