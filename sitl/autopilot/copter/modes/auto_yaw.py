# SPDX-License-Identifier: BSD-3-Clause
"""Where the nose points in modes that fly by themselves.

Sources: ArduPilot's WP_YAW_BEHAVIOR, ATC_SLEW_YAW, MAV_CMD_CONDITION_YAW, MAV_CMD_DO_SET_ROI.
"""

from __future__ import annotations

import math
from typing import NamedTuple

from ....core.algebra import cross2, dot2, horizontal
from ....core.elementary import atan2
from ....core.kernels import inlined, law
from ....core.scalars import TWO_PI, constrain, wrap_pi
from ....core.vectors import Vec3
from ...state import Estimate
from ..control import attitude
from ..control.attitude import Heading
from ..control.state import DT, AttitudeState, Control, PositionState
from ..parameters import Parameters
from ..parameters.control import Attitude
from ..parameters.flight_modes import Waypoints
from .state import AutoYaw, Modes

HOLD = 0  # heading as it is
LOOK_AT_NEXT_WP = 1  # along the desired velocity
ROI = 2
FIXED = 3  # CONDITION_YAW
LOOK_AHEAD = 4  # along the course flown
RATE = 7  # turn rate from a set-point
ANGLE_RATE = 6  # angle that moves at a rate, from a set-point
CIRCLE = 8  # angle and rate are the mode's
PILOT_RATE = 9

_COURSE_SPEED = 1.0  # slower than this the course says nothing [m/s]


class Turn(NamedTuple):
    """MAV_CMD_CONDITION_YAW."""

    angle: float  # heading, or angle to turn by [rad]
    rate: float  # [rad/s]; 0: ATC_SLEW_YAW
    direction: int  # 1 clockwise, -1 counter-clockwise, 0 the shorter way
    relative: bool  # the angle counts from the present heading


@law
def set_mode(yaw: AutoYaw, mode: int, target: AttitudeState, est: Estimate) -> None:
    """Change what decides about the heading; keeps the one under way, that of the attitude controller's ``target``."""
    if yaw.mode == mode:
        return
    yaw.mode = mode
    yaw.rate = 0.0
    yaw.yaw = target.target_euler.yaw
    yaw.look_ahead = est.yaw


@law
def default_mode(behaviour: int, homeward: bool) -> int:
    """What WP_YAW_BEHAVIOR says; ``homeward``: on the way home."""
    if behaviour == 0 or (behaviour == 2 and homeward):
        return HOLD
    return LOOK_AHEAD if behaviour == 3 else LOOK_AT_NEXT_WP


@law
def set_default(yaw: AutoYaw, p: Waypoints, homeward: bool, target: AttitudeState, est: Estimate) -> None:
    """Leave the heading to WP_YAW_BEHAVIOR."""
    set_mode(yaw, default_mode(int(p.YAW_BEHAVIOR), homeward), target, est)


@law
def turn_from(start: float, turn: Turn) -> float:
    """The angle to turn, signed [rad], from heading ``start`` [rad].

    An absolute angle is reached in the direction asked for, even if that is almost a full circle.
    """
    if turn.relative:
        return -turn.angle if turn.direction < 0 else turn.angle
    offset = wrap_pi(turn.angle - start)
    if turn.direction < 0 and offset > 0.0:
        return offset - TWO_PI
    if turn.direction > 0 and offset < 0.0:
        return offset + TWO_PI
    return offset


@law
def turn_to(yaw: AutoYaw, turn: Turn, start: float, rate_max: float) -> None:
    """Turn from heading ``start`` [rad], at most at ``rate_max`` [rad/s] (0: no limit), then hold.

    Repeated, it goes on from the heading that it has come to, so that the turn is as fast at any rate of messages.
    """
    if yaw.mode != FIXED:
        yaw.mode = FIXED
        yaw.yaw = start
    yaw.rate = 0.0
    yaw.offset = turn_from(yaw.yaw, turn)
    yaw.slew = turn.rate if turn.rate > 0.0 and (turn.rate < rate_max or rate_max <= 0.0) else rate_max


@law
def slew_max(p: Attitude) -> float:
    """ATC_SLEW_YAW [rad/s]."""
    return math.radians(p.SLEW_YAW * 0.01)


@law
def follow_angle(yaw: AutoYaw, angle: float, rate: float) -> None:
    """Heading ``angle`` [rad] that moves on at ``rate`` [rad/s]."""
    yaw.mode = ANGLE_RATE
    yaw.yaw = wrap_pi(angle)
    yaw.rate = rate


@law
def turn_at(yaw: AutoYaw, rate: float, target: AttitudeState, est: Estimate) -> None:
    """Turn at ``rate`` [rad/s]."""
    set_mode(yaw, RATE, target, est)
    yaw.rate = rate


@law
def look_at(yaw: AutoYaw, position: Vec3, target: AttitudeState, est: Estimate) -> None:
    """Keep the nose on a point, NED [m]."""
    set_mode(yaw, ROI, target, est)
    yaw.roi = position


@law
def stop_turning(yaw: AutoYaw, target: AttitudeState, est: Estimate) -> None:
    """A set-point's turn rate is too old: keep the heading."""
    if yaw.mode in (RATE, ANGLE_RATE):
        set_mode(yaw, HOLD, target, est)


@law
def has_turned(yaw: AutoYaw, heading: float) -> bool:
    """Whether CONDITION_YAW is done: all of the angle turned, and the nose (``heading`` [rad]) within 2 degrees."""
    if yaw.mode != FIXED:
        return True
    return abs(yaw.offset) < 1e-6 and abs(wrap_pi(heading - yaw.yaw)) < math.radians(2.0)


@law
def advance_turn(yaw: AutoYaw, dt: float) -> None:
    """Turn on for ``dt`` [s]."""
    step = yaw.offset
    if yaw.slew > 0.0:
        step = constrain(step, -yaw.slew * dt, yaw.slew * dt)
    yaw.offset -= step
    yaw.yaw = wrap_pi(yaw.yaw + step)


@law
def look_along(yaw: AutoYaw, path: PositionState, target: AttitudeState) -> float:
    """Point the nose along the path of the position controller's motion; its turn rate [rad/s].

    Slower than 5 % of its greatest speed, keep the heading that the attitude controller's ``target`` has come to.
    """
    vel, acc = path.vel_desired, path.accel_desired
    speed2 = dot2(vel, vel)
    speed_min = 0.05 * path.speed_max
    if speed2 > speed_min * speed_min and speed2 > 1e-6:
        yaw.yaw = atan2(vel.y, vel.x)
        return cross2(vel, acc) / speed2
    yaw.yaw = target.target_euler.yaw
    return 0.0


@law
def advance(yaw: AutoYaw, path: PositionState, target: AttitudeState, est: Estimate, dt: float) -> Heading:
    """Move the heading on by ``dt`` [s]; ``path``, ``target``: those of the position and attitude controllers."""
    if yaw.mode == FIXED:
        advance_turn(yaw, dt)
        return Heading(yaw.yaw, 0.0, True)
    if yaw.mode == ROI:
        away = horizontal(yaw.roi - est.pos)
        if dot2(away, away) > 0.01:
            yaw.yaw = atan2(away.y, away.x)
        return Heading(yaw.yaw, 0.0, True)
    if yaw.mode == LOOK_AHEAD:
        vel = horizontal(est.vel)
        if dot2(vel, vel) > _COURSE_SPEED * _COURSE_SPEED:
            yaw.look_ahead = atan2(vel.y, vel.x)
        return Heading(yaw.look_ahead, 0.0, True)
    if yaw.mode == LOOK_AT_NEXT_WP:
        rate = look_along(yaw, path, target)
        return Heading(yaw.yaw, rate, True)
    if yaw.mode == ANGLE_RATE:
        yaw.yaw = wrap_pi(yaw.yaw + yaw.rate * dt)
        return Heading(yaw.yaw, yaw.rate, True)
    if yaw.mode == CIRCLE:
        return Heading(yaw.yaw, yaw.rate, True)
    return Heading(0.0, yaw.rate if yaw.mode in (RATE, PILOT_RATE) else 0.0, False)


@law
def follow_pilot(modes: Modes, target: AttitudeState, est: Estimate) -> None:
    """Let the yaw stick take over, and keep the heading when it is released."""
    yaw, rate = modes.auto_yaw, modes.pilot.yaw_rate
    if abs(rate) > 1e-4 and not modes.failsafe.radio:
        set_mode(yaw, PILOT_RATE, target, est)
        yaw.rate = rate
    elif yaw.mode == PILOT_RATE:
        set_mode(yaw, HOLD, target, est)


@inlined
def point(yaw: AutoYaw, thrust: Vec3, control: Control, est: Estimate, p: Parameters) -> None:
    """Send the thrust direction (NED) with this mode's heading to the attitude controller."""
    heading = advance(yaw, control.pos_ne, control.attitude, est, DT)
    if heading.absolute:
        attitude.input_thrust_vector_heading(control, est, p, thrust, heading)
    else:
        turn = attitude.limit_turn(heading.rate, attitude.slew_yaw_max(p.ATC))
        attitude.input_thrust_vector_heading_rate(control, est, p, thrust, turn)
