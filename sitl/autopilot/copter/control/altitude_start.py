# SPDX-License-Identifier: BSD-3-Clause
"""Vertical position control: limits, and where it starts from (see ``altitude``). Down is positive."""

from __future__ import annotations

from ....core.kernels import law
from ....core.scalars import TWO_PI, constrain, finite
from ...control.pid import relax_integrator, reset_filter
from ...control.shaping import inverse_sqrt_controller
from .motors import hover_throttle
from .state import DT, GRAVITY

RELAX_TIME = 0.16
"""Time constant with which the throttle decays on the ground [s] (ArduPilot's)."""
ACCZ_UNIT = 0.1
"""Throttle per (m/s^2 x PSC_ACCZ gain)."""
_STOP_DOWN, _STOP_UP = 2.0, 3.0  # bounds of the stopping point [m]


@law
def set_max_speed_accel_d(ap, speed_down, speed_up, accel):
    """Limits of the shaping and the correction (all positive) [m/s, m/s^2]; jerk is PSC_JERK_Z or what
    filters pass.
    """
    c = ap.control.pos_d
    p = ap.params
    c.speed_down = abs(speed_down)
    c.speed_up = abs(speed_up)
    c.accel_max = max(abs(accel), 0.01)
    jerk = max(float(p.PSC.JERK_Z), 0.01)
    most = min(GRAVITY, float(c.accel_max)) * TWO_PI / 5.0
    if p.PSC.ACCZ.FLTT > 0.0:
        jerk = min(jerk, most * float(p.PSC.ACCZ.FLTT))
    if p.PSC.ACCZ.FLTE > 0.0:
        jerk = min(jerk, most * float(p.PSC.ACCZ.FLTE))
    c.jerk_max = jerk
    set_correction_speed_accel_d(ap, speed_down, speed_up, accel)


@law
def set_correction_speed_accel_d(ap, speed_down, speed_up, accel):
    """Limits of what the position loop adds to the shaped velocity (all positive)."""
    c = ap.control.pos_d
    c.correction_speed_down = abs(speed_down)
    c.correction_speed_up = abs(speed_up)
    c.correction_accel = abs(accel)


@law
def is_active_d(ap):
    """Whether ``update_d`` ran in this tick or the one before."""
    return ap.control.tick > 0 and ap.control.tick - ap.control.pos_d.last_tick <= 1


@law
def init_d(ap):
    """Start from the present altitude, climb and throttle."""
    c = ap.control.pos_d
    est = ap.estimate
    p = ap.params
    c.pos_desired = est.pos[2]
    c.vel_desired = est.vel[2]
    c.vel_target = est.vel[2]
    c.pos_error = 0.0
    c.limit = 0.0
    reset_filter(c.vel)
    c.vel.integrator = 0.0
    measured = float(est.acc_ned[2])
    if not finite(measured):
        measured = 0.0
    target = constrain(measured, -float(c.accel_max), float(c.accel_max))
    c.accel_target = target
    c.accel_desired = target
    reset_filter(c.accel)
    # What P and FF will give at once is left out, so that the throttle does not jump.
    c.accel.integrator = (
        hover_throttle(ap)
        - float(ap.control.attitude.throttle_in)
        - ACCZ_UNIT * (float(p.PSC.ACCZ.P) * (target - measured) + float(p.PSC.ACCZ.FF) * target)
    )
    c.reset_count = est.reset_d_count
    c.last_tick = ap.control.tick


@law
def init_d_no_descent(ap):
    """Start from the present altitude without carrying on a descent."""
    init_d(ap)
    c = ap.control.pos_d
    c.vel_desired = min(float(c.vel_desired), 0.0)
    c.vel_target = min(float(c.vel_target), 0.0)
    c.accel_desired = min(float(c.accel_desired), 0.0)
    c.accel_target = min(float(c.accel_target), 0.0)


@law
def init_d_stopping_point(ap):
    """Start from the altitude where the vehicle can stop."""
    init_d(ap)
    c = ap.control.pos_d
    c.pos_desired = stopping_point_d(ap)
    c.vel_desired = 0.0
    c.vel_target = 0.0
    c.accel_desired = 0.0


@law
def relax_d(ap, throttle):
    """Let the throttle decay to ``throttle`` (0 .. 1) at the present altitude (on the ground, spooling)."""
    init_d(ap)
    relax_integrator(ap.control.pos_d.accel, hover_throttle(ap) - throttle, DT, RELAX_TIME)


@law
def stopping_point_d(ap):
    """Altitude [m, down] where the vehicle stops from its present climb or descent."""
    c = ap.control.pos_d
    kp = float(ap.params.PSC.POSZ_P)
    p = float(ap.estimate.pos[2])
    if kp <= 0.0 or c.accel_max <= 0.0:
        return p
    return p + constrain(
        inverse_sqrt_controller(float(ap.estimate.vel[2]), kp, float(c.accel_max)), -_STOP_UP, _STOP_DOWN
    )
