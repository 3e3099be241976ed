# SPDX-License-Identifier: BSD-3-Clause
"""The target attitude and the correction towards it: square-root controllers, thrust axis first, heading after.

The split of an error into thrust and heading is tilt-twist decomposition; see Brescianini, Hehn, D'Andrea,
"Nonlinear quadrocopter attitude control", ETH Zurich, 2013. Heading's error is kept small enough not to take
the motors from roll and pitch.
"""

from __future__ import annotations

import math
from typing import NamedTuple

from ....core.algebra import conjugate, dot, multiply, quat_about_down, quat_norm_squared, rotate
from ....core.kernels import inlined
from ....core.scalars import constrain, finite
from ....core.vectors import Quat, Vec3
from ...control.shaping import inverse_sqrt_controller, sqrt_controller
from ..parameters.control import Attitude
from .attitude_error import split_error
from .state import DT, AttitudeState

CDEG = math.radians(0.01)
DEG = math.radians(1.0)
_ERROR_FREE = math.radians(30.0)  # thrust errors up to here are corrected together with heading
_YAW_ERROR_MAX = math.radians(45.0)
_RP_ACCEL = (math.radians(40.0), math.radians(720.0))  # bounds of half of ATC_ACCEL_R/P_MAX
_YAW_ACCEL = (math.radians(10.0), math.radians(120.0))


class AttitudeGains(NamedTuple):
    """Gains and limits of the correction: roll, pitch, yaw."""

    angle_p: Vec3  # [1/s]
    accel_max: Vec3  # [rad/s^2]; 0: no limit
    rate_max: Vec3  # [rad/s]; 0: no limit
    rate_yaw_p: float  # of the rate loop: says which yaw error the motors can work off; 0: any


class Correction(NamedTuple):
    """What turns the body to its target."""

    rate_target: Vec3  # body rates [rad/s]
    error: Vec3  # turn of the thrust about x and y, of the heading about z [rad]
    error_q: Quat  # target frame to body frame
    thrust_error_angle: float  # between the thrust axis and its target [rad]
    target: Quat  # target frame to NED, moved when the yaw error was limited
    yaw_limited: bool


@inlined
def accel_max(p: Attitude) -> Vec3:
    """Angular acceleration limits of the shaping [rad/s^2] (ATC_ACCEL_*_MAX), 0 for none."""
    return Vec3(p.ACCEL_R_MAX * CDEG, p.ACCEL_P_MAX * CDEG, p.ACCEL_Y_MAX * CDEG)


@inlined
def rate_max(p: Attitude) -> Vec3:
    """Limits of the body rates [rad/s] (ATC_RATE_*_MAX), 0 for none."""
    return Vec3(p.RATE_R_MAX * DEG, p.RATE_P_MAX * DEG, p.RATE_Y_MAX * DEG)


@inlined
def attitude_gains(p: Attitude) -> AttitudeGains:
    """ATC_ANG_*_P with the limits of acceleration and rate."""
    return AttitudeGains(Vec3(p.ANG_RLL_P, p.ANG_PIT_P, p.ANG_YAW_P), accel_max(p), rate_max(p), p.RAT_YAW.P)


@inlined
def limit_rates(rates: Vec3, limit: Vec3) -> Vec3:
    """Body rates within ``limit`` [rad/s], roll and pitch on an ellipse; 0 is no limit."""
    p, q, r = rates.x, rates.y, rates.z
    if limit.x > 0.0 and limit.y > 0.0:
        n = math.sqrt(p * p / (limit.x * limit.x) + q * q / (limit.y * limit.y))
        if n > 1.0:
            p, q = p / n, q / n
    elif limit.x > 0.0:
        p = constrain(p, -limit.x, limit.x)
    elif limit.y > 0.0:
        q = constrain(q, -limit.y, limit.y)
    if limit.z > 0.0:
        r = constrain(r, -limit.z, limit.z)
    return Vec3(p, q, r)


@inlined
def set_target(attitude: AttitudeState, q: Quat) -> None:
    """Replace the target attitude (normalised; one that is not a number becomes the identity)."""
    n2 = quat_norm_squared(q)
    attitude.target_q = q * (1.0 / math.sqrt(n2)) if finite(n2) and n2 > 1e-12 else Quat(1.0, 0.0, 0.0, 0.0)


@inlined
def turned_by_rate(q: Quat, rate: Vec3, dt: float) -> Quat:
    """``q`` after turning at ``rate`` [rad/s, its own frame] for ``dt`` [s], by series: the angle is small."""
    half = rate * (0.5 * dt)
    h2 = dot(half, half)
    s = 1.0 - h2 / 6.0 + h2 * h2 / 120.0
    return multiply(q, Quat(1.0 - 0.5 * h2 + h2 * h2 / 24.0, s * half.x, s * half.y, s * half.z))


@inlined
def correction_rate(error: float, p: float, accel: float) -> float:
    """Roll or pitch rate [rad/s] that takes away ``error`` [rad] within half of ``accel`` [rad/s^2]; 0: no limit."""
    if accel <= 0.0:
        return error * p
    return sqrt_controller(error, p, constrain(0.5 * accel, _RP_ACCEL[0], _RP_ACCEL[1]), DT)


@inlined
def attitude_control(q: Quat, target: Quat, target_rate: Vec3, body_rates: Vec3, gains: AttitudeGains) -> Correction:
    """Body rates that turn attitude ``q`` to ``target`` (both body to NED), which itself turns at ``target_rate``.

    Rates are in [rad/s], ``target_rate`` in the target's frame. A heading that cannot follow holds the target back,
    with thrust where it was asked to be.
    """
    error_q = multiply(conjugate(q), target)
    split = split_error(error_q)
    error, angle = split.error, split.thrust_angle
    accel_yaw = constrain(0.5 * gains.accel_max.z, _YAW_ACCEL[0], _YAW_ACCEL[1])
    yaw_limited = False
    if gains.rate_yaw_p > 0.0 and gains.angle_p.z > 0.0:
        yaw_max = min(inverse_sqrt_controller(1.0 / gains.rate_yaw_p, gains.angle_p.z, accel_yaw), _YAW_ERROR_MAX)
        if abs(error.z) > yaw_max:
            yaw_limited = True
            error = Vec3(error.x, error.y, constrain(error.z, -yaw_max, yaw_max))
            turn = quat_about_down(error.z)
            error_q = multiply(split.thrust_turn, turn)
            target = multiply(q, error_q)

    wanted = Vec3(
        correction_rate(error.x, gains.angle_p.x, gains.accel_max.x),
        correction_rate(error.y, gains.angle_p.y, gains.accel_max.y),
        sqrt_controller(error.z, gains.angle_p.z, accel_yaw if gains.accel_max.z > 0.0 else 0.0, DT),
    )
    rate = limit_rates(wanted, gains.rate_max)
    ahead = rotate(error_q, target_rate)
    if angle > 2.0 * _ERROR_FREE:
        rate = Vec3(rate.x, rate.y, body_rates.z)
    elif angle > _ERROR_FREE:
        k = 2.0 - angle / _ERROR_FREE
        yaw = body_rates.z * (1.0 - k) + (rate.z + ahead.z) * k
        rate = Vec3(rate.x + k * ahead.x, rate.y + k * ahead.y, yaw)
    else:
        rate = rate + ahead
    return Correction(rate, error, error_q, angle, target, yaw_limited)


@inlined
def cos_lean(q: Quat) -> float:
    """Cosine of the lean of attitude ``q``."""
    return 1.0 - 2.0 * (q.x * q.x + q.y * q.y)
