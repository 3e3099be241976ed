# SPDX-License-Identifier: BSD-3-Clause
"""Set-points of GUIDED, as the MAVLink services write them.

Every law returns OK, or says why it left the record as it was (``commands``).
"""

from __future__ import annotations

import math
from typing import NamedTuple

from ....core.algebra import ZERO, quat_norm_squared
from ....core.kernels import law
from ....core.scalars import constrain
from ....core.vectors import Quat, Vec3
from ..control.state import AltitudeState
from ..state import Autopilot, Vehicle
from . import auto_yaw, guided
from .commands import NOT_FINITE, OK, OUT_OF_RANGE, WRONG_MODE, is_usable, is_usable_vector
from .guided import ACCEL, ANGLE, GUIDED, POS_VEL_ACCEL, POSITION, VELOCITY_ACCEL

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
def refusal(v: Vehicle, usable: bool, yaw: YawSetpoint) -> int:
    """OK, or why a set-point is not taken; ``usable``: its numbers are."""
    if not (usable and is_usable(yaw.angle) and is_usable(yaw.rate)):
        return NOT_FINITE
    return OK if v.autopilot.modes.number == GUIDED else WRONG_MODE


@law
def set_yaw(ap: Autopilot, yaw: YawSetpoint) -> None:
    """Heading that goes with a set-point."""
    if yaw.use_angle and yaw.relative:
        auto_yaw.turn_to(ap, yaw.angle, 0.0, 0, True)
    elif yaw.use_angle:
        auto_yaw.follow_angle(ap.modes.auto_yaw, yaw.angle, yaw.rate if yaw.use_rate else 0.0)
    elif yaw.use_rate:
        auto_yaw.turn_at(ap, yaw.rate)
    else:
        auto_yaw.set_default(ap, False)


@law
def begin(v: Vehicle, submode: int) -> None:
    """Prepare for a set-point of this kind and note when it came."""
    modes = v.autopilot.modes
    if modes.guided.submode != submode:
        guided.start_submode(v.autopilot, submode)
    modes.guided.paused = False
    modes.guided.update_us = v.time_us


@law
def set_position(v: Vehicle, pos: Vec3, yaw: YawSetpoint) -> int:
    """Fly to a point, NED [m] from the origin, and stay."""
    code = refusal(v, is_usable_vector(pos), yaw)
    if code == OK:
        begin(v, POSITION)
        v.autopilot.modes.guided.pos = pos
        set_yaw(v.autopilot, yaw)
    return code


@law
def set_velocity(v: Vehicle, vel: Vec3, acc: Vec3, yaw: YawSetpoint) -> int:
    """Fly a velocity [m/s] that changes with an acceleration [m/s^2], NED."""
    code = refusal(v, is_usable_vector(vel) and is_usable_vector(acc), yaw)
    if code == OK:
        begin(v, VELOCITY_ACCEL)
        v.autopilot.modes.guided.vel = vel
        v.autopilot.modes.guided.acc = acc
        set_yaw(v.autopilot, yaw)
    return code


@law
def set_accel(v: Vehicle, acc: Vec3, yaw: YawSetpoint) -> int:
    """Fly an acceleration, NED [m/s^2]."""
    code = refusal(v, is_usable_vector(acc), yaw)
    if code == OK:
        begin(v, ACCEL)
        v.autopilot.modes.guided.acc = acc
        set_yaw(v.autopilot, yaw)
    return code


@law
def set_pos_vel_accel(v: Vehicle, pos: Vec3, vel: Vec3, acc: Vec3, yaw: YawSetpoint) -> int:
    """Follow a point (NED [m]) that moves with a velocity [m/s] and an acceleration [m/s^2]."""
    code = refusal(v, is_usable_vector(pos) and is_usable_vector(vel) and is_usable_vector(acc), yaw)
    if code == OK:
        begin(v, POS_VEL_ACCEL)
        target = v.autopilot.modes.guided
        target.pos = pos
        target.vel = vel
        target.acc = acc
        set_yaw(v.autopilot, yaw)
    return code


@law
def set_attitude(v: Vehicle, use_attitude: bool, q: Quat, rates: Vec3, thrust: float) -> int:
    """Fly an attitude (body to NED) turning with body rates [rad/s], or the rates alone.

    ``thrust`` 0 .. 1 is a climb rate around 0.5 (0: WPNAV_SPEED_DN down, 1: WPNAV_SPEED_UP up), or with
    GUID_OPTIONS bit 8 the thrust.
    """
    ap = v.autopilot
    code = refusal(v, is_usable_vector(rates) and is_usable(thrust), NO_YAW)
    size = math.sqrt(quat_norm_squared(q)) if use_attitude else 1.0
    if code == OK and not 0.5 <= size <= 2.0:
        code = OUT_OF_RANGE if size == size else NOT_FINITE
    if code != OK:
        return code
    begin(v, ANGLE)
    target = ap.modes.guided
    target.use_attitude = use_attitude
    if use_attitude:
        target.q = q / size
    target.rates = rates
    target.thrust = constrain(thrust, 0.0, 1.0)
    target.use_thrust = (int(ap.params.GUID.OPTIONS) & _THRUST_IS_THRUST) != 0
    target.climb_rate = climb_of_thrust(target.thrust, ap.control.pos_d)
    return code


@law
def climb_of_thrust(thrust: float, limits: AltitudeState) -> float:
    """Climb rate [m/s] that ``thrust`` 0 .. 1 stands for: 0.5 none."""
    return (thrust - 0.5) * 2.0 * (limits.speed_up if thrust >= 0.5 else limits.speed_down)


@law
def stop(v: Vehicle) -> int:
    """Come to a stop and hold (velocity zero)."""
    return set_velocity(v, ZERO, ZERO, NO_YAW)
