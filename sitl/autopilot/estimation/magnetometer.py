# SPDX-License-Identifier: BSD-3-Clause
"""Yaw from the magnetometer: direction of the horizontal field against the earth's.

Samples are turned to NED with the attitude of their moment and averaged. The declination comes from the
model of the earth's field as soon as a GPS fix gives where the vehicle is; until then it is zero. What is
left of hard iron is estimated: yaw turns and accelerations under GPS tell it from a yaw error.

So it is with EK3_MAG_CAL 4; otherwise heading.py fuses the means.
"""

from __future__ import annotations

import math

from ...core.algebra import (
    ZERO,
    dot,
    horizontal,
    multiply,
    norm2,
    normalise,
    quat_from_rotation_vector,
    rotate,
    rotation_matrix,
)
from ...core.earth_field import field_ned
from ...core.elementary import atan2
from ...core.kernels import law
from ...core.scalars import wrap_pi
from ...core.vectors import Vec3
from ..events import Events, emit
from ..params.estimator import Ekf3
from ..state import Estimate
from . import noise
from .covariance import clear, turn_frame
from .estimator_events import EKF_YAW_ALIGNED, EKF_YAW_ALIGNED_IN_FLIGHT
from .fusion import NIS_MAGNETOMETER, NO_NIS, clear_row, correct, gate_ratio, innovate
from .state import BM, THETA, Ekf
from .strapdown import within

FUSE_SAMPLES = 6
"""Samples averaged into one measurement (12.5 Hz from 75 Hz)."""
TIMEOUT_US = 10_000_000
"""After this long without an accepted yaw the filter takes the magnetometer's."""
IN_FLIGHT_HEIGHT = 2.5
"""Height above the take-off point at which yaw is checked away from what lies on the ground [m]."""
MIN_HORIZONTAL = 0.005
"""Weakest horizontal field that gives a yaw [gauss]; at the geographic poles there are some 0.02."""


@law
def read(ekf: Ekf, count: int, field: Vec3) -> None:
    """Add sample ``count`` [gauss], turned to NED, to the sum if it is new; one that makes no sense is passed over."""
    if count == ekf.mag_seen:
        return
    ekf.mag_seen = count
    if not within(field, 2.0) or dot(field, field) < 0.0025:
        return
    ekf.mag_sum += rotate(ekf.q, field - ekf.mag_bias)
    ekf.mag_n += 1
    ekf.mag_us = ekf.now_us


@law
def clear_samples(ekf: Ekf) -> None:
    """Begin a new mean (samples turned with an older attitude do not mix with newer ones)."""
    ekf.mag_sum = ZERO
    ekf.mag_n = 0


@law
def turn(ekf: Ekf, estimate: Estimate, angle: float) -> None:
    """Jump in yaw by ``angle`` [rad]."""
    ekf.q = normalise(multiply(quat_from_rotation_vector(Vec3(0.0, 0.0, angle)), ekf.q))
    turn_frame(ekf.P, angle)
    clear_samples(ekf)
    estimate.reset_yaw = wrap_pi(angle)
    estimate.reset_yaw_count += 1


@law
def learn_field(ekf: Ekf, estimate: Estimate, lat_e7: int, lon_e7: int) -> None:
    """Take the earth's field at a location [degE7]; yaw turns by the declination that was missing until now.

    Where the heading alone is fused it does not turn: fusion brings the declination in.
    """
    ekf.earth_field = field_ned(1e-7 * lat_e7, 1e-7 * lon_e7)
    before = ekf.declination
    ekf.declination = atan2(ekf.earth_field.y, ekf.earth_field.x)
    ekf.field_known = True
    if ekf.yaw_aligned and not ekf.without_compass and not ekf.heading_only:
        turn(ekf, estimate, ekf.declination - before)


@law
def take_mean(ekf: Ekf) -> Vec3:
    """Mean of the samples [gauss], NED; the next one begins."""
    field = ekf.mag_sum / ekf.mag_n
    clear_samples(ekf)
    return field


@law
def shows_yaw(ekf: Ekf, field: Vec3) -> bool:
    """Whether a mean has a direction that can be told: tilt is known, and not all of the field is vertical."""
    n, e = field.x, field.y
    return ekf.tilt_aligned and n * n + e * e >= MIN_HORIZONTAL * MIN_HORIZONTAL


@law
def assume_field(ekf: Ekf, field: Vec3) -> None:
    """While nothing is known of the earth's field: the mean is it, and its horizontal part points north."""
    if not ekf.field_known and not ekf.yaw_aligned:
        ekf.earth_field = Vec3(norm2(horizontal(field)), 0.0, field.z)


@law
def set_row(ekf: Ekf) -> None:
    """Measurement row of the yaw that the magnetometer shows.

    A tilt error lets the vertical field leak into the horizontal one; a bias turns with the body. The field
    is the expected one, not the measured: a row that shares the sample's noise would make the filter drift.
    """
    n, e, d = ekf.earth_field.x, ekf.earth_field.y, ekf.earth_field.z
    k = 1.0 / (n * n + e * e)
    body = rotation_matrix(ekf.q)
    bias = k * (e * body.x - n * body.y)
    clear_row(ekf)
    ekf.h[THETA], ekf.h[THETA + 1], ekf.h[THETA + 2] = -d * n * k, -d * e * k, 1.0
    ekf.h[BM], ekf.h[BM + 1], ekf.h[BM + 2] = bias.x, bias.y, bias.z


@law
def _realign(ekf: Ekf, estimate: Estimate, residual: float, variance: float) -> None:
    """Turn to the yaw that the field shows; fusing it then ties yaw to tilt and biases in the covariance."""
    turn(ekf, estimate, residual)
    clear(ekf.P, THETA + 2, 1, noise.INITIAL_YAW * noise.INITIAL_YAW)
    set_row(ekf)
    correct(ekf, innovate(ekf, 0.0, variance), NO_NIS)
    ekf.mag_fused_us = ekf.now_us


@law
def is_leaving_ground(ekf: Ekf, armed: bool) -> bool:
    """Whether the vehicle has just come away from what disturbs the field on the ground."""
    return not ekf.yaw_in_flight and armed and ekf.ground_d - ekf.pos.z > IN_FLIGHT_HEIGHT


@law
def is_yaw_confirmed(ekf: Ekf, estimate: Estimate) -> bool:
    """Whether velocities of GPS speak for the yaw: with a wrong one, accelerations would contradict them."""
    return ekf.absolute and not ekf.gps_glitch and estimate.variance_vel < 1.0


@law
def fuse(ekf: Ekf, estimate: Estimate, log: Events, params: Ekf3, armed: bool) -> bool:
    """Align or fuse yaw when there are enough samples; whether something was fused."""
    count = ekf.mag_n
    if count < FUSE_SAMPLES:
        return False
    field = take_mean(ekf)
    if not shows_yaw(ekf, field):
        return False
    assume_field(ekf, field)
    expected = ekf.earth_field
    h2 = expected.x * expected.x + expected.y * expected.y
    mag, yaw = noise.MAG * params.MAG_M_NSE, noise.YAW * params.YAW_M_NSE
    variance = mag * mag / (count * h2) + yaw * yaw
    residual = wrap_pi(ekf.declination - atan2(field.y, field.x))
    if not ekf.yaw_aligned:
        ekf.yaw_aligned = True
        emit(log, ekf.now_us, EKF_YAW_ALIGNED, float(ekf.imu), float(ekf.compass))
        _realign(ekf, estimate, residual, variance)
        return True
    set_row(ekf)
    innovation = innovate(ekf, residual, variance)
    ekf.innovation_yaw = innovation.value
    nominal = params.MAG_M_NSE / math.sqrt(h2)
    ratio = gate_ratio(innovation.value * innovation.value, innovation.variance, nominal, params.YAW_I_GATE)
    estimate.variance_mag = math.sqrt(ratio)
    leaving = is_leaving_ground(ekf, armed)
    if leaving:
        ekf.yaw_in_flight = True
        emit(log, ekf.now_us, EKF_YAW_ALIGNED_IN_FLIGHT, float(ekf.imu), float(ekf.compass))
    if ratio < 1.0:
        correct(ekf, innovation, NIS_MAGNETOMETER)
        ekf.mag_fused_us = ekf.now_us
        return True
    if leaving or (ekf.now_us - ekf.mag_fused_us > TIMEOUT_US and not (armed and is_yaw_confirmed(ekf, estimate))):
        _realign(ekf, estimate, residual, variance)
        return True
    return False
