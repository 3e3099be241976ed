# SPDX-License-Identifier: BSD-3-Clause
"""Set-points of GUIDED, as messages ask for them.

Each law returns OK, or says why it left the record as it was (``commands``).
"""

from __future__ import annotations

import math
from typing import NamedTuple

from ....core.algebra import quat_norm_squared
from ....core.kernels import law
from ....core.scalars import constrain
from ....core.vectors import Quat, Vec3
from ...command_results import CommandResult
from ...fence.checks import allows
from ...modes import ModeResult
from .. import terrain_following
from ..control.state import AltitudeState
from ..state import Autopilot, Vehicle
from ..terrain_following import ground_below
from . import auto_yaw, guided
from .auto import is_guided
from .guided import ACCEL, ANGLE, POS_VEL_ACCEL, POSITION, VELOCITY_ACCEL
from .mode_commands import is_usable, is_usable_vector
from .state import GuidedState, Modes

_THRUST_IS_THRUST = 8
"""GUID_OPTIONS: thrust of SET_ATTITUDE_TARGET is thrust, not climb rate."""


class YawSetpoint(NamedTuple):
    """The heading that goes with a set-point; without angle and rate it follows WP_YAW_BEHAVIOR."""

    use_angle: bool
    angle: float  # [rad]
    use_rate: bool
    rate: float  # [rad/s]
    relative: bool  # the angle counts from the present heading


NO_YAW = YawSetpoint(False, 0.0, False, 0.0, False)


@law
def refusal(modes: Modes, usable: bool, yaw: YawSetpoint) -> int:
    """OK, or why a set-point is not taken; ``usable``: its numbers are."""
    if not (usable and is_usable(yaw.angle) and is_usable(yaw.rate)):
        return CommandResult.NOT_FINITE
    return CommandResult.OK if is_guided(modes) else CommandResult.WRONG_MODE


@law
def is_beyond_fence(ap: Autopilot, pos: Vec3) -> bool:
    """Whether a position, NED [m] from the origin, is beyond a fence that is on."""
    fence = ap.params.FENCE
    return ap.fence.on != 0 and not allows(ap.fence, ap.home, pos, fence, fence.ALT_MAX, fence.ALT_MIN)


@law
def set_yaw(ap: Autopilot, setpoint: YawSetpoint) -> None:
    """Heading that goes with a set-point."""
    yaw, target, est = ap.modes.auto_yaw, ap.control.attitude, ap.estimate
    if setpoint.use_angle and setpoint.relative:
        turn = auto_yaw.Turn(setpoint.angle, 0.0, 0, True)
        auto_yaw.turn_to(yaw, turn, target.target_euler.yaw, auto_yaw.slew_max(ap.params.ATC))
    elif setpoint.use_angle:
        auto_yaw.follow_angle(yaw, setpoint.angle, setpoint.rate if setpoint.use_rate else 0.0)
    elif setpoint.use_rate:
        auto_yaw.turn_at(yaw, setpoint.rate, target, est)
    else:
        auto_yaw.set_default(yaw, ap.params.WP, False, target, est)


@law
def begin(v: Vehicle, submode: int) -> GuidedState:
    """Prepare for a set-point of this kind and note when it came."""
    ap = v.autopilot
    state = ap.modes.guided
    ap.modes.nav.over_ground = False
    if state.submode != submode:
        guided.start_submode(state, submode, ap.control, ap.estimate, ap.params)
    state.update_us = v.time_us
    return state


@law
def set_position(v: Vehicle, pos: Vec3, yaw: YawSetpoint) -> int:
    """Fly to a point, NED [m] from the origin, and stay."""
    code = refusal(v.autopilot.modes, is_usable_vector(pos), yaw)
    if code == CommandResult.OK and is_beyond_fence(v.autopilot, pos):
        code = CommandResult.BEYOND_FENCE
    if code == CommandResult.OK:
        begin(v, POSITION).pos = pos
        set_yaw(v.autopilot, yaw)
    return code


@law
def set_position_over_ground(v: Vehicle, pos: Vec3, yaw: YawSetpoint) -> int:
    """Fly to a point and stay, its height above the ground: NE from the origin, -height [m]."""
    nav, ground = v.autopilot.modes.nav, ground_below(v)
    code = refusal(v.autopilot.modes, is_usable_vector(pos), yaw)
    if code == CommandResult.OK and not ground.is_known:
        code = CommandResult.NO_GROUND
    if code == CommandResult.OK and is_beyond_fence(v.autopilot, Vec3(pos.x, pos.y, pos.z + ground.d)):
        code = CommandResult.BEYOND_FENCE
    if code == CommandResult.OK:
        follows = nav.over_ground
        begin(v, POSITION).pos = pos
        if follows:
            nav.over_ground = True
        else:
            terrain_following.begin(nav, ground)
        set_yaw(v.autopilot, yaw)
    return code


@law
def set_velocity(v: Vehicle, vel: Vec3, acc: Vec3, yaw: YawSetpoint) -> int:
    """Fly a velocity [m/s] that changes with an acceleration [m/s^2], NED."""
    code = refusal(v.autopilot.modes, is_usable_vector(vel) and is_usable_vector(acc), yaw)
    if code == CommandResult.OK:
        target = begin(v, VELOCITY_ACCEL)
        target.vel, target.acc = vel, acc
        set_yaw(v.autopilot, yaw)
    return code


@law
def set_accel(v: Vehicle, acc: Vec3, yaw: YawSetpoint) -> int:
    """Fly an acceleration, NED [m/s^2]."""
    code = refusal(v.autopilot.modes, is_usable_vector(acc), yaw)
    if code == CommandResult.OK:
        begin(v, ACCEL).acc = acc
        set_yaw(v.autopilot, yaw)
    return code


@law
def set_pos_vel_accel(v: Vehicle, pos: Vec3, vel: Vec3, acc: Vec3, yaw: YawSetpoint) -> int:
    """Follow a point (NED [m]) that moves with a velocity [m/s] and an acceleration [m/s^2]."""
    usable = is_usable_vector(pos) and is_usable_vector(vel) and is_usable_vector(acc)
    code = refusal(v.autopilot.modes, usable, yaw)
    if code == CommandResult.OK and is_beyond_fence(v.autopilot, pos):
        code = CommandResult.BEYOND_FENCE
    if code == CommandResult.OK:
        target = begin(v, POS_VEL_ACCEL)
        target.pos, target.vel, target.acc = pos, vel, acc
        set_yaw(v.autopilot, yaw)
    return code


@law
def set_attitude(v: Vehicle, use_attitude: bool, q: Quat, rates: Vec3, thrust: float) -> int:
    """Fly an attitude (body to NED) turning with body rates [rad/s], or the rates alone.

    ``thrust`` 0 .. 1 is a climb rate around 0.5 (0: WPNAV_SPEED_DN down, 1: WPNAV_SPEED_UP up), or with
    GUID_OPTIONS bit 8 the thrust.
    """
    ap = v.autopilot
    code = CommandResult.OK if takes_attitudes(ap.modes) else CommandResult.WRONG_MODE
    if not (is_usable_vector(rates) and is_usable(thrust)):
        code = CommandResult.NOT_FINITE
    size = math.sqrt(quat_norm_squared(q)) if use_attitude else 1.0
    if code == CommandResult.OK and not 0.5 <= size <= 2.0:
        code = CommandResult.OUT_OF_RANGE if size == size else CommandResult.NOT_FINITE
    if code != CommandResult.OK:
        return code
    target = begin(v, ANGLE)
    target.use_attitude = use_attitude
    if use_attitude:
        target.q = q / size
    target.rates = rates
    target.thrust = constrain(thrust, 0.0, 1.0)
    target.use_thrust = (int(ap.params.GUID.OPTIONS) & _THRUST_IS_THRUST) != 0
    target.climb_rate = climb_of_thrust(target.thrust, ap.control.pos_d)
    return code


@law
def takes_attitudes(modes: Modes) -> bool:
    """Whether SET_ATTITUDE_TARGET is flown."""
    return is_guided(modes) or modes.number == guided.GUIDED_NOGPS


@law
def climb_of_thrust(thrust: float, limits: AltitudeState) -> float:
    """Climb rate [m/s] that ``thrust`` 0 .. 1 stands for: 0.5 none."""
    return (thrust - 0.5) * 2.0 * (limits.speed_up if thrust >= 0.5 else limits.speed_down)


@law
def stop(v: Vehicle) -> int:
    """Come to a stop and hold, as when the mode is entered; a pause ends."""
    if not is_guided(v.autopilot.modes):
        return CommandResult.WRONG_MODE
    return CommandResult.OK if guided.start(v) == ModeResult.ACCEPTED else CommandResult.WRONG_MODE
