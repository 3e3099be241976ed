# SPDX-License-Identifier: BSD-3-Clause
"""Accelerometer and gyro, one sample a tick: the mean over the tick, as an integrating IMU gives it.

Model (as in kalibr and RotorS): white noise + turn-on bias + in-run bias (first-order Gauss-Markov) + scale
error + range.
"""

from __future__ import annotations

from ....core.algebra import by_component, rotate
from ....core.border import Sensors
from ....core.constants import TICK_S
from ....core.kernels import law
from ....core.rng import Rng, normal, normal_vectors
from ....core.vectors import Vec3
from ....vehicles.properties.body import Properties
from ..records import Derived, Physics, SensorState
from .imu_faults import Sample, saturate, show

WALK_TICKS = 40
"""The in-run biases are stepped every 0.1 s."""


@law
def measure(truth: Vec3, scale: Vec3, bias: Vec3, noise: Vec3) -> Vec3:
    """What a sensor of three axes shows."""
    return by_component(truth, scale) + bias + noise


@law
def sample(p: Physics, sensors: Sensors, rng: Rng) -> None:
    """Write acc [m/s^2] and gyro [rad/s], body frame."""
    a, s, d, body = p.airframe, p.sensors, p.derived, p.body
    force = rotate(s.acc_mount, body.specific_force) if s.acc_is_turned else body.specific_force
    acc_noise, gyro_noise = normal_vectors(rng)
    acc = measure(force, s.acc_scale, s.acc_bias + s.acc_walk, d.acc_noise * acc_noise)
    gyro = measure(body.rates_mean, s.gyro_scale, s.gyro_bias + s.gyro_walk, d.gyro_noise * gyro_noise)
    if s.imus_faulty:
        show(p, sensors, rng, Sample(acc, gyro), Sample(force, body.rates_mean))
        return
    sensors.acc, sensors.gyro = saturate(acc, a.acc_range), saturate(gyro, a.gyro_range)


@law
def walk(s: SensorState, d: Derived, rng: Rng) -> None:
    """Step the in-run biases by WALK_TICKS ticks."""
    acc_x, gyro_x = normal(rng), normal(rng)
    acc_y, gyro_y = normal(rng), normal(rng)
    acc_z, gyro_z = normal(rng), normal(rng)
    s.acc_walk = d.acc_bias_decay * s.acc_walk + d.acc_bias_step * Vec3(acc_x, acc_y, acc_z)
    s.gyro_walk = d.gyro_bias_decay * s.gyro_walk + d.gyro_bias_step * Vec3(gyro_x, gyro_y, gyro_z)


@law
def drift(s: SensorState, a: Properties, tick: int) -> None:
    """The steady part of the same step of the gyro's bias."""
    if a.gyro_drift_speed == 0.0:
        return
    period = int(a.gyro_drift_time / TICK_S)
    forth = period <= 0 or tick % (2 * period) < period
    step = (a.noise_scale if forth else -a.noise_scale) * a.gyro_drift_speed * WALK_TICKS * TICK_S
    s.gyro_walk += Vec3(step, step, step)
