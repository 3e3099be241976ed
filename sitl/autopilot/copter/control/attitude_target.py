# SPDX-License-Identifier: BSD-3-Clause
"""The target attitude and the correction towards it: square-root controllers, thrust axis first, heading
after.

The split of an error into thrust and heading is tilt-twist decomposition; see Brescianini, Hehn, D'Andrea,
"Nonlinear quadrocopter attitude control", ETH Zurich, 2013. Heading's error is kept small enough not to take
the motors from roll and pitch.
"""

from __future__ import annotations

import math

from ....core.kernels import law
from ....core.rotations import quat_multiply, quat_rotate, quat_to_euler
from ....core.scalars import constrain, finite
from ...control.shaping import inverse_sqrt_controller, sqrt_controller
from .attitude_error import split_error
from .state import DT

CDEG = math.radians(0.01)
DEG = math.radians(1.0)
_ERROR_FREE = math.radians(30.0)  # thrust errors up to here are corrected together with heading
_YAW_ERROR_MAX = math.radians(45.0)
_RP_ACCEL = (math.radians(40.0), math.radians(720.0))  # bounds of half of ATC_ACCEL_R/P_MAX
_YAW_ACCEL = (math.radians(10.0), math.radians(120.0))


@law
def accel_max(ap):
    """Angular acceleration limits of the shaping [rad/s^2], 0 for none."""
    p = ap.params
    return (float(p.ATC.ACCEL_R_MAX) * CDEG, float(p.ATC.ACCEL_P_MAX) * CDEG, float(p.ATC.ACCEL_Y_MAX) * CDEG)


@law
def limit_rates(ap, p, q, r, yaw_max):
    """Rates within ATC_RATE_*_MAX (roll and pitch on an ellipse) and ``yaw_max`` [rad/s]; 0 is no limit."""
    roll = float(ap.params.ATC.RATE_R_MAX) * DEG
    pitch = float(ap.params.ATC.RATE_P_MAX) * DEG
    yaw = float(ap.params.ATC.RATE_Y_MAX) * DEG
    if roll > 0.0 and pitch > 0.0:
        n = math.sqrt(p * p / (roll * roll) + q * q / (pitch * pitch))
        if n > 1.0:
            p, q = p / n, q / n
    elif roll > 0.0:
        p = constrain(p, -roll, roll)
    elif pitch > 0.0:
        q = constrain(q, -pitch, pitch)
    if yaw_max > 0.0 and (yaw <= 0.0 or yaw_max < yaw):
        yaw = yaw_max
    if yaw > 0.0:
        r = constrain(r, -yaw, yaw)
    return (p, q, r)


@law
def slew_yaw_max(ap):
    """Fastest turn of modes that fly by themselves [rad/s]: ATC_SLEW_YAW, at most ATC_RATE_Y_MAX; 0 is no
    limit.
    """
    slew = float(ap.params.ATC.SLEW_YAW) * CDEG
    most = float(ap.params.ATC.RATE_Y_MAX) * DEG
    return min(slew, most) if most > 0.0 and slew > 0.0 else slew


@law
def set_target(ap, w, x, y, z):
    """Replace the target attitude (normalised; one that is not a number becomes the identity)."""
    n2 = w * w + x * x + y * y + z * z
    if finite(n2) and n2 > 1e-12:
        k = 1.0 / math.sqrt(n2)
        w, x, y, z = w * k, x * k, y * k, z * k
    else:
        w, x, y, z = 1.0, 0.0, 0.0, 0.0
    q = ap.control.attitude.target_q
    q[0], q[1], q[2], q[3] = w, x, y, z
    euler = ap.control.attitude.target_euler
    euler[0], euler[1], euler[2] = quat_to_euler(w, x, y, z)


@law
def set_target_rate(ap, p, q, r):
    """Replace the angular velocity of the target [rad/s, target frame]."""
    rates = ap.control.attitude.target_rate
    rates[0], rates[1], rates[2] = p, q, r


@law
def advance_target(ap):
    """Turn the target by its angular velocity for one tick (by series: the angle is small)."""
    a = ap.control.attitude
    hx = 0.5 * DT * float(a.target_rate[0])
    hy = 0.5 * DT * float(a.target_rate[1])
    hz = 0.5 * DT * float(a.target_rate[2])
    h2 = hx * hx + hy * hy + hz * hz
    s = 1.0 - h2 / 6.0 + h2 * h2 / 120.0
    q = a.target_q
    w, x, y, z = quat_multiply(
        float(q[0]), float(q[1]), float(q[2]), float(q[3]),
        1.0 - 0.5 * h2 + h2 * h2 / 24.0, s * hx, s * hy, s * hz,
    )  # fmt: skip
    set_target(ap, w, x, y, z)


@law
def correct(ap):
    """Body-rate targets from the difference between target and estimate, plus the target's own angular
    velocity.
    """
    a = ap.control.attitude
    est = ap.estimate
    p = ap.params
    bw, bx, by, bz = float(est.q[0]), float(est.q[1]), float(est.q[2]), float(est.q[3])
    ew, ex, ey, ez = quat_multiply(
        bw, -bx, -by, -bz,
        float(a.target_q[0]), float(a.target_q[1]), float(a.target_q[2]), float(a.target_q[3]),
    )  # fmt: skip
    rx, ry, rz, angle, tw, tx, ty = split_error(ew, ex, ey, ez)

    accel_r, accel_p, accel_y = accel_max(ap)
    accel_yaw = constrain(0.5 * accel_y, _YAW_ACCEL[0], _YAW_ACCEL[1])
    yaw_p = float(p.ATC.ANG_YAW_P)
    if p.ATC.RAT_YAW.P > 0.0 and yaw_p > 0.0:
        most = min(inverse_sqrt_controller(1.0 / float(p.ATC.RAT_YAW.P), yaw_p, accel_yaw), _YAW_ERROR_MAX)
        if abs(rz) > most:
            # The heading cannot follow: the target waits for it, with thrust where it was asked to be.
            rz = constrain(rz, -most, most)
            cz, sz = math.cos(0.5 * rz), math.sin(0.5 * rz)
            ew, ex, ey, ez = quat_multiply(tw, tx, ty, 0.0, cz, 0.0, 0.0, sz)
            w, x, y, z = quat_multiply(bw, bx, by, bz, ew, ex, ey, ez)
            set_target(ap, w, x, y, z)

    wx = _corrected(rx, float(p.ATC.ANG_RLL_P), accel_r)
    wy = _corrected(ry, float(p.ATC.ANG_PIT_P), accel_p)
    wz = sqrt_controller(rz, yaw_p, accel_yaw if accel_y > 0.0 else 0.0, DT)
    wx, wy, wz = limit_rates(ap, wx, wy, wz, 0.0)

    fx, fy, fz = quat_rotate(ew, ex, ey, ez, float(a.target_rate[0]), float(a.target_rate[1]), float(a.target_rate[2]))
    if angle > 2.0 * _ERROR_FREE:
        wz = float(est.rates[2])
    elif angle > _ERROR_FREE:
        k = 2.0 - angle / _ERROR_FREE
        wx, wy = wx + k * fx, wy + k * fy
        wz = float(est.rates[2]) * (1.0 - k) + (wz + fz) * k
    else:
        wx, wy, wz = wx + fx, wy + fy, wz + fz
    a.rate_target[0], a.rate_target[1], a.rate_target[2] = wx, wy, wz
    a.error[0], a.error[1], a.error[2] = rx, ry, rz
    a.error_q[0], a.error_q[1], a.error_q[2], a.error_q[3] = ew, ex, ey, ez
    a.thrust_error_angle = angle
    a.cos_lean = 1.0 - 2.0 * (bx * bx + by * by)


@law
def _corrected(error, p, accel):
    if accel <= 0.0:
        return error * p
    return sqrt_controller(error, p, constrain(0.5 * accel, _RP_ACCEL[0], _RP_ACCEL[1]), DT)


@law
def follow_yaw_reset(ap):
    """When the estimate's heading jumps, the target jumps with it: the vehicle does not turn."""
    a = ap.control.attitude
    if a.yaw_reset_count == ap.estimate.reset_yaw_count:
        return
    a.yaw_reset_count = ap.estimate.reset_yaw_count
    if not ap.control.tick > 0:
        return
    b, e = ap.estimate.q, a.error_q
    w, x, y, z = quat_multiply(
        float(b[0]), float(b[1]), float(b[2]), float(b[3]), float(e[0]), float(e[1]), float(e[2]), float(e[3])
    )
    set_target(ap, w, x, y, z)
