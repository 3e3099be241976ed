# SPDX-License-Identifier: BSD-3-Clause
"""Horizontal position: shaped path -> position P -> velocity PID -> lean (PSC_POSXY_P, PSC_VELXY_*, PSC_JERK_XY).

North and east in metres from the estimator's origin. A mode calls one ``input_*`` (or ``set_pos_vel_accel_ne``) law and
then ``update_ne`` every tick. The desired path waits where the lean is used up, and the velocity integrator does not
grow in that direction. Inputs that are not finite are ignored: the vehicle brakes instead.
"""

from __future__ import annotations

from typing import NamedTuple

from ....core.algebra import dot2, finite2, horizontal, limit_length, norm2
from ....core.constants import GRAVITY
from ....core.kernels import inlined, law
from ....core.scalars import finite
from ....core.vectors import Vec2, Vec3
from ...control.pid import Gains, basic_gains, lowpass_gain
from ...control.shaping import (
    Limits2,
    Motion2,
    advance_2d,
    inverse_sqrt_controller,
    limit_accel,
    shape_accel_2d,
    shape_pos_vel_accel_2d,
    shape_vel_accel_2d,
    sqrt_controller_2d,
)
from ...state import Estimate
from ..parameters import Parameters
from ..parameters.control import Position
from .position_start import accel_limit_ne, init_ne, is_active_ne
from .state import DT, Control, PositionState


class PositionGains(NamedTuple):
    """Gains of the cascade."""

    pos_p: float  # [1/s]
    vel: Gains  # [m/s] to [m/s^2]


@inlined
def finite_motion(target: Motion2) -> bool:
    """Whether all numbers are finite."""
    return finite2(target.pos) and finite2(target.vel) and finite2(target.acc)


@inlined
def desired_motion_ne(c: PositionState) -> Motion2:
    """The desired path of this tick."""
    return Motion2(c.pos_desired, c.vel_desired, c.accel_desired)


@inlined
def advance_ne(c: PositionState) -> None:
    """Move the desired path on by one tick."""
    moved = advance_2d(desired_motion_ne(c), DT, c.limit, c.pos_error, c.vel_error)
    c.pos_desired = moved.pos
    c.vel_desired = moved.vel


@inlined
def shape_pos_ne(c: PositionState, target: Motion2, speed_max: float) -> None:
    """New desired acceleration towards a moving point; the path itself is moved by ``advance_ne``."""
    limits = Limits2(speed_max, c.accel_max, c.jerk_max)
    c.accel_desired = shape_pos_vel_accel_2d(target, desired_motion_ne(c), limits, DT)


@law
def input_pos_vel_accel_ne(c: PositionState, target: Motion2) -> None:
    """Follow a moving point, shaped."""
    if finite_motion(target):
        advance_ne(c)
        shape_pos_ne(c, target, c.speed_max)
    else:
        brake_ne(c)


@law
def input_vel_accel_ne(c: PositionState, vel: Vec2, acc: Vec2) -> None:
    """Fly at ``vel`` [m/s], which changes with ``acc`` [m/s^2], shaped."""
    if not (finite2(vel) and finite2(acc)):
        vel, acc = Vec2(0.0, 0.0), Vec2(0.0, 0.0)
    advance_ne(c)
    limits = Limits2(0.0, c.accel_max, c.jerk_max)
    c.accel_desired = shape_vel_accel_2d(vel, acc, desired_motion_ne(c), limits, DT)


@law
def brake_ne(c: PositionState) -> None:
    """Come to a stop, shaped."""
    input_vel_accel_ne(c, Vec2(0.0, 0.0), Vec2(0.0, 0.0))


@law
def input_accel_ne(c: PositionState, acc: Vec2) -> None:
    """Accelerate with ``acc`` [m/s^2], jerk-limited."""
    advance_ne(c)
    wanted = acc if finite2(acc) else Vec2(0.0, 0.0)
    c.accel_desired = shape_accel_2d(wanted, c.accel_desired, c.jerk_max, DT)


@law
def set_pos_vel_accel_ne(c: PositionState, target: Motion2) -> None:
    """Desired path given outright, for trajectories that are already smooth."""
    if finite_motion(target):
        c.pos_desired = target.pos
        c.vel_desired = target.vel
        c.accel_desired = target.acc
    else:
        brake_ne(c)


@inlined
def thrust_vector(c: PositionState) -> Vec3:
    """NED direction of thrust (not normalised) [m/s^2] that gives the horizontal acceleration in level flight."""
    return Vec3(c.accel_target.x, c.accel_target.y, -GRAVITY)


@inlined
def control_position(c: PositionState, pos: Vec2, p: float) -> Vec2:
    """Velocity [m/s] that takes the position error away; the path waits for a vehicle that cannot keep up."""
    error = c.pos_desired - pos
    if not finite2(error):
        error = Vec2(0.0, 0.0)
    if c.correction_speed > 0.0 and p > 0.0:
        error_max = inverse_sqrt_controller(c.correction_speed, p, c.correction_accel)
        if dot2(error, error) > error_max * error_max:
            error = limit_length(error, error_max)
            c.pos_desired = pos + error
    c.pos_error = error
    return sqrt_controller_2d(error, p, c.correction_accel, 0.0)


@inlined
def control_velocity(c: PositionState, vel: Vec2, gains: Gains) -> Vec2:
    """Acceleration [m/s^2] that the velocity PID asks for at ``vel`` [m/s]; its filters have no target's."""
    error = c.vel_target - vel
    error = Vec2(error.x if finite(error.x) else 0.0, error.y if finite(error.y) else 0.0)
    if c.started:
        filtered = c.vel_error + lowpass_gain(gains.error_hz, DT) * (error - c.vel_error)
        derivative = (filtered - c.vel_error) / DT
        c.vel_derivative += lowpass_gain(gains.derivative_hz, DT) * (derivative - c.vel_derivative)
        c.vel_error = filtered
    else:
        c.started = True
        c.vel_error = error
        c.vel_derivative = Vec2(0.0, 0.0)
    step = c.vel_error * gains.i * DT
    integrator = c.vel_integrator + step
    if dot2(step, c.limit) > 0.0:
        # Into the limit: the integrator may turn but not grow.
        integrator = limit_length(integrator, norm2(c.vel_integrator))
    integrator = limit_length(integrator, gains.i_max)
    c.vel_integrator = integrator if gains.i != 0.0 else Vec2(0.0, 0.0)
    return gains.p * c.vel_error + c.vel_integrator + gains.d * c.vel_derivative + gains.ff * c.vel_target


@inlined
def control_horizontal(c: PositionState, pos: Vec2, vel: Vec2, accel_max: float, gains: PositionGains) -> None:
    """One tick of the cascade at ``pos`` [m], ``vel`` [m/s]: ``accel_target``, at most ``accel_max`` [m/s^2]."""
    c.vel_target = control_position(c, pos, gains.pos_p) + c.vel_desired
    accel = control_velocity(c, vel, gains.vel) + c.accel_desired
    c.limit = Vec2(0.0, 0.0)
    if dot2(accel, accel) > accel_max * accel_max:
        c.limit = accel
        accel = limit_accel(c.vel_desired, accel, accel_max)
    c.accel_target = accel


@inlined
def follow_reset_ne(c: PositionState, pos: Vec2, jump: Vec2, count: int) -> None:
    """When the estimate jumps to ``pos``, its velocity by ``jump``, the path jumps with it; ``count``: of the jumps."""
    if c.reset_count != count:
        c.reset_count = count
        c.pos_desired = pos + c.pos_error
        c.vel_desired += jump


@inlined
def position_gains(p: Position) -> PositionGains:
    """PSC_POSXY_P, PSC_VELXY_*."""
    return PositionGains(p.POSXY_P, basic_gains(p.VELXY, p.VELXY.IMAX * 0.01))


@law
def update_ne(control: Control, est: Estimate, p: Parameters) -> None:
    """One tick of the cascade: ``accel_target`` comes out (see ``thrust_vector``)."""
    c = control.pos_ne
    if not is_active_ne(control):
        init_ne(control, est, p)
    pos, vel = horizontal(est.pos), horizontal(est.vel)
    if c.disturbed:
        c.disturbed = False
        pos += c.disturbance_pos
        vel += c.disturbance_vel
    follow_reset_ne(c, pos, horizontal(est.reset_vel), est.reset_ne_count)
    c.last_tick = control.tick
    control_horizontal(c, pos, vel, accel_limit_ne(control, p), position_gains(p.PSC))
