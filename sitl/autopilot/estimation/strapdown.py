# SPDX-License-Identifier: BSD-3-Clause
"""Strapdown navigation: attitude, velocity and position from one IMU sample. NED, FRD, SI units, radians.

Samples are means over the tick, as an integrating IMU gives. Attitude takes the two-sample coning term,
velocity the rotation within the tick. Source: Savage, "Strapdown inertial navigation integration algorithm
design", Journal of Guidance, Control, and Dynamics 21, 1998.
"""

from __future__ import annotations

import math

from ...core.algebra import cross, multiply, quat_from_rotation_vector, quat_norm_squared, rotate
from ...core.constants import GRAVITY
from ...core.elementary import atan2
from ...core.kernels import law
from ...core.vectors import Euler, Quat, Vec3
from .state import Ekf

MAX_RATE = 70.0
"""Rates above this are a broken sensor [rad/s] (4000 deg/s)."""
MAX_ACC = 400.0
"""Specific forces above this are a broken sensor [m/s^2] (40 g)."""


@law
def within(vector: Vec3, limit: float) -> bool:
    """Whether a vector is finite and each component at most ``limit`` (NaN is not)."""
    return abs(vector.x) <= limit and abs(vector.y) <= limit and abs(vector.z) <= limit


@law
def read_imu(ekf: Ekf, gyro: Vec3, acc: Vec3) -> None:
    """Keep rates [rad/s] and specific force [m/s^2] of the body that make sense; else the last good ones stand in."""
    if within(gyro, MAX_RATE) and within(acc, MAX_ACC):
        ekf.good_gyro = gyro
        ekf.good_acc = acc
        ekf.bad_imu = 0
    else:
        ekf.bad_imu += 1


@law
def rotation_in_tick(rates: Vec3, last_rates: Vec3, dt: float) -> Vec3:
    """Rotation vector [rad, body] of a tick of ``dt`` [s] from its rates and those of the tick before [rad/s]."""
    return rates * dt + dt * dt / 12.0 * cross(last_rates, rates)


@law
def turned_attitude(q: Quat, turn: Vec3) -> Quat:
    """Attitude after the rotation vector ``turn`` [rad, body]."""
    product = multiply(q, quat_from_rotation_vector(turn))
    # one Newton step keeps the norm: the product of unit quaternions is off by rounding only
    return (1.5 - 0.5 * quat_norm_squared(product)) * product


@law
def mean_force(q: Quat, force: Vec3, turn: Vec3) -> Vec3:
    """Specific force NED [m/s^2] of a tick that begins at ``q`` and turns by ``turn`` [rad], from that of the body."""
    return rotate(q, force + 0.5 * cross(turn, force))


@law
def advance(ekf: Ekf, dt: float) -> None:
    """Move attitude, velocity and position of the nominal state by ``dt`` [s]."""
    rates = ekf.good_gyro - ekf.gyro_bias
    turn = rotation_in_tick(rates, ekf.last_gyro, dt)
    force = mean_force(ekf.q, ekf.good_acc - ekf.acc_bias, turn)
    acc = Vec3(force.x, force.y, force.z + GRAVITY)
    ekf.q = turned_attitude(ekf.q, turn)
    ekf.pos += dt * (ekf.vel + 0.5 * dt * acc)
    ekf.vel += dt * acc
    ekf.last_gyro = rates
    ekf.last_acc_ned = acc
    ekf.step_dv += dt * force
    ekf.step_dt += dt
    ekf.step_ticks += 1


@law
def tilt_from_acc(acc: Vec3) -> Euler:
    """Roll and pitch [rad] of a body at rest from its specific force [m/s^2]; yaw 0."""
    return Euler(atan2(-acc.y, -acc.z), atan2(acc.x, math.sqrt(acc.y * acc.y + acc.z * acc.z)), 0.0)
