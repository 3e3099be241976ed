# SPDX-License-Identifier: BSD-3-Clause
"""Horizontal position control: limits, and where it starts from (see ``position``)."""

from __future__ import annotations

import math

from ....core.kernels import law
from ....core.scalars import constrain
from ...control.shaping import inverse_sqrt_controller, limit_length
from .state import DT, GRAVITY
from .throttle_mix import LEAN_TICKS, lean_limit

RELAX_TIME = 0.16
"""Time constant with which targets decay on the ground [s] (ArduPilot's)."""
_CDEG = math.radians(0.01)


@law
def set_max_speed_accel_ne(ap, speed, accel):
    """Limits of the shaping [m/s, m/s^2], and of the correction too; jerk is PSC_JERK_XY or what the airframe
    can.
    """
    c = ap.control.pos_ne
    p = ap.params
    c.speed_max = speed
    c.accel_max = max(accel, 0.01)
    jerk = max(float(p.PSC.JERK_XY), 0.01)
    if p.ATC.RATE_FF_ENAB != 0.0:
        rate = min(float(p.ATC.RATE_R_MAX), float(p.ATC.RATE_P_MAX)) * 100.0 * _CDEG
        snap = min(float(p.ATC.ACCEL_R_MAX), float(p.ATC.ACCEL_P_MAX)) * _CDEG * GRAVITY
        if rate > 0.0:
            jerk = min(jerk, rate * GRAVITY)
        if snap > 0.0:
            jerk = min(jerk, 0.5 * math.sqrt(float(c.accel_max) * snap))
    c.jerk_max = jerk
    set_correction_speed_accel_ne(ap, speed, accel)


@law
def set_correction_speed_accel_ne(ap, speed, accel):
    """Limits of what the position loop adds to the shaped velocity [m/s, m/s^2]; 0 for none."""
    ap.control.pos_ne.correction_speed = speed
    ap.control.pos_ne.correction_accel = accel


@law
def lean_max_ne(ap):
    """Greatest lean [rad]: PSC_ANGLE_MAX, or ANGLE_MAX where that is 0."""
    if ap.params.PSC.ANGLE_MAX > 0.0:
        return float(ap.params.PSC.ANGLE_MAX) * 100.0 * _CDEG
    return float(ap.params.ANGLE_MAX) * _CDEG


@law
def renew_accel_limit(ap):
    """Acceleration [m/s^2] that the permitted lean gives; kept in the record."""
    limit = GRAVITY * math.tan(min(lean_limit(ap), lean_max_ne(ap)))
    ap.control.pos_ne.accel_limit = limit
    return limit


@law
def accel_limit_ne(ap):
    """The same, renewed every few ticks."""
    if ap.control.tick % LEAN_TICKS == 0:
        return renew_accel_limit(ap)
    return float(ap.control.pos_ne.accel_limit)


@law
def is_active_ne(ap):
    """Whether ``update_ne`` ran in this tick or the one before."""
    return ap.control.tick > 0 and ap.control.tick - ap.control.pos_ne.last_tick <= 1


@law
def lean_accel(roll, pitch, yaw):
    """Horizontal acceleration (north, east) [m/s^2] of level flight at a lean."""
    forward = -GRAVITY * math.tan(constrain(pitch, -1.4, 1.4))
    right = GRAVITY * math.tan(constrain(roll, -1.4, 1.4)) / math.cos(constrain(pitch, -1.4, 1.4))
    s, c = math.sin(yaw), math.cos(yaw)
    return (forward * c - right * s, forward * s + right * c)


@law
def init_ne(ap):
    """Start from the present position and velocity; the integrator takes over the present lean."""
    c = ap.control.pos_ne
    est = ap.estimate
    euler = ap.control.attitude.target_euler
    if not is_active_ne(ap):
        an, ae = lean_accel(float(euler[0]), float(euler[1]), float(est.euler[2]))
        c.accel_target[0], c.accel_target[1] = an, ae
    an, ae = limit_length(float(c.accel_target[0]), float(c.accel_target[1]), renew_accel_limit(ap))
    c.accel_target[0], c.accel_target[1] = an, ae
    for k in range(2):
        c.pos_desired[k] = est.pos[k]
        c.vel_desired[k] = est.vel[k]
        c.vel_target[k] = est.vel[k]
        c.accel_desired[k] = 0.0
        c.pos_error[k] = 0.0
        c.vel_integrator[k] = c.accel_target[k]
        c.limit[k] = 0.0
    c.started = 0
    c.reset_count = est.reset_ne_count
    c.last_tick = ap.control.tick


@law
def init_ne_stopping_point(ap):
    """Start from where the vehicle can stop."""
    init_ne(ap)
    n, e = stopping_point_ne(ap)
    c = ap.control.pos_ne
    c.pos_desired[0], c.pos_desired[1] = n, e
    c.vel_desired[0], c.vel_desired[1] = 0.0, 0.0


@law
def relax_ne(ap):
    """Let the lean decay to zero at the present position (on the ground, spooling)."""
    c = ap.control.pos_ne
    keep = 1.0 - DT / (DT + RELAX_TIME)
    c.accel_target[0] *= keep
    c.accel_target[1] *= keep
    init_ne(ap)


@law
def soften_for_landing_ne(ap):
    """Let the position error decay and the integrator not grow: the ground may hold the vehicle."""
    c = ap.control.pos_ne
    k = DT / (DT + RELAX_TIME)
    for j in range(2):
        c.pos_desired[j] += k * (float(ap.estimate.pos[j]) - float(c.pos_desired[j]))
        c.limit[j] = c.accel_target[j]


@law
def stop_pos_ne(ap):
    """Give up the position target: only velocity is controlled."""
    c = ap.control.pos_ne
    c.pos_desired[0] = ap.estimate.pos[0]
    c.pos_desired[1] = ap.estimate.pos[1]


@law
def stop_vel_ne(ap):
    """Give up position and velocity targets: only acceleration is controlled."""
    c = ap.control.pos_ne
    stop_pos_ne(ap)
    for k in range(2):
        c.vel_desired[k] = ap.estimate.vel[k]
        c.vel_integrator[k] = 0.0
    c.started = 0


@law
def stopping_point_ne(ap):
    """(north, east) [m] where the vehicle stops from its present velocity, braking within the limits."""
    c = ap.control.pos_ne
    n, e = float(ap.estimate.pos[0]), float(ap.estimate.pos[1])
    vn, ve = float(ap.estimate.vel[0]), float(ap.estimate.vel[1])
    speed = math.sqrt(vn * vn + ve * ve)
    if not speed > 1e-6:
        return (n, e)
    distance = inverse_sqrt_controller(min(speed, float(c.speed_max)), float(ap.params.PSC.POSXY_P), float(c.accel_max))
    k = distance / speed
    return (n + vn * k, e + ve * k)
