# SPDX-License-Identifier: BSD-3-Clause
"""Vertical position control: limits, and where it starts from (see ``altitude``). Down is positive."""

from __future__ import annotations

from ....core.constants import GRAVITY
from ....core.kernels import law
from ....core.scalars import TWO_PI, constrain, finite
from ...control.pid import relax_integrator, reset_filter
from ...control.shaping import inverse_sqrt_controller
from ...state import Estimate
from ..parameters import Parameters
from ..parameters.control import Position
from .motors import hover_throttle
from .state import DT, AltitudeState, Control

RELAX_TIME = 0.16
"""Time constant with which the throttle decays on the ground [s] (ArduPilot's)."""
ACCZ_UNIT = 0.1
"""Throttle per (m/s^2 x PSC_ACCZ gain)."""
_STOP_DOWN, _STOP_UP = 2.0, 3.0  # bounds of the stopping point [m]


@law
def set_max_speed_accel_d(c: AltitudeState, p: Position, speed_down: float, speed_up: float, accel: float) -> None:
    """Limits of the shaping and the correction (all positive) [m/s, m/s^2]."""
    c.speed_down = c.correction_speed_down = abs(speed_down)
    c.speed_up = c.correction_speed_up = abs(speed_up)
    c.correction_accel = abs(accel)
    c.accel_max = max(abs(accel), 0.01)
    c.jerk_max = jerk_limit_d(p, c.accel_max)


@law
def jerk_limit_d(p: Position, accel: float) -> float:
    """PSC_JERK_Z, or what the filters of the acceleration loop let through, if less [m/s^3]."""
    jerk = max(p.JERK_Z, 0.01)
    per_hz = min(GRAVITY, accel) * TWO_PI / 5.0
    if p.ACCZ.FLTT > 0.0:
        jerk = min(jerk, per_hz * p.ACCZ.FLTT)
    if p.ACCZ.FLTE > 0.0:
        jerk = min(jerk, per_hz * p.ACCZ.FLTE)
    return jerk


@law
def is_active_d(control: Control) -> bool:
    """Whether ``update_d`` ran in this tick or the one before."""
    return control.tick > 0 and control.tick - control.pos_d.last_tick <= 1


@law
def init_d(control: Control, est: Estimate, p: Parameters) -> None:
    """Start from the present altitude, climb and throttle."""
    c = control.pos_d
    gains = p.PSC.ACCZ
    c.pos_desired = est.pos.z
    c.vel_desired = est.vel.z
    c.vel_target = est.vel.z
    c.pos_error = 0.0
    c.limit = 0.0
    reset_filter(c.vel)
    c.vel.integrator = 0.0
    measured = est.acc_ned.z if finite(est.acc_ned.z) else 0.0
    target = constrain(measured, -c.accel_max, c.accel_max)
    c.accel_target = target
    c.accel_desired = target
    reset_filter(c.accel)
    # What P and FF will give at once is left out, so that the throttle does not jump.
    at_once = ACCZ_UNIT * (gains.P * (target - measured) + gains.FF * target)
    c.accel.integrator = hover_throttle(p.MOT) - control.attitude.throttle_in - at_once
    c.reset_count = est.reset_d_count
    c.last_tick = control.tick


@law
def init_d_stopping_point(control: Control, est: Estimate, p: Parameters) -> None:
    """Start from the altitude where the vehicle can stop."""
    init_d(control, est, p)
    c = control.pos_d
    c.pos_desired = stopping_point_d(c, est, p.PSC)
    c.vel_desired = 0.0
    c.vel_target = 0.0
    c.accel_desired = 0.0


@law
def init_d_no_descent(control: Control, est: Estimate, p: Parameters) -> None:
    """Start from the present altitude, climb and throttle, but not from a descent."""
    init_d(control, est, p)
    c = control.pos_d
    c.vel_desired = min(c.vel_desired, 0.0)
    c.vel_target = min(c.vel_target, 0.0)
    c.accel_desired = min(c.accel_desired, 0.0)
    c.accel_target = min(c.accel_target, 0.0)


@law
def relax_d(control: Control, est: Estimate, p: Parameters, throttle: float) -> None:
    """Let the throttle decay to ``throttle`` (0 .. 1) at the present altitude (on the ground, spooling)."""
    init_d(control, est, p)
    relax_integrator(control.pos_d.accel, hover_throttle(p.MOT) - throttle, DT, RELAX_TIME)


@law
def stopping_point_d(c: AltitudeState, est: Estimate, p: Position) -> float:
    """Altitude [m, down] where the vehicle stops from its present climb or descent."""
    kp, accel, pos = p.POSZ_P, c.accel_max, est.pos.z
    if kp <= 0.0 or accel <= 0.0:
        return pos
    return pos + constrain(inverse_sqrt_controller(est.vel.z, kp, accel), -_STOP_UP, _STOP_DOWN)
