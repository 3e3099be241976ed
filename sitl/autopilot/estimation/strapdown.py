# SPDX-License-Identifier: BSD-3-Clause
"""Strapdown navigation: attitude, velocity and position from one IMU sample. NED, FRD, SI units, radians.

Samples are means over the tick, as an integrating IMU gives. Attitude takes the two-sample coning term,
velocity the rotation within the tick. Source: Savage, "Strapdown inertial navigation integration algorithm
design", Journal of Guidance, Control, and Dynamics 21, 1998.
"""

from __future__ import annotations

import math

from ...core.kernels import law
from ...core.rotations import quat_from_rotation_vector, quat_multiply, quat_normalise, quat_rotate

GRAVITY = 9.80665
MAX_RATE = 70.0
"""Rates above this are a broken sensor [rad/s] (4000 deg/s)."""
MAX_ACC = 400.0
"""Specific forces above this are a broken sensor [m/s^2] (40 g)."""


@law
def within(x, y, z, limit):
    """Whether a vector is finite and each component at most ``limit`` (NaN is not)."""
    return abs(x) <= limit and abs(y) <= limit and abs(z) <= limit


@law
def read_imu(ekf, sensors):
    """Keep the sample in ``good_gyro``/``good_acc`` when it makes sense; else the last good one stands in."""
    p, q, r = float(sensors.gyro[0]), float(sensors.gyro[1]), float(sensors.gyro[2])
    x, y, z = float(sensors.acc[0]), float(sensors.acc[1]), float(sensors.acc[2])
    if within(p, q, r, MAX_RATE) and within(x, y, z, MAX_ACC):
        ekf.good_gyro[0], ekf.good_gyro[1], ekf.good_gyro[2] = p, q, r
        ekf.good_acc[0], ekf.good_acc[1], ekf.good_acc[2] = x, y, z
        ekf.bad_imu = 0
    else:
        ekf.bad_imu += 1


@law
def advance(ekf, dt):
    """Move attitude, velocity and position of the nominal state by ``dt`` [s]."""
    p = ekf.good_gyro[0] - ekf.gyro_bias[0]
    q = ekf.good_gyro[1] - ekf.gyro_bias[1]
    r = ekf.good_gyro[2] - ekf.gyro_bias[2]
    k = dt * dt / 12.0
    p0, q0, r0 = ekf.last_gyro[0], ekf.last_gyro[1], ekf.last_gyro[2]
    ax = p * dt + k * (q0 * r - r0 * q)
    ay = q * dt + k * (r0 * p - p0 * r)
    az = r * dt + k * (p0 * q - q0 * p)
    ekf.last_gyro[0], ekf.last_gyro[1], ekf.last_gyro[2] = p, q, r

    x = ekf.good_acc[0] - ekf.acc_bias[0]
    y = ekf.good_acc[1] - ekf.acc_bias[1]
    z = ekf.good_acc[2] - ekf.acc_bias[2]
    w, i, j, m = ekf.q[0], ekf.q[1], ekf.q[2], ekf.q[3]
    fn, fe, fd = quat_rotate(
        w, i, j, m, x + 0.5 * (ay * z - az * y), y + 0.5 * (az * x - ax * z), z + 0.5 * (ax * y - ay * x)
    )
    dw, dx, dy, dz = quat_from_rotation_vector(ax, ay, az)
    w, i, j, m = quat_multiply(w, i, j, m, dw, dx, dy, dz)
    # one Newton step keeps the norm: the product of unit quaternions is off by rounding only
    n = 1.5 - 0.5 * (w * w + i * i + j * j + m * m)
    ekf.q[0], ekf.q[1], ekf.q[2], ekf.q[3] = n * w, n * i, n * j, n * m

    an, ae, ad = fn, fe, fd + GRAVITY
    ekf.pos[0] += dt * (ekf.vel[0] + 0.5 * dt * an)
    ekf.pos[1] += dt * (ekf.vel[1] + 0.5 * dt * ae)
    ekf.pos[2] += dt * (ekf.vel[2] + 0.5 * dt * ad)
    ekf.vel[0] += dt * an
    ekf.vel[1] += dt * ae
    ekf.vel[2] += dt * ad
    ekf.last_acc_ned[0], ekf.last_acc_ned[1], ekf.last_acc_ned[2] = an, ae, ad
    ekf.step_dv[0] += dt * fn
    ekf.step_dv[1] += dt * fe
    ekf.step_dv[2] += dt * fd
    ekf.step_dt += dt
    ekf.step_ticks += 1


@law
def set_attitude(ekf, w, x, y, z):
    """Set the nominal attitude (any length of quaternion)."""
    ekf.q[0], ekf.q[1], ekf.q[2], ekf.q[3] = quat_normalise(w, x, y, z)


@law
def tilt_from_acc(x, y, z):
    """(roll, pitch) [rad] of a body at rest from its specific force [m/s^2]."""
    return (math.atan2(-y, -z), math.atan2(x, math.sqrt(y * y + z * z)))
