# SPDX-License-Identifier: BSD-3-Clause
"""Horizontal position: shaped path -> position P -> velocity PID -> lean (PSC_POSXY_P, PSC_VELXY_*,
PSC_JERK_XY).

NED metres from the estimator's origin. A mode calls one ``input_*`` (or ``set_pos_vel_accel_ne``) law and
then ``update_ne`` every tick. The desired path waits where the lean is used up, and the velocity integrator
does not grow in that direction. Inputs that are not finite are ignored: the vehicle brakes instead.
"""

from __future__ import annotations

import math

from ....core.kernels import law
from ....core.scalars import finite
from ...control.pid import lowpass_gain
from ...control.shaping import (
    advance_2d,
    inverse_sqrt_controller,
    limit_accel,
    limit_length,
    shape_accel_2d,
    shape_pos_vel_accel_2d,
    shape_vel_accel_2d,
    sqrt_controller_2d,
)
from .position_start import (
    accel_limit_ne,
    init_ne,
    init_ne_stopping_point,
    is_active_ne,
    lean_accel,
    lean_max_ne,
    relax_ne,
    set_correction_speed_accel_ne,
    set_max_speed_accel_ne,
    soften_for_landing_ne,
    stop_pos_ne,
    stop_vel_ne,
    stopping_point_ne,
)
from .state import DT, GRAVITY

__all__ = [
    "accel_limit_ne",
    "init_ne",
    "init_ne_stopping_point",
    "input_accel_ne",
    "input_pos_vel_accel_ne",
    "input_vel_accel_ne",
    "is_active_ne",
    "lean_accel",
    "lean_max_ne",
    "lean_targets",
    "relax_ne",
    "set_correction_speed_accel_ne",
    "set_max_speed_accel_ne",
    "set_pos_vel_accel_ne",
    "soften_for_landing_ne",
    "stop_pos_ne",
    "stop_vel_ne",
    "stopping_point_ne",
    "thrust_vector",
    "update_ne",
]


@law
def advance_ne(ap):
    """Move the desired path on by one tick."""
    c = ap.control.pos_ne
    pn, pe, vn, ve = advance_2d(
        float(c.pos_desired[0]), float(c.pos_desired[1]), float(c.vel_desired[0]), float(c.vel_desired[1]),
        float(c.accel_desired[0]), float(c.accel_desired[1]), DT, float(c.limit[0]), float(c.limit[1]),
        float(c.pos_error[0]), float(c.pos_error[1]), float(c.vel_error[0]), float(c.vel_error[1]),
    )  # fmt: skip
    c.pos_desired[0], c.pos_desired[1] = pn, pe
    c.vel_desired[0], c.vel_desired[1] = vn, ve


@law
def shape_pos_ne(ap, px, py, vx, vy, ax, ay, speed_max, limit_total):
    """New desired acceleration towards a moving point; the path itself is moved by ``advance_ne``."""
    c = ap.control.pos_ne
    an, ae = shape_pos_vel_accel_2d(
        px, py, vx, vy, ax, ay,
        float(c.pos_desired[0]), float(c.pos_desired[1]), float(c.vel_desired[0]), float(c.vel_desired[1]),
        float(c.accel_desired[0]), float(c.accel_desired[1]),
        speed_max, float(c.accel_max), float(c.jerk_max), DT, limit_total,
    )  # fmt: skip
    c.accel_desired[0], c.accel_desired[1] = an, ae


@law
def input_pos_vel_accel_ne(ap, px, py, vx, vy, ax, ay):
    """Follow a point at (px, py) [m] that moves with (vx, vy) [m/s] and (ax, ay) [m/s^2], shaped."""
    if not (finite(px + py) and finite(vx + vy) and finite(ax + ay)):
        input_vel_accel_ne(ap, 0.0, 0.0, 0.0, 0.0)
        return
    advance_ne(ap)
    shape_pos_ne(ap, px, py, vx, vy, ax, ay, float(ap.control.pos_ne.speed_max), 0)


@law
def input_vel_accel_ne(ap, vx, vy, ax, ay):
    """Fly at (vx, vy) [m/s], which changes with (ax, ay) [m/s^2], shaped."""
    c = ap.control.pos_ne
    if not (finite(vx + vy) and finite(ax + ay)):
        vx, vy, ax, ay = 0.0, 0.0, 0.0, 0.0
    advance_ne(ap)
    an, ae = shape_vel_accel_2d(
        vx, vy, ax, ay, float(c.vel_desired[0]), float(c.vel_desired[1]),
        float(c.accel_desired[0]), float(c.accel_desired[1]), float(c.accel_max), float(c.jerk_max), DT, 0,
    )  # fmt: skip
    c.accel_desired[0], c.accel_desired[1] = an, ae


@law
def input_accel_ne(ap, ax, ay):
    """Accelerate with (ax, ay) [m/s^2], jerk-limited."""
    c = ap.control.pos_ne
    if not finite(ax + ay):
        ax, ay = 0.0, 0.0
    advance_ne(ap)
    an, ae = shape_accel_2d(ax, ay, float(c.accel_desired[0]), float(c.accel_desired[1]), float(c.jerk_max), DT)
    c.accel_desired[0], c.accel_desired[1] = an, ae


@law
def set_pos_vel_accel_ne(ap, px, py, vx, vy, ax, ay):
    """Desired path given outright, for trajectories that are already smooth."""
    if not (finite(px + py) and finite(vx + vy) and finite(ax + ay)):
        input_vel_accel_ne(ap, 0.0, 0.0, 0.0, 0.0)
        return
    c = ap.control.pos_ne
    c.pos_desired[0], c.pos_desired[1] = px, py
    c.vel_desired[0], c.vel_desired[1] = vx, vy
    c.accel_desired[0], c.accel_desired[1] = ax, ay


@law
def thrust_vector(ap):
    """NED direction of thrust (not normalised) [m/s^2] that gives the horizontal acceleration in level
    flight.
    """
    c = ap.control.pos_ne
    return (float(c.accel_target[0]), float(c.accel_target[1]), -GRAVITY)


@law
def _follow_reset_ne(ap):
    """When the estimate jumps, the path jumps with it."""
    c = ap.control.pos_ne
    if c.reset_count == ap.estimate.reset_ne_count:
        return
    c.reset_count = ap.estimate.reset_ne_count
    for k in range(2):
        c.pos_desired[k] = float(ap.estimate.pos[k]) + float(c.pos_error[k])
        c.vel_desired[k] += ap.estimate.reset_vel[k]


@law
def _velocity_loop(ap):
    """Acceleration (north, east) [m/s^2] that the velocity PID asks for."""
    c = ap.control.pos_ne
    p = ap.params
    kp, ki, kd, kff = float(p.PSC.VELXY.P), float(p.PSC.VELXY.I), float(p.PSC.VELXY.D), float(p.PSC.VELXY.FF)
    gain_e, gain_d = lowpass_gain(float(p.PSC.VELXY.FLTE), DT), lowpass_gain(float(p.PSC.VELXY.FLTD), DT)
    for k in range(2):
        error = float(c.vel_target[k]) - float(ap.estimate.vel[k])
        if not finite(error):
            error = 0.0
        if c.started == 0:
            c.vel_error[k] = error
            c.vel_derivative[k] = 0.0
        else:
            last = float(c.vel_error[k])
            c.vel_error[k] = last + gain_e * (error - last)
            c.vel_derivative[k] += gain_d * ((float(c.vel_error[k]) - last) / DT - float(c.vel_derivative[k]))
    c.started = 1
    i_n, i_e = float(c.vel_integrator[0]), float(c.vel_integrator[1])
    step_n, step_e = float(c.vel_error[0]) * ki * DT, float(c.vel_error[1]) * ki * DT
    new_n, new_e = i_n + step_n, i_e + step_e
    if step_n * float(c.limit[0]) + step_e * float(c.limit[1]) > 0.0:
        # Into the limit: the integrator may turn but not grow.
        new_n, new_e = limit_length(new_n, new_e, math.sqrt(i_n * i_n + i_e * i_e))
    new_n, new_e = limit_length(new_n, new_e, float(p.PSC.VELXY.IMAX) * 0.01)
    if ki == 0.0:
        new_n, new_e = 0.0, 0.0
    c.vel_integrator[0], c.vel_integrator[1] = new_n, new_e
    return (
        kp * float(c.vel_error[0]) + new_n + kd * float(c.vel_derivative[0]) + kff * float(c.vel_target[0]),
        kp * float(c.vel_error[1]) + new_e + kd * float(c.vel_derivative[1]) + kff * float(c.vel_target[1]),
    )


@law
def update_ne(ap):
    """One tick of the cascade: ``accel_target`` comes out (see ``thrust_vector`` and ``lean_targets``)."""
    c = ap.control.pos_ne
    est = ap.estimate
    if not is_active_ne(ap):
        init_ne(ap)
    _follow_reset_ne(ap)
    c.last_tick = ap.control.tick

    kp = float(ap.params.PSC.POSXY_P)
    accel = float(c.correction_accel)
    en, ee = float(c.pos_desired[0]) - float(est.pos[0]), float(c.pos_desired[1]) - float(est.pos[1])
    if not finite(en + ee):
        en, ee = 0.0, 0.0
    if c.correction_speed > 0.0 and kp > 0.0:
        most = inverse_sqrt_controller(float(c.correction_speed), kp, accel)
        if en * en + ee * ee > most * most:
            # The path waits for a vehicle that cannot keep up.
            en, ee = limit_length(en, ee, most)
            c.pos_desired[0], c.pos_desired[1] = float(est.pos[0]) + en, float(est.pos[1]) + ee
    c.pos_error[0], c.pos_error[1] = en, ee
    vn, ve = sqrt_controller_2d(en, ee, kp, accel, 0.0)
    c.vel_target[0], c.vel_target[1] = vn + float(c.vel_desired[0]), ve + float(c.vel_desired[1])

    an, ae = _velocity_loop(ap)
    an, ae = an + float(c.accel_desired[0]), ae + float(c.accel_desired[1])
    most = accel_limit_ne(ap)
    c.limit[0], c.limit[1] = 0.0, 0.0
    if an * an + ae * ae > most * most:
        c.limit[0], c.limit[1] = an, ae
        an, ae = limit_accel(float(c.vel_desired[0]), float(c.vel_desired[1]), an, ae, most)
    c.accel_target[0], c.accel_target[1] = an, ae


@law
def lean_targets(ap):
    """(roll, pitch) [rad] of the present heading that give ``accel_target`` in level flight."""
    an, ae = float(ap.control.pos_ne.accel_target[0]), float(ap.control.pos_ne.accel_target[1])
    s, c = math.sin(float(ap.estimate.euler[2])), math.cos(float(ap.estimate.euler[2]))
    pitch = -math.atan((an * c + ae * s) / GRAVITY)
    return (math.atan((ae * c - an * s) * math.cos(pitch) / GRAVITY), pitch)
