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
from ...autopilot.copter.terrain import is_flat
from ...core.algebra import IDENTITY
from ...core.kernels import law
from ...core.scalars import finite
from ...core.vectors import Vec3
from ...vehicle.copter import Copter
from ..places import LocalPlace, local_place
from ..services.command import FRAMES_TERRAIN, GLOBAL_FRAMES
from ..services.follow import take_position
from ..services.setpoints import (
    ATTITUDE_IGNORED,
    BODY_YAW_RATE_IGNORED,
    FORCE,
    LOCAL_FRAMES,
    PITCH_RATE_IGNORED,
    POSITION_IGNORED,
    ROLL_RATE_IGNORED,
    THRUST_IGNORED,
    SetAttitudeTarget,
    SetPositionTargetGlobalInt,
    SetPositionTargetLocalNed,
    Target,
    global_target,
    local_target,
    rotation,
)
from ..telemetry.motion import GlobalPositionInt

OVER_HOME = 1
"""FOLL_ALT_TYPE"""


@law
def position_target_local(m: SetPositionTargetLocalNed, v: Copter, sender: int) -> None:
    """Fly to a place, with a velocity or an acceleration, in a local frame."""
    if not is_guided(v.autopilot.modes):
        return
    if m.coordinate_frame not in LOCAL_FRAMES:
        stop(v)
        return
    follow(v, local_target(m, v.autopilot.estimate), (m.type_mask & FORCE) != 0)


@law
def position_target_global(m: SetPositionTargetGlobalInt, v: Copter, sender: int) -> None:
    """The same with a place on the globe; one that is not there is ignored."""
    if not is_guided(v.autopilot.modes):
        return
    frame, use_pos = m.coordinate_frame, (m.type_mask & POSITION_IGNORED) == 0
    if use_pos and not (frame in GLOBAL_FRAMES and finite(m.alt)):
        stop(v)
        return
    place = local_place(v.autopilot, m.lat_int, m.lon_int, m.alt, frame)
    if use_pos and frame in FRAMES_TERRAIN and not is_flat(v):
        follow_over_ground(v, m, place)
    elif place.is_known or not use_pos:
        follow(v, global_target(m, place.pos), (m.type_mask & FORCE) != 0)


@law
def follow_over_ground(v: Copter, m: SetPositionTargetGlobalInt, place: LocalPlace) -> None:
    """Fly to a place at a height above the ground; with a velocity that is nothing that can be flown."""
    target = global_target(m, Vec3(place.pos.x, place.pos.y, -m.alt))
    if target.use_vel or target.use_acc or not is_finite(target):
        stop(v)
    elif place.is_known:
        set_position_over_ground(v, target.pos, yaw_of(target))


@law
def yaw_of(target: Target) -> YawSetpoint:
    """The heading that a target asks for."""
    if target.use_yaw or target.use_yaw_rate:
        return YawSetpoint(target.use_yaw, target.yaw, target.use_yaw_rate, target.yaw_rate, target.relative_yaw)
    return NO_YAW


@law
def follow(v: Copter, target: Target, is_force: bool) -> None:
    """Fly what a target asks for; ``is_force``: its acceleration is a force, which is left alone."""
    if is_force and target.use_acc:
        return
    yaw = yaw_of(target)
    if not is_finite(target):
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
def is_finite(target: Target) -> bool:
    """Whether all numbers that are asked for are."""
    numbers = target.pos + target.vel + target.acc
    return finite(numbers.x + numbers.y + numbers.z + target.yaw + target.yaw_rate)


@law
def attitude_target(m: SetAttitudeTarget, v: Copter, sender: int) -> None:
    """Fly an attitude, or body rates."""
    mask = m.type_mask
    if not takes_attitudes(v.autopilot.modes) or (mask & THRUST_IGNORED) != 0:
        return
    rates = Vec3(
        0.0 if (mask & ROLL_RATE_IGNORED) != 0 else m.body_roll_rate,
        0.0 if (mask & PITCH_RATE_IGNORED) != 0 else m.body_pitch_rate,
        0.0 if (mask & BODY_YAW_RATE_IGNORED) != 0 else m.body_yaw_rate,
    )
    use_attitude = (mask & ATTITUDE_IGNORED) == 0
    given = rotation(m.q)
    if use_attitude and not given.is_given:
        return
    if finite(rates.x + rates.y + rates.z + m.thrust):
        set_attitude(v, use_attitude, given.q if use_attitude else IDENTITY, rates, m.thrust)


@law
def other_position(m: GlobalPositionInt, v: Copter, sender: int) -> None:
    """Where another vehicle is, for FOLLOW."""
    take_position(m, v, sender, v.autopilot.params.FOLL.ALT_TYPE == OVER_HOME)
