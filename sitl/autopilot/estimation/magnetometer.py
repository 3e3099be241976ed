# SPDX-License-Identifier: BSD-3-Clause
"""Yaw from the magnetometer: direction of the horizontal field against the earth's.

Samples are turned to NED with the attitude of their moment and averaged. The declination comes from the
model of the earth's field as soon as a GPS fix tells where the vehicle is; until then it is zero. What is
left of hard iron is estimated: yaw turns and accelerations under GPS tell it from a yaw error.
"""

from __future__ import annotations

import math

from ...core.earth_field import field_ned
from ...core.kernels import law
from ...core.rotations import quat_from_rotation_vector, quat_multiply, quat_rotate
from ...core.scalars import wrap_pi
from .. import events
from . import noise
from .covariance import clear, turn_frame
from .fusion import NIS_MAGNETOMETER, clear_row, correct, gate_ratio, innovate
from .state import BM, THETA
from .strapdown import set_attitude, within

FUSE_SAMPLES = 6
"""Samples averaged into one measurement (12.5 Hz from 75 Hz)."""
TIMEOUT_US = 10_000_000
"""After this long without an accepted yaw the filter takes the magnetometer's."""
IN_FLIGHT_HEIGHT = 2.5
"""Height above the take-off point at which yaw is checked away from what lies on the ground [m]."""
MIN_HORIZONTAL = 0.03
"""Weakest horizontal field that gives a yaw [gauss]."""


@law
def read(ekf, sensors, now_us):
    """Add a new sample, turned to NED, to the sum; one that makes no sense is passed over."""
    if int(sensors.mag_count) == ekf.mag_seen:
        return
    ekf.mag_seen = int(sensors.mag_count)
    x, y, z = float(sensors.mag[0]), float(sensors.mag[1]), float(sensors.mag[2])
    if not within(x, y, z, 2.0) or x * x + y * y + z * z < 0.0025:
        return
    b = ekf.mag_bias
    n, e, d = quat_rotate(ekf.q[0], ekf.q[1], ekf.q[2], ekf.q[3], x - b[0], y - b[1], z - b[2])
    ekf.mag_sum[0] += n
    ekf.mag_sum[1] += e
    ekf.mag_sum[2] += d
    ekf.mag_n += 1
    ekf.mag_us = now_us


@law
def clear_samples(ekf):
    """Begin a new mean (samples turned with an older attitude do not mix with newer ones)."""
    ekf.mag_sum[0], ekf.mag_sum[1], ekf.mag_sum[2] = 0.0, 0.0, 0.0
    ekf.mag_n = 0


@law
def turn(ap, angle):
    """Jump in yaw by ``angle`` [rad]."""
    ekf, estimate = ap.ekf, ap.estimate
    w, x, y, z = quat_from_rotation_vector(0.0, 0.0, angle)
    w, x, y, z = quat_multiply(w, x, y, z, ekf.q[0], ekf.q[1], ekf.q[2], ekf.q[3])
    set_attitude(ekf, w, x, y, z)
    turn_frame(ekf, angle)
    clear_samples(ekf)
    estimate.reset_yaw = wrap_pi(angle)
    estimate.reset_yaw_count += 1


@law
def learn_field(ap, lat_e7, lon_e7):
    """Take the earth's field at a place [degE7]; yaw turns by the declination that was missing until now."""
    ekf = ap.ekf
    n, e, d = field_ned(1e-7 * lat_e7, 1e-7 * lon_e7)
    ekf.earth_field[0], ekf.earth_field[1], ekf.earth_field[2] = n, e, d
    before = ekf.declination
    ekf.declination = math.atan2(e, n)
    ekf.field_known = 1
    if ekf.yaw_aligned != 0:
        turn(ap, ekf.declination - before)


@law
def _row(ekf):
    """Measurement row of the yaw that the magnetometer shows.

    A tilt error lets the vertical field leak into the horizontal one; a bias turns with the body. The field
    is the expected one, not the measured: a row that shares the sample's noise would make the filter drift.
    """
    n, e, d = ekf.earth_field[0], ekf.earth_field[1], ekf.earth_field[2]
    w, x, y, z = ekf.q[0], ekf.q[1], ekf.q[2], ekf.q[3]
    k = 1.0 / (n * n + e * e)
    clear_row(ekf)
    ekf.h[THETA] = -d * n * k
    ekf.h[THETA + 1] = -d * e * k
    ekf.h[THETA + 2] = 1.0
    # first two rows of the rotation matrix
    ekf.h[BM] = k * (e * (1.0 - 2.0 * (y * y + z * z)) - n * 2.0 * (x * y + w * z))
    ekf.h[BM + 1] = k * (e * 2.0 * (x * y - w * z) - n * (1.0 - 2.0 * (x * x + z * z)))
    ekf.h[BM + 2] = k * (e * 2.0 * (x * z + w * y) - n * 2.0 * (y * z - w * x))


@law
def _realign(ap, residual, variance, now_us):
    """Turn to the yaw that the field shows; fusing it then ties yaw to tilt and biases in the covariance."""
    ekf = ap.ekf
    turn(ap, residual)
    clear(ekf, THETA + 2, 1, noise.INITIAL_YAW * noise.INITIAL_YAW)
    _row(ekf)
    innovation, s = innovate(ekf, 0.0, variance)
    correct(ekf, innovation, s, -1)
    ekf.mag_fused_us = now_us
    return 1


@law
def fuse(ap, now_us):
    """Align or fuse yaw when there are enough samples; returns 1 when something was fused."""
    ekf, params = ap.ekf, ap.params
    if ekf.mag_n < FUSE_SAMPLES:
        return 0
    n, e, d = ekf.mag_sum[0] / ekf.mag_n, ekf.mag_sum[1] / ekf.mag_n, ekf.mag_sum[2] / ekf.mag_n
    count = ekf.mag_n
    clear_samples(ekf)
    if ekf.tilt_aligned == 0 or n * n + e * e < MIN_HORIZONTAL * MIN_HORIZONTAL:
        return 0
    if ekf.field_known == 0 and ekf.yaw_aligned == 0:
        ekf.earth_field[0], ekf.earth_field[1], ekf.earth_field[2] = math.sqrt(n * n + e * e), 0.0, d
    h2 = ekf.earth_field[0] * ekf.earth_field[0] + ekf.earth_field[1] * ekf.earth_field[1]
    mag, yaw = noise.MAG * params.EK3.MAG_M_NSE, noise.YAW * params.EK3.YAW_M_NSE
    variance = mag * mag / (count * h2) + yaw * yaw
    residual = wrap_pi(ekf.declination - math.atan2(e, n))
    if ekf.yaw_aligned == 0:
        ekf.yaw_aligned = 1
        events.emit(ap.events, now_us, events.EKF_YAW_ALIGNED, 0.0, 0.0)
        return _realign(ap, residual, variance, now_us)
    _row(ekf)
    innovation, s = innovate(ekf, residual, variance)
    nominal = params.EK3.MAG_M_NSE / math.sqrt(h2)
    ratio = gate_ratio(innovation * innovation, s, nominal, params.EK3.YAW_I_GATE)
    ap.estimate.variance_mag = math.sqrt(ratio)
    leaving = ekf.yaw_in_flight == 0 and ap.arming.armed != 0 and ekf.ground_d - ekf.pos[2] > IN_FLIGHT_HEIGHT
    if leaving:
        ekf.yaw_in_flight = 1
        events.emit(ap.events, now_us, events.EKF_YAW_ALIGNED_IN_FLIGHT, 0.0, 0.0)
    if ratio < 1.0:
        correct(ekf, innovation, s, NIS_MAGNETOMETER)
        ekf.mag_fused_us = now_us
        return 1
    if leaving or now_us - ekf.mag_fused_us > TIMEOUT_US:
        return _realign(ap, residual, variance, now_us)
    return 0
