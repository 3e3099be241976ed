# SPDX-License-Identifier: BSD-3-Clause
"""Horizontal position control: limits, and where it starts from (see ``position``)."""

from __future__ import annotations

import math

from ....core.algebra import horizontal, limit_length, norm2, turned
from ....core.constants import GRAVITY
from ....core.elementary import cos, tan
from ....core.kernels import law
from ....core.scalars import constrain
from ....core.vectors import Vec2, Vec3
from ...control.shaping import inverse_sqrt_controller
from ...state import Estimate
from ..parameters import Parameters
from ..parameters.control import Attitude, Position
from .state import DT, Control, PositionState
from .throttle_mix import LEAN_TICKS, lean_limit

RELAX_TIME = 0.16
"""Time constant with which targets decay on the ground [s] (ArduPilot's)."""
_CDEG = math.radians(0.01)


@law
def set_max_speed_accel_ne(c: PositionState, p: Parameters, speed: float, accel: float) -> None:
    """Limits of the shaping and of the correction [m/s, m/s^2]; jerk is PSC_JERK_XY or what the airframe can."""
    c.speed_max = speed
    c.accel_max = max(accel, 0.01)
    c.jerk_max = jerk_limit_ne(p.PSC, p.ATC, c.accel_max)
    c.correction_speed = speed
    c.correction_accel = accel


@law
def jerk_limit_ne(psc: Position, atc: Attitude, accel: float) -> float:
    """PSC_JERK_XY, or the jerk [m/s^3] that turn rates and angular accelerations of the lean allow, if less."""
    jerk = max(psc.JERK_XY, 0.01)
    if atc.RATE_FF_ENAB != 0.0:
        rate = min(atc.RATE_R_MAX, atc.RATE_P_MAX) * 100.0 * _CDEG
        snap = min(atc.ACCEL_R_MAX, atc.ACCEL_P_MAX) * _CDEG * GRAVITY
        if rate > 0.0:
            jerk = min(jerk, rate * GRAVITY)
        if snap > 0.0:
            jerk = min(jerk, 0.5 * math.sqrt(accel * snap))
    return jerk


@law
def lean_max_ne(p: Parameters) -> float:
    """Greatest lean [rad]: PSC_ANGLE_MAX, or ANGLE_MAX where that is 0."""
    return p.PSC.ANGLE_MAX * 100.0 * _CDEG if p.PSC.ANGLE_MAX > 0.0 else p.ANGLE_MAX * _CDEG


@law
def renew_accel_limit(control: Control, p: Parameters) -> float:
    """Acceleration [m/s^2] that the permitted lean gives; kept in the record."""
    limit = GRAVITY * tan(min(lean_limit(control.attitude), lean_max_ne(p)))
    control.pos_ne.accel_limit = limit
    return limit


@law
def accel_limit_ne(control: Control, p: Parameters) -> float:
    """The same, renewed every few ticks."""
    if control.tick % LEAN_TICKS == 0:
        return renew_accel_limit(control, p)
    return control.pos_ne.accel_limit


@law
def is_active_ne(control: Control) -> bool:
    """Whether ``update_ne`` ran in this tick or the one before."""
    return control.tick > 0 and control.tick - control.pos_ne.last_tick <= 1


@law
def lean_accel(roll: float, pitch: float, yaw: float) -> Vec2:
    """Horizontal acceleration (north, east) [m/s^2] of level flight at a lean [rad]."""
    forward = -GRAVITY * tan(constrain(pitch, -1.4, 1.4))
    right = GRAVITY * tan(constrain(roll, -1.4, 1.4)) / cos(constrain(pitch, -1.4, 1.4))
    return turned(Vec2(forward, right), yaw)


@law
def start_from(c: PositionState, pos: Vec2, vel: Vec2) -> None:
    """Desired path at ``pos`` [m], ``vel`` [m/s]; the integrator takes over the present acceleration."""
    c.pos_desired = pos
    c.vel_desired = vel
    c.vel_target = vel
    c.accel_desired = Vec2(0.0, 0.0)
    c.pos_error = Vec2(0.0, 0.0)
    c.vel_integrator = c.accel_target
    c.limit = Vec2(0.0, 0.0)
    c.started = False


@law
def init_ne(control: Control, est: Estimate, p: Parameters) -> None:
    """Start from the present position, velocity and lean."""
    c = control.pos_ne
    lean = control.attitude.target_euler
    if not is_active_ne(control):
        c.accel_target = lean_accel(lean.roll, lean.pitch, est.yaw)
    c.accel_target = limit_length(c.accel_target, renew_accel_limit(control, p))
    start_from(c, horizontal(est.pos), horizontal(est.vel))
    c.reset_count = est.reset_ne_count
    c.last_tick = control.tick


@law
def init_ne_stopping_point(control: Control, est: Estimate, p: Parameters) -> None:
    """Start from where the vehicle can stop."""
    init_ne(control, est, p)
    control.pos_ne.pos_desired = stopping_point_ne(control.pos_ne, est, p.PSC)
    control.pos_ne.vel_desired = Vec2(0.0, 0.0)


@law
def relax_ne(control: Control, est: Estimate, p: Parameters) -> None:
    """Let the lean decay to zero at the present position (on the ground, spooling)."""
    control.pos_ne.accel_target *= 1.0 - DT / (DT + RELAX_TIME)
    init_ne(control, est, p)


@law
def soften_for_landing_ne(c: PositionState, pos: Vec3) -> None:
    """Let the position error to ``pos`` [m] decay and the integrator not grow: the ground may hold the vehicle."""
    c.pos_desired += DT / (DT + RELAX_TIME) * (horizontal(pos) - c.pos_desired)
    c.limit = c.accel_target


@law
def stopping_point(pos: Vec2, vel: Vec2, p: float, speed_max: float, accel_max: float) -> Vec2:
    """Where a vehicle at ``pos`` [m], ``vel`` [m/s] stops that brakes as a position gain ``p`` [1/s] asks."""
    speed = norm2(vel)
    if not speed > 1e-6:
        return pos
    return pos + vel * (inverse_sqrt_controller(min(speed, speed_max), p, accel_max) / speed)


@law
def stopping_point_ne(c: PositionState, est: Estimate, p: Position) -> Vec2:
    """(north, east) [m] where the vehicle stops from its present velocity, braking within the limits."""
    return stopping_point(horizontal(est.pos), horizontal(est.vel), p.POSXY_P, c.speed_max, c.accel_max)
