# SPDX-License-Identifier: BSD-3-Clause
"""Attitude: from what modes ask for to body-rate targets.

Two steps each tick. *Shaping* (here) moves the target attitude, with limited angular acceleration
(ATC_ACCEL_*_MAX) and an exponential end (ATC_INPUT_TC), towards what was asked; its angular velocity is fed
forward (ATC_RATE_FF_ENAB). *Correction* (``attitude_target.correct``) turns the body to the target. Each
``input_*`` law makes both steps and is called once a tick. What is asked in numbers that are not finite is
ignored: the target comes to rest where it is.
"""

from __future__ import annotations

import math

from ....core.kernels import law
from ....core.rotations import quat_from_euler, quat_from_rotation_vector, quat_multiply
from ....core.scalars import constrain, finite, wrap_pi
from ...control.shaping import shape_angle, shape_rate
from . import rate
from .attitude_error import body_rates, euler_accel_limits, euler_rates, split_error, thrust_quaternion
from .attitude_target import (
    accel_max,
    advance_target,
    correct,
    follow_yaw_reset,
    limit_rates,
    set_target,
    set_target_rate,
    slew_yaw_max,
)
from .state import DT
from .throttle_mix import lean_limit, set_mix_man, set_mix_max, set_mix_min, set_throttle_out

__all__ = [
    "input_euler_roll_pitch_yaw",
    "input_euler_roll_pitch_yaw_rate",
    "input_quaternion",
    "input_rates",
    "input_thrust_vector_heading",
    "input_thrust_vector_heading_rate",
    "lean_limit",
    "relax",
    "reset_yaw_target",
    "set_mix_man",
    "set_mix_max",
    "set_mix_min",
    "set_throttle_out",
    "slew_yaw_max",
]


@law
def _begin(ap):
    """What every input starts with; returns whether targets are shaped (ATC_RATE_FF_ENAB)."""
    follow_yaw_reset(ap)
    advance_target(ap)
    return ap.params.ATC.RATE_FF_ENAB != 0.0


@law
def _shape_euler(ap, roll, pitch, yaw, yaw_rate, use_yaw, yaw_slew):
    """Shape towards Euler angles: heading ``yaw`` when ``use_yaw`` != 0, else a turn at ``yaw_rate``."""
    a = ap.control.attitude
    tau = float(ap.params.ATC.INPUT_TC)
    r, p, y = float(a.target_euler[0]), float(a.target_euler[1]), float(a.target_euler[2])
    ax, ay, az = accel_max(ap)
    ax, ay, az = euler_accel_limits(r, p, ax, ay, az)
    er, ep, ey = euler_rates(r, p, float(a.target_rate[0]), float(a.target_rate[1]), float(a.target_rate[2]))
    er = shape_angle(wrap_pi(roll - r), tau, ax, er, 0.0, 0.0, DT)
    ep = shape_angle(wrap_pi(pitch - p), tau, ay, ep, 0.0, 0.0, DT)
    if use_yaw != 0:
        ey = shape_angle(wrap_pi(yaw - y), tau, az, ey, 0.0, 0.0, DT)
        if yaw_slew > 0.0:
            ey = constrain(ey, -yaw_slew, yaw_slew)
    else:
        ey = shape_rate(ey, yaw_rate, az, float(ap.params.PILOT.Y_RATE_TC), DT)
    wx, wy, wz = body_rates(r, p, er, ep, ey)
    wx, wy, wz = limit_rates(ap, wx, wy, wz, 0.0)
    set_target_rate(ap, wx, wy, wz)


@law
def _jump_euler(ap, roll, pitch, yaw):
    w, x, y, z = quat_from_euler(roll, pitch, yaw)
    set_target(ap, w, x, y, z)
    set_target_rate(ap, 0.0, 0.0, 0.0)


@law
def input_euler_roll_pitch_yaw_rate(ap, roll, pitch, yaw_rate):
    """Lean to ``roll``, ``pitch`` [rad] while turning at ``yaw_rate`` [rad/s]."""
    shaped = _begin(ap)
    euler = ap.control.attitude.target_euler
    if not (finite(roll) and finite(pitch) and finite(yaw_rate)):
        roll, pitch, yaw_rate = float(euler[0]), float(euler[1]), 0.0
    if shaped:
        _shape_euler(ap, roll, pitch, 0.0, yaw_rate, 0, 0.0)
    else:
        _jump_euler(ap, roll, pitch, float(euler[2]) + yaw_rate * DT)
    correct(ap)


@law
def input_euler_roll_pitch_yaw(ap, roll, pitch, yaw, slew_yaw):
    """Lean to ``roll``, ``pitch`` and turn to ``yaw`` [rad]; ``slew_yaw`` != 0 keeps the turn below
    ATC_SLEW_YAW.
    """
    shaped = _begin(ap)
    euler = ap.control.attitude.target_euler
    if not (finite(roll) and finite(pitch) and finite(yaw)):
        roll, pitch, yaw = float(euler[0]), float(euler[1]), float(euler[2])
    slew = slew_yaw_max(ap) if slew_yaw != 0 else 0.0
    if shaped:
        _shape_euler(ap, roll, pitch, yaw, 0.0, 1, slew)
    else:
        turn = wrap_pi(yaw - float(euler[2]))
        if slew > 0.0:
            turn = constrain(turn, -slew * DT, slew * DT)
        _jump_euler(ap, roll, pitch, float(euler[2]) + turn)
    correct(ap)


@law
def _target_error(ap, w, x, y, z):
    """Rotation from the target to the attitude (w, x, y, z), target frame."""
    q = ap.control.attitude.target_q
    return quat_multiply(float(q[0]), -float(q[1]), -float(q[2]), -float(q[3]), w, x, y, z)


@law
def _shape_rotation(ap, rx, ry, rz, p, q, r, yaw_max):
    """Shape towards an attitude that is (rx, ry, rz) [rad] away and itself turns at (p, q, r) [rad/s]."""
    a = ap.control.attitude
    tau = float(ap.params.ATC.INPUT_TC)
    ax, ay, az = accel_max(ap)
    wx = shape_angle(rx, tau, ax, float(a.target_rate[0]), p, 0.0, DT)
    wy = shape_angle(ry, tau, ay, float(a.target_rate[1]), q, 0.0, DT)
    wz = shape_angle(rz, tau, az, float(a.target_rate[2]), r, yaw_max, DT)
    wx, wy, wz = limit_rates(ap, wx, wy, wz, yaw_max)
    set_target_rate(ap, wx, wy, wz)


@law
def input_thrust_vector_heading(ap, tx, ty, tz, heading, heading_rate):
    """Point thrust along the NED vector (tx, ty, tz) and the nose to ``heading`` [rad], which moves at
    ``heading_rate``.
    """
    shaped = _begin(ap)
    if not (finite(tx) and finite(ty) and finite(tz) and finite(heading) and finite(heading_rate)):
        _hold(ap, shaped)
        return
    most = slew_yaw_max(ap)
    if most > 0.0:
        heading_rate = constrain(heading_rate, -most, most)
    w, x, y, z = thrust_quaternion(tx, ty, tz, heading)
    if shaped:
        w, x, y, z = _target_error(ap, w, x, y, z)
        rx, ry, rz, _angle, _w, _x, _y = split_error(w, x, y, z)
        _shape_rotation(ap, rx, ry, rz, 0.0, 0.0, heading_rate, most)
    else:
        set_target(ap, w, x, y, z)
        set_target_rate(ap, 0.0, 0.0, 0.0)
    correct(ap)


@law
def input_thrust_vector_heading_rate(ap, tx, ty, tz, heading_rate):
    """Point thrust along the NED vector (tx, ty, tz) while turning about it at ``heading_rate`` [rad/s]."""
    shaped = _begin(ap)
    if not (finite(tx) and finite(ty) and finite(tz) and finite(heading_rate)):
        _hold(ap, shaped)
        return
    most = slew_yaw_max(ap)
    if most > 0.0:
        heading_rate = constrain(heading_rate, -most, most)
    a = ap.control.attitude
    w, x, y, z = thrust_quaternion(tx, ty, tz, 0.0)
    w, x, y, z = _target_error(ap, w, x, y, z)
    rx, ry, _rz, _angle, hw, hx, hy = split_error(w, x, y, z)
    if shaped:
        tau = float(ap.params.ATC.INPUT_TC)
        ax, ay, az = accel_max(ap)
        wx = shape_angle(rx, tau, ax, float(a.target_rate[0]), 0.0, 0.0, DT)
        wy = shape_angle(ry, tau, ay, float(a.target_rate[1]), 0.0, 0.0, DT)
        wz = shape_rate(float(a.target_rate[2]), heading_rate, az, float(ap.params.PILOT.Y_RATE_TC), DT)
        wx, wy, wz = limit_rates(ap, wx, wy, wz, 0.0)
        set_target_rate(ap, wx, wy, wz)
    else:
        q = a.target_q
        w, x, y, z = quat_multiply(float(q[0]), float(q[1]), float(q[2]), float(q[3]), hw, hx, hy, 0.0)
        w, x, y, z = quat_multiply(w, x, y, z, 1.0, 0.0, 0.0, 0.5 * heading_rate * DT)
        set_target(ap, w, x, y, z)
        set_target_rate(ap, 0.0, 0.0, 0.0)
    correct(ap)


@law
def input_quaternion(ap, qw, qx, qy, qz, p, q, r):
    """Turn to the attitude (qw, qx, qy, qz) (body to NED), which itself turns at body rates (p, q, r)
    [rad/s].
    """
    shaped = _begin(ap)
    n2 = qw * qw + qx * qx + qy * qy + qz * qz
    if not (finite(n2) and finite(p) and finite(q) and finite(r)) or n2 < 1e-6:
        _hold(ap, shaped)
        return
    if shaped:
        n = math.sqrt(n2)
        w, x, y, z = _target_error(ap, qw / n, qx / n, qy / n, qz / n)
        rx, ry, rz, _angle, _w, _x, _y = split_error(w, x, y, z)
        _shape_rotation(ap, rx, ry, rz, p, q, r, 0.0)
    else:
        set_target(ap, qw, qx, qy, qz)
        set_target_rate(ap, p, q, r)
    correct(ap)


@law
def input_rates(ap, p, q, r):
    """Turn at body rates (p, q, r) [rad/s]; the attitude reached on the way is held."""
    shaped = _begin(ap)
    if not (finite(p) and finite(q) and finite(r)):
        p, q, r = 0.0, 0.0, 0.0
    a = ap.control.attitude
    if shaped:
        ax, ay, az = accel_max(ap)
        p = shape_rate(float(a.target_rate[0]), p, ax, 0.0, DT)
        q = shape_rate(float(a.target_rate[1]), q, ay, 0.0, DT)
        r = shape_rate(float(a.target_rate[2]), r, az, float(ap.params.PILOT.Y_RATE_TC), DT)
    p, q, r = limit_rates(ap, p, q, r, 0.0)
    set_target_rate(ap, p, q, r)
    correct(ap)


@law
def _hold(ap, shaped):
    """Bring the target to rest where it is."""
    if shaped:
        _shape_rotation(ap, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0)
    else:
        set_target_rate(ap, 0.0, 0.0, 0.0)
    correct(ap)


@law
def relax(ap):
    """Target := present attitude and rates, integrators zero: nothing pushes while the vehicle stands on the
    ground.
    """
    a = ap.control.attitude
    est = ap.estimate
    set_target(ap, float(est.q[0]), float(est.q[1]), float(est.q[2]), float(est.q[3]))
    set_target_rate(ap, float(est.rates[0]), float(est.rates[1]), float(est.rates[2]))
    for k in range(3):
        a.rate_target[k] = float(est.rates[k])
        a.error[k] = 0.0
        a.error_q[k + 1] = 0.0
    a.error_q[0] = 1.0
    a.thrust_error_angle = 0.0
    a.cos_lean = 1.0 - 2.0 * (float(est.q[1]) * float(est.q[1]) + float(est.q[2]) * float(est.q[2]))
    a.yaw_reset_count = est.reset_yaw_count
    rate.reset_filters(ap)
    rate.reset_integrators(ap)


@law
def reset_yaw_target(ap):
    """Heading target := present heading, without a turn."""
    a = ap.control.attitude
    q = a.target_q
    turn = wrap_pi(float(ap.estimate.euler[2]) - float(a.target_euler[2]))
    w, x, y, z = quat_from_rotation_vector(0.0, 0.0, turn)
    w, x, y, z = quat_multiply(w, x, y, z, float(q[0]), float(q[1]), float(q[2]), float(q[3]))
    set_target(ap, w, x, y, z)
    r, p = float(a.target_euler[0]), float(a.target_euler[1])
    er, ep, _ey = euler_rates(r, p, float(a.target_rate[0]), float(a.target_rate[1]), float(a.target_rate[2]))
    wx, wy, wz = body_rates(r, p, er, ep, 0.0)
    set_target_rate(ap, wx, wy, wz)
