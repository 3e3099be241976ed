# SPDX-License-Identifier: BSD-3-Clause
"""Vertical position: shaped path -> position P -> velocity PID -> acceleration PID -> throttle (PSC_POSZ_P,
PSC_VELZ_*, PSC_ACCZ_*, PSC_JERK_Z).

Down is positive throughout, as in NED. PSC_ACCZ_* gains turn cm/s^2 into thousandths of throttle: one of them
is 0.1 of throttle for 1 m/s^2. A mode calls one ``input_*`` (or ``set_pos_vel_accel_d``) law and then
``update_d`` every tick.
"""

from __future__ import annotations

from ....core.kernels import law
from ....core.scalars import constrain, finite, sign
from ...control.pid import update_directional, update_saturating
from ...control.shaping import advance, inverse_sqrt_controller, shape_pos_vel_accel, shape_vel_accel, sqrt_controller
from .altitude_start import (
    ACCZ_UNIT,
    init_d,
    init_d_no_descent,
    init_d_stopping_point,
    is_active_d,
    relax_d,
    set_correction_speed_accel_d,
    set_max_speed_accel_d,
    stopping_point_d,
)
from .motors import hover_throttle
from .state import DT
from .throttle_mix import set_throttle_out

__all__ = [
    "init_d",
    "init_d_no_descent",
    "init_d_stopping_point",
    "input_pos_vel_accel_d",
    "input_vel_accel_d",
    "is_active_d",
    "land_at_rate_d",
    "relax_d",
    "set_correction_speed_accel_d",
    "set_max_speed_accel_d",
    "set_pos_vel_accel_d",
    "stopping_point_d",
    "update_d",
]

_ACCZ_IMAX_UNIT = 0.001
_THROTTLE_HZ = 2.0  # low-pass of the throttle [Hz]
_FALL_ACCEL_MAX = 7.5  # downward acceleration is kept below gravity [m/s^2]
_OVERSPEED_GAIN = 2.0


@law
def overspeed_gain(ap):
    """How much faster the shaping may brake while it is above its speed limits; 1 below them."""
    c = ap.control.pos_d
    v = float(c.vel_desired)
    if v > c.speed_down and c.speed_down > 0.0:
        return _OVERSPEED_GAIN * v / float(c.speed_down)
    if v < -c.speed_up and c.speed_up > 0.0:
        return -_OVERSPEED_GAIN * v / float(c.speed_up)
    return 1.0


@law
def advance_d(ap):
    """Move the desired path on by one tick."""
    c = ap.control.pos_d
    p, v = advance(
        float(c.pos_desired), float(c.vel_desired), float(c.accel_desired), DT,
        sign(float(c.limit)), float(c.pos_error), float(c.vel.error),
    )  # fmt: skip
    c.pos_desired = p
    c.vel_desired = v


@law
def shape_pos_d(ap, p, v, a, speed_up, speed_down):
    """New desired acceleration towards a moving altitude."""
    c = ap.control.pos_d
    gain = overspeed_gain(ap)
    up = float(c.accel_max) * gain
    c.accel_desired = shape_pos_vel_accel(
        p, v, a, float(c.pos_desired), float(c.vel_desired), float(c.accel_desired),
        -speed_up, speed_down, -up, min(up, _FALL_ACCEL_MAX), float(c.jerk_max) * gain, DT, 0,
    )  # fmt: skip


@law
def input_pos_vel_accel_d(ap, p, v, a):
    """Follow an altitude ``p`` [m] that moves with ``v`` [m/s] and ``a`` [m/s^2], shaped."""
    c = ap.control.pos_d
    if not (finite(p) and finite(v) and finite(a)):
        input_vel_accel_d(ap, 0.0, 0.0)
        return
    advance_d(ap)
    shape_pos_d(ap, p, v, a, float(c.speed_up), float(c.speed_down))


@law
def input_vel_accel_d(ap, v, a):
    """Move at ``v`` [m/s, down positive], which changes with ``a`` [m/s^2], shaped."""
    c = ap.control.pos_d
    if not (finite(v) and finite(a)):
        v, a = 0.0, 0.0
    gain = overspeed_gain(ap)
    up = float(c.accel_max) * gain
    advance_d(ap)
    c.accel_desired = shape_vel_accel(
        v, a, float(c.vel_desired), float(c.accel_desired),
        -up, min(up, _FALL_ACCEL_MAX), float(c.jerk_max) * gain, DT, 0,
    )  # fmt: skip


@law
def land_at_rate_d(ap, v_down, ignore_descent_limit):
    """Descend at ``v_down`` [m/s]; with ``ignore_descent_limit`` != 0 the target goes on although throttle is
    at its least.
    """
    c = ap.control.pos_d
    if ignore_descent_limit != 0:
        c.limit = min(float(c.limit), 0.0)
    input_vel_accel_d(ap, v_down, 0.0)


@law
def set_pos_vel_accel_d(ap, p, v, a):
    """Desired path given outright, for trajectories that are already smooth."""
    if not (finite(p) and finite(v) and finite(a)):
        input_vel_accel_d(ap, 0.0, 0.0)
        return
    c = ap.control.pos_d
    c.pos_desired = p
    c.vel_desired = v
    c.accel_desired = a


@law
def _follow_reset_d(ap):
    """When the estimate jumps, the path jumps with it."""
    c = ap.control.pos_d
    if c.reset_count == ap.estimate.reset_d_count:
        return
    c.reset_count = ap.estimate.reset_d_count
    c.pos_desired = float(ap.estimate.pos[2]) + float(c.pos_error)
    c.vel_desired += ap.estimate.reset_vel[2]


@law
def update_d(ap):
    """One tick of the cascade; sets the throttle."""
    c = ap.control.pos_d
    p = ap.params
    est = ap.estimate
    motors = ap.control.motors
    if not is_active_d(ap):
        init_d(ap)
    _follow_reset_d(ap)
    c.last_tick = ap.control.tick
    at_least, at_most = motors.limit_throttle_lower != 0, motors.limit_throttle_upper != 0

    kp = float(p.PSC.POSZ_P)
    accel = float(c.correction_accel)
    error = float(c.pos_desired) - float(est.pos[2])
    if not finite(error):
        error = 0.0
    if kp > 0.0:
        limited = error
        if c.correction_speed_down > 0.0:
            limited = min(limited, inverse_sqrt_controller(float(c.correction_speed_down), kp, accel))
        if c.correction_speed_up > 0.0:
            limited = max(limited, -inverse_sqrt_controller(float(c.correction_speed_up), kp, accel))
        if limited != error:
            error = limited
            c.pos_desired = float(est.pos[2]) + error
    c.pos_error = error
    c.vel_target = sqrt_controller(error, kp, accel, 0.0) + float(c.vel_desired)

    c.accel_target = float(c.accel_desired) + update_directional(
        c.vel, float(c.vel_target), float(est.vel[2]), DT, at_most, at_least,
        float(p.PSC.VELZ.P), float(p.PSC.VELZ.I), float(p.PSC.VELZ.D), float(p.PSC.VELZ.FF),
        float(p.PSC.VELZ.IMAX) * 0.01, float(p.PSC.VELZ.FLTE), float(p.PSC.VELZ.FLTD),
    )  # fmt: skip

    hover = hover_throttle(ap)
    throttle = hover - update_saturating(
        c.accel, float(c.accel_target), float(est.acc_ned[2]), DT, at_least or at_most,
        float(p.PSC.ACCZ.P) * ACCZ_UNIT, float(p.PSC.ACCZ.I) * ACCZ_UNIT, float(p.PSC.ACCZ.D) * ACCZ_UNIT,
        float(p.PSC.ACCZ.FF) * ACCZ_UNIT, float(p.PSC.ACCZ.D_FF) * ACCZ_UNIT,
        max(float(p.PSC.ACCZ.IMAX) * _ACCZ_IMAX_UNIT, hover), float(p.PSC.ACCZ.PDMX) * _ACCZ_IMAX_UNIT,
        float(p.PSC.ACCZ.FLTT), float(p.PSC.ACCZ.FLTE), float(p.PSC.ACCZ.FLTD),
    )  # fmt: skip
    set_throttle_out(ap, throttle, 1, _THROTTLE_HZ)

    if c.speed_down > 0.0:
        ratio = float(c.vel.error) / float(c.speed_down)
        c.control_ratio = constrain(float(c.control_ratio) + 0.1 * DT * (0.5 + ratio), 0.0, 2.0)
    c.limit = -1.0 if at_most else (1.0 if at_least else 0.0)
