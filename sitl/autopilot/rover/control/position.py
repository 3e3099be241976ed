# SPDX-License-Identifier: BSD-3-Clause
"""Position: target -> velocity -> acceleration -> desired speed and turn rate (PSC_POS_P, PSC_VEL_*, TURN_RADIUS).

North and east in metres from the estimator's origin. A mode calls ``init`` once, then one ``input_*`` or ``set_*`` law
and ``follow_target`` every period; it reads ``desired_speed``, ``desired_turn_rate`` (or ``desired_lat_accel``) and
hands them to ``speed`` and ``steering``. The acceleration wanted across the nose becomes a turn, what is wanted along
it a speed. A car cannot turn on the spot: while it is slower than its tightest turn allows, it keeps moving at that
speed, or at the target's if that is less. Targets that are not finite are not taken over.
"""

from __future__ import annotations

import math

from ....core.algebra import ZERO2, cross2, direction, dot2, finite2, horizontal, limit_length, norm2
from ....core.kernels import law
from ....core.vectors import Vec2
from ...control.pid import Gains, basic_gains, lowpass_gain
from ...control.shaping import (
    Limits2,
    Motion2,
    advance_2d,
    inverse_sqrt_controller,
    shape_pos_vel_accel_2d,
    sqrt_controller_2d,
)
from ...state import Estimate
from ..parameters import Parameters
from .motors import is_skid
from .speed import accel_limited
from .state import DT, Control, PositionState, current_tick, is_recent
from .steering import lat_accel_max, turn_rate_from_lat_accel

TIMEOUT = 5
"""Periods after which a controller that did not run starts afresh: 0.1 s, ArduPilot's."""
SPEED_BACK_MIN = 0.3
"""Least speed of a way back that counts as one [m/s]; of slow vehicles this fraction of their speed:"""
SPEED_BACK_RATIO = 0.5
STANDING = 1e-9
"""Speed that has a direction only [m/s]."""
LAT_ACCEL_ASIDE = 0.01
"""Lateral acceleration that leaves the line of a way straight back [m/s^2]."""


@law
def is_active(control: Control) -> bool:
    """Whether ``follow_target`` ran in the last 0.1 s."""
    return is_recent(control, control.position.last_tick, TIMEOUT)


@law
def set_limits(c: PositionState, speed_max: float, accel_max: float, lat_accel_max: float, jerk_max: float) -> None:
    """Limits of the correction and of shaped targets [m/s, m/s^2, m/s^2, m/s^3]."""
    c.speed_max = max(speed_max, 0.0)
    c.accel_max = max(accel_max, 0.0)
    c.lat_accel_max = max(lat_accel_max, 0.0)
    c.jerk_max = max(jerk_max, 0.0)


@law
def init(c: PositionState, estimate: Estimate) -> bool:
    """Targets to where the vehicle is and how it moves, forwards; False without a position estimate."""
    if not estimate.position_ok:
        return False
    c.pos_target = horizontal(estimate.pos)
    c.vel_desired = horizontal(estimate.vel)
    c.accel_desired = horizontal(estimate.acc_ned)
    c.pos_error = ZERO2
    c.vel_target = ZERO2
    c.accel_target = ZERO2
    c.reversed = False
    c.reset_count = estimate.reset_ne_count
    return True


@law
def finite_motion(target: Motion2) -> bool:
    """Whether all numbers are finite."""
    return finite2(target.pos) and finite2(target.vel) and finite2(target.acc)


@law
def set_pos_vel_accel(c: PositionState, target: Motion2) -> None:
    """Follow a path that is already smooth."""
    if finite_motion(target):
        c.pos_target = target.pos
        c.vel_desired = target.vel
        c.accel_desired = target.acc


@law
def input_pos_vel_accel(c: PositionState, target: Motion2) -> None:
    """Pull the target, shaped, towards a moving point."""
    if not finite_motion(target):
        return
    now = advance_2d(Motion2(c.pos_target, c.vel_desired, c.accel_desired), DT, ZERO2, ZERO2, ZERO2)
    c.pos_target = now.pos
    c.vel_desired = now.vel
    accel_max = min(c.accel_max, c.lat_accel_max)
    if accel_max > 0.0 and c.jerk_max > 0.0:
        c.accel_desired = shape_pos_vel_accel_2d(target, now, Limits2(c.speed_max, accel_max, c.jerk_max), DT)


@law
def input_pos(c: PositionState, pos: Vec2) -> None:
    """The same towards a point that stands [m]."""
    input_pos_vel_accel(c, Motion2(pos, ZERO2, ZERO2))


@law
def follow_reset(c: PositionState, estimate: Estimate) -> None:
    """When the estimate jumps, the target jumps with it."""
    if c.reset_count != estimate.reset_ne_count:
        c.reset_count = estimate.reset_ne_count
        c.pos_target = horizontal(estimate.pos) + c.pos_error
        c.vel_desired = horizontal(estimate.vel) + c.vel_error


@law
def control_position(c: PositionState, pos: Vec2, pos_p: float) -> Vec2:
    """Velocity [m/s] that takes the position error away (``pos_p`` [1/s]); a target too far ahead waits."""
    accel_max = min(c.accel_max, c.lat_accel_max)
    if c.jerk_max > 0.0 and pos_p > 0.0:
        accel_max = min(accel_max, c.jerk_max / pos_p)
    error = c.pos_target - pos
    if c.speed_max > 0.0 and pos_p > 0.0:
        error_max = inverse_sqrt_controller(c.speed_max, pos_p, accel_max)
        if dot2(error, error) > error_max * error_max:
            error = limit_length(error, error_max)
            c.pos_target = pos + error
    c.pos_error = error
    return sqrt_controller_2d(error, pos_p, accel_max, 0.0)


@law
def control_velocity(c: PositionState, vel: Vec2, gains: Gains) -> Vec2:
    """Acceleration [m/s^2] that the velocity PID asks for at ``vel`` [m/s]."""
    error = c.vel_target - vel
    if c.started:
        last = c.vel_error
        c.vel_error = last + lowpass_gain(gains.error_hz, DT) * (error - last)
        derivative = (c.vel_error - last) / DT
        c.vel_derivative += lowpass_gain(gains.derivative_hz, DT) * (derivative - c.vel_derivative)
    else:
        c.started = True
        c.vel_error = error
        c.vel_derivative = ZERO2
    integrator = limit_length(c.vel_integrator + c.vel_error * gains.i * DT, gains.i_max)
    c.vel_integrator = integrator if gains.i != 0.0 else ZERO2
    return gains.p * c.vel_error + c.vel_integrator + gains.d * c.vel_derivative + gains.ff * c.vel_target


@law
def turn_radius(params: Parameters) -> float:
    """Radius of the tightest turn [m]: TURN_RADIUS, 0 for a skid-steered vehicle."""
    return 0.0 if is_skid(params) else max(params.TURN_RADIUS, 0.0)


@law
def speed_along(c: PositionState, along: float, size: float, slowest: float) -> float:
    """Speed along the nose [m/s]: ``along``, what is wanted there, but no less than the tightest turn needs.

    ``size``: length of the wanted velocity; ``slowest``: least speed of a turn [m/s].
    """
    least = min(size, slowest)
    return min(-least, along) if c.reversed else max(least, along)


@law
def lateral_or_aside(c: PositionState, along: float, size: float, lateral: float) -> float:
    """``lateral`` acceleration [m/s^2]; where the way leads straight back, nothing would turn a car: then to the right.

    ``along``: of the wanted velocity of ``size`` along the nose [m/s].
    """
    away = along > 0.0 if c.reversed else along < 0.0
    if away and size > min(SPEED_BACK_MIN, SPEED_BACK_RATIO * c.speed_max) and abs(lateral) < LAT_ACCEL_ASIDE:
        return LAT_ACCEL_ASIDE
    return lateral


@law
def drive_towards(control: Control, heading: float, params: Parameters) -> None:
    """From the wanted velocity and acceleration to the outputs of a vehicle with its nose at ``heading`` [rad]."""
    c = control.position
    nose = direction(heading)
    along = dot2(c.vel_target, nose)
    size = norm2(c.vel_target)
    slowest = math.sqrt(0.5 * lat_accel_max(params.ATC) * turn_radius(params))
    c.desired_speed = accel_limited(control, speed_along(c, along, size, slowest), params.ATC)
    c.desired_lat_accel = lateral_or_aside(c, along, size, cross2(nose, c.accel_target))
    speed = c.desired_speed
    if speed == 0.0 and c.reversed:
        speed = -STANDING  # towards where it is about to go
    c.desired_turn_rate = turn_rate_from_lat_accel(c.desired_lat_accel, speed)


@law
def brake(control: Control, params: Parameters) -> None:
    """Outputs that slow down straight on."""
    c = control.position
    c.desired_speed = accel_limited(control, 0.0, params.ATC)
    c.desired_turn_rate = 0.0
    c.desired_lat_accel = 0.0


@law
def follow_target(control: Control, estimate: Estimate, armed: bool, params: Parameters) -> None:
    """One period of the cascade. Disarmed or without a position the outputs brake."""
    c = control.position
    psc = params.PSC
    pos, vel = horizontal(estimate.pos), horizontal(estimate.vel)
    if not (armed and estimate.position_ok and finite2(pos) and finite2(vel)):
        brake(control, params)
        return
    follow_reset(c, estimate)
    if not is_active(control):
        c.started = False
        c.vel_integrator = ZERO2
    c.last_tick = current_tick(control)
    c.vel_target = limit_length(control_position(c, pos, psc.POS_P) + c.vel_desired, c.speed_max)
    c.accel_target = control_velocity(c, vel, basic_gains(psc.VEL, psc.VEL.IMAX)) + c.accel_desired
    drive_towards(control, estimate.yaw, params)
