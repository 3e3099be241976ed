# SPDX-License-Identifier: BSD-3-Clause
"""Accelerometer and gyro, one sample a tick: the mean over the tick, as an integrating IMU gives it.

Model (as in kalibr and RotorS): white noise + turn-on bias + in-run bias (first-order Gauss-Markov) + scale
error + range.
"""

from __future__ import annotations

from ....core.kernels import law
from ....core.rng import normal

WALK_TICKS = 40
"""The in-run biases are stepped every 0.1 s."""


@law
def _limit(value, bound):
    return min(max(value, -bound), bound)


@law
def sample(p, sensors, rng):
    """Write acc [m/s^2] and gyro [rad/s], body frame."""
    a, s, b, d = p.airframe, p.sensors, p.body, p.derived
    acc_noise, gyro_noise = float(d.acc_noise), float(d.gyro_noise)
    acc_range, gyro_range = float(a.acc_range), float(a.gyro_range)
    for j in range(3):
        bias = float(s.acc_bias[j]) + float(s.acc_walk[j])
        value = float(b.specific_force[j]) * float(s.acc_scale[j]) + bias + acc_noise * normal(rng)
        sensors.acc[j] = _limit(value, acc_range)
    for j in range(3):
        bias = float(s.gyro_bias[j]) + float(s.gyro_walk[j])
        value = float(b.rates_mean[j]) * float(s.gyro_scale[j]) + bias + gyro_noise * normal(rng)
        sensors.gyro[j] = _limit(value, gyro_range)


@law
def walk(p, rng):
    """Step the in-run biases by WALK_TICKS ticks."""
    s, d = p.sensors, p.derived
    for j in range(3):
        left, added = float(d.acc_bias_decay), float(d.acc_bias_step)
        s.acc_walk[j] = left * float(s.acc_walk[j]) + added * normal(rng)
        left, added = float(d.gyro_bias_decay), float(d.gyro_bias_step)
        s.gyro_walk[j] = left * float(s.gyro_walk[j]) + added * normal(rng)
