# SPDX-License-Identifier: BSD-3-Clause
"""What the copter makes of set-points.

A combination, frame or number that cannot be flown stops the vehicle where it is, as ArduCopter does.
"""

from __future__ import annotations

from ...autopilot.copter.modes.auto import is_guided
from ...autopilot.copter.modes.guided_setpoints import (
    NO_YAW,
    YawSetpoint,
    set_accel,
    set_attitude,
    set_pos_vel_accel,
    set_position,
    set_position_over_ground,
    set_velocity,
    stop,
    takes_attitudes,
)
from ...autopilot.copter.terrain_following import is_flat
from ...core.algebra import IDENTITY, ZERO, quat_norm_squared
from ...core.kernels import law
from ...core.records import Floats
from ...core.scalars import finite
from ...core.vectors import Quat, Vec3
from ...vehicle.copter import Copter
from ..locations import FRAMES_TERRAIN, GLOBAL_FRAMES, LocalPosition, local_position
from ..services import setpoint_messages
from ..services.follow_target import take_position
from ..telemetry.motion import GlobalPositionInt

OVER_HOME = 1
"""FOLL_ALT_TYPE"""
FASTEST = 1000.0
"""[m/s], of any component."""
RATES_IGNORED = (
    setpoint_messages.ROLL_RATE_IGNORED | setpoint_messages.PITCH_RATE_IGNORED | setpoint_messages.BODY_YAW_RATE_IGNORED
)
UNIT = 1e-3
"""The square of a quaternion's length is within this of 1."""


@law
def position_target_local(m: setpoint_messages.SetPositionTargetLocalNed, v: Copter, sender: int) -> None:
    """Fly to a location, with a velocity or an acceleration, in a local frame."""
    if not is_guided(v.autopilot.modes):
        return
    if m.coordinate_frame not in setpoint_messages.LOCAL_FRAMES:
        stop(v)
        return
    follow(v, setpoint_messages.local_target(m, v.autopilot.estimate), (m.type_mask & setpoint_messages.FORCE) != 0)


@law
def position_target_global(m: setpoint_messages.SetPositionTargetGlobalInt, v: Copter, sender: int) -> None:
    """The same with a location on the globe; before there is an origin it is ignored."""
    if not is_guided(v.autopilot.modes):
        return
    frame, use_pos = m.coordinate_frame, (m.type_mask & setpoint_messages.POSITION_IGNORED) == 0
    if use_pos and not (frame in GLOBAL_FRAMES and finite(m.alt) and is_location(m.lat_int, m.lon_int)):
        stop(v)
        return
    position = local_position(v.autopilot, m.lat_int, m.lon_int, m.alt, frame)
    if use_pos and frame in FRAMES_TERRAIN and not is_flat(v):
        follow_over_ground(v, m, position)
    elif position.is_known or not use_pos:
        follow(v, setpoint_messages.global_target(m, position.pos), (m.type_mask & setpoint_messages.FORCE) != 0)


@law
def follow_over_ground(v: Copter, m: setpoint_messages.SetPositionTargetGlobalInt, position: LocalPosition) -> None:
    """Fly to a location at a height above the ground; with a velocity that is nothing that can be flown."""
    target = setpoint_messages.global_target(m, Vec3(position.pos.x, position.pos.y, -m.alt))
    if target.use_vel or target.use_acc or not is_finite(target):
        stop(v)
    elif position.is_known:
        set_position_over_ground(v, target.pos, yaw_of(target))


@law
def yaw_of(target: setpoint_messages.Target) -> YawSetpoint:
    """The heading that a target asks for."""
    if target.use_yaw or target.use_yaw_rate:
        return YawSetpoint(target.use_yaw, target.yaw, target.use_yaw_rate, target.yaw_rate, target.relative_yaw)
    return NO_YAW


@law
def follow(v: Copter, target: setpoint_messages.Target, is_force: bool) -> None:
    """Fly what a target asks for; ``is_force``: its acceleration is a force, which cannot be flown."""
    yaw = yaw_of(target)
    if not is_finite(target) or (is_force and target.use_acc) or is_absurd(target.vel):
        stop(v)
    elif target.use_vel and target.use_pos:
        set_pos_vel_accel(v, target.pos, target.vel, target.acc, yaw)
    elif target.use_vel:
        set_velocity(v, target.vel, target.acc, yaw)
    elif target.use_acc and not target.use_pos:
        set_accel(v, target.acc, yaw)
    elif target.use_pos and not target.use_acc:
        set_position(v, target.pos, yaw)
    else:
        stop(v)


@law
def is_finite(target: setpoint_messages.Target) -> bool:
    """Whether all numbers that are asked for are."""
    numbers = target.pos + target.vel + target.acc
    return finite(numbers.x + numbers.y + numbers.z + target.yaw + target.yaw_rate)


@law
def is_absurd(vel: Vec3) -> bool:
    """Whether a velocity is faster than ArduCopter takes."""
    return max(abs(vel.x), abs(vel.y), abs(vel.z)) > FASTEST


@law
def is_location(lat: int, lon: int) -> bool:
    """Whether there is such a latitude and longitude [degE7]."""
    return abs(lat) <= 900_000_000 and abs(lon) <= 1_800_000_000


@law
def attitude_target(m: setpoint_messages.SetAttitudeTarget, v: Copter, sender: int) -> None:
    """Fly an attitude, which turns on with the body rates, or body rates alone. Rates are all given or all ignored."""
    if not takes_attitudes(v.autopilot.modes):
        return
    mask, use_attitude = m.type_mask, (m.type_mask & setpoint_messages.ATTITUDE_IGNORED) == 0
    ignored, given = mask & RATES_IGNORED, setpoint_messages.rotation(m.q)
    rates = m.rates if ignored == 0 else ZERO
    if (
        (mask & setpoint_messages.THRUST_IGNORED) != 0
        or (ignored != 0 and ignored != RATES_IGNORED)
        or (use_attitude and not is_unit(m.q))
        or not finite(rates.x + rates.y + rates.z + m.thrust)
    ):
        stop(v)
    else:
        set_attitude(v, use_attitude, given.q if use_attitude else IDENTITY, rates, m.thrust)


@law
def is_unit(numbers: Floats) -> bool:
    """Whether a message's quaternion has length 1, as exactly as ArduCopter asks for."""
    q = Quat(float(numbers[0]), float(numbers[1]), float(numbers[2]), float(numbers[3]))
    return abs(quat_norm_squared(q) - 1.0) < UNIT


@law
def other_position(m: GlobalPositionInt, v: Copter, sender: int) -> None:
    """Where another vehicle is, for FOLLOW."""
    take_position(m, v, sender, v.autopilot.params.FOLL.ALT_TYPE == OVER_HOME)
