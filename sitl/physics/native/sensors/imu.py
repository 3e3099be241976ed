# SPDX-License-Identifier: BSD-3-Clause
"""Accelerometer and gyro, one sample a tick: the mean over the tick, as an integrating IMU gives it.

Model (as in kalibr and RotorS): white noise + turn-on bias + in-run bias (first-order Gauss-Markov) + scale
error + range.
"""

from __future__ import annotations

from ....core.kernels import law
from ....core.rng import normal
from ....core.vectors import Vec3

WALK_TICKS = 40
"""The in-run biases are stepped every 0.1 s."""


@law
def _limit(value, bound):
    return min(max(value, -bound), bound)


@law
def _acc(p, rng, j):
    s = p.sensors
    bias = float(s.acc_bias[j]) + float(s.acc_walk[j])
    value = float(p.body.specific_force[j]) * float(s.acc_scale[j]) + bias + p.derived.acc_noise * normal(rng)
    return _limit(value, p.airframe.acc_range)


@law
def _gyro(p, rng, j):
    s = p.sensors
    bias = float(s.gyro_bias[j]) + float(s.gyro_walk[j])
    value = float(p.body.rates_mean[j]) * float(s.gyro_scale[j]) + bias + p.derived.gyro_noise * normal(rng)
    return _limit(value, p.airframe.gyro_range)


@law
def sample(p, sensors, rng):
    """Write acc [m/s^2] and gyro [rad/s], body frame."""
    sensors.acc = Vec3(_acc(p, rng, 0), _acc(p, rng, 1), _acc(p, rng, 2))
    sensors.gyro = Vec3(_gyro(p, rng, 0), _gyro(p, rng, 1), _gyro(p, rng, 2))


@law
def walk(p, rng):
    """Step the in-run biases by WALK_TICKS ticks."""
    s, d = p.sensors, p.derived
    for j in range(3):
        left, added = float(d.acc_bias_decay), float(d.acc_bias_step)
        s.acc_walk[j] = left * float(s.acc_walk[j]) + added * normal(rng)
        left, added = float(d.gyro_bias_decay), float(d.gyro_bias_step)
        s.gyro_walk[j] = left * float(s.gyro_walk[j]) + added * normal(rng)
