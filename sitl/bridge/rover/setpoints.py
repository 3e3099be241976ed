# SPDX-License-Identifier: BSD-3-Clause
"""What the rover makes of set-points: a location to drive to, or a heading or turn rate with a speed.

Rules of ArduRover (https://ardupilot.org/dev/docs/mavlink-rover-commands.html). A position is taken first; else a
velocity becomes the heading of its direction and a speed up to WP_SPEED. With a yaw beside it the velocity gives the
speed alone, backward when its x is negative in whatever frame it came; so with a yaw rate. Yaw or yaw rate without
velocity turn on the spot (which a car cannot). Both at once, or nothing, is ignored, and so is an unknown frame. A
number that is not finite stops the vehicle.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, cast

from ...autopilot.events import emit
from ...autopilot.rover.modes.guided_setpoints import (
    SETPOINT_IGNORED,
    is_open,
    set_heading_and_speed,
    set_position,
    set_turn_rate_and_speed,
    stop,
)
from ...core.algebra import euler_of, horizontal
from ...core.elementary import atan2, hypot
from ...core.kernels import law
from ...core.mavlink import MavFrame
from ...core.scalars import constrain, finite
from ...core.vectors import Vec3
from ...vehicle.rover import Rover
from ..locations import GLOBAL_FRAMES, local_position
from ..services import setpoint_messages
from ..services.follow_target import take_position
from ..telemetry.motion import GlobalPositionInt

if TYPE_CHECKING:
    from .autopilot import RoverAutopilot

LOCAL_NUMBER, GLOBAL_NUMBER = (
    setpoint_messages.SetPositionTargetLocalNed.kind.id,
    setpoint_messages.SetPositionTargetGlobalInt.kind.id,
)


@law
def position_target_local(m: setpoint_messages.SetPositionTargetLocalNed, v: Rover, sender: int) -> None:
    """Drive to a location or with a velocity in a local frame."""
    estimate = v.autopilot.estimate
    if estimate.origin_set and is_open(v.autopilot.modes) and m.coordinate_frame in setpoint_messages.LOCAL_FRAMES:
        follow(v, setpoint_messages.local_target(m, estimate), m.vel.x < 0.0, LOCAL_NUMBER)


@law
def position_target_global(m: setpoint_messages.SetPositionTargetGlobalInt, v: Rover, sender: int) -> None:
    """The same with a location on the globe, whose height means nothing."""
    if m.coordinate_frame not in GLOBAL_FRAMES or not is_open(v.autopilot.modes):
        return
    position = local_position(v.autopilot, m.lat_int, m.lon_int, 0.0, MavFrame.GLOBAL)
    if position.is_known or (m.type_mask & setpoint_messages.POSITION_IGNORED) != 0:
        follow(v, setpoint_messages.global_target(m, position.pos), m.vel.x < 0.0, GLOBAL_NUMBER)


@law
def other_position(m: GlobalPositionInt, v: Rover, sender: int) -> None:
    """Where another vehicle is, for FOLLOW."""
    take_position(m, v, sender, False)


@law
def follow(v: Rover, target: setpoint_messages.Target, backward: bool, message: int) -> None:
    """Drive what a target asks for.

    Args:
        v: the vehicle.
        target: what is asked for.
        backward: the velocity is backward where only the speed of it counts.
        message: number of the message.
    """
    modes = v.autopilot.modes
    if target.use_acc:
        emit(v.autopilot.events, v.time_us, SETPOINT_IGNORED, float(message), 0.0)
        return
    speed = speed_of(v, target.vel)
    if not is_finite(target):
        stop(modes)
    elif target.use_pos:
        set_position(v, horizontal(target.pos))
    elif target.use_yaw_rate:
        if not target.use_yaw:
            set_turn_rate_and_speed(modes, v.time_us, target.yaw_rate, -speed if target.use_vel and backward else speed)
    elif target.use_yaw:
        heading = target.yaw + v.autopilot.estimate.yaw if target.relative_yaw else target.yaw
        set_heading_and_speed(modes, v.time_us, heading, -speed if target.use_vel and backward else speed)
    elif target.use_vel:
        set_heading_and_speed(modes, v.time_us, atan2(target.vel.y, target.vel.x), speed)


@law
def is_finite(target: setpoint_messages.Target) -> bool:
    """Whether all numbers that are asked for are; down does not count."""
    numbers = target.pos + target.vel
    return finite(target.yaw + target.yaw_rate + numbers.x + numbers.y)


@law
def speed_of(v: Rover, vel: Vec3) -> float:
    """Speed [m/s] of a velocity, within WP_SPEED."""
    speed, fastest = hypot(vel.x, vel.y), full_speed(v)
    return fastest if speed > fastest else speed


@law
def full_speed(v: Rover) -> float:
    """Speed [m/s] that stands for full speed."""
    speed = v.autopilot.params.WP.SPEED
    return 0.0 if speed < 0.0 else speed


@law
def attitude_target(m: setpoint_messages.SetAttitudeTarget, v: Rover, sender: int) -> None:
    """Thrust -1 .. 1 is a share of WP_SPEED; the heading is that of the quaternion, or turns with body_yaw_rate."""
    modes = v.autopilot.modes
    if not is_open(modes) or (m.type_mask & setpoint_messages.THRUST_IGNORED) != 0 or not finite(m.thrust):
        return
    speed = constrain(m.thrust, -1.0, 1.0) * full_speed(v)
    if (m.type_mask & setpoint_messages.BODY_YAW_RATE_IGNORED) == 0:
        if finite(m.rates.z):
            set_turn_rate_and_speed(modes, v.time_us, m.rates.z, speed)
        return
    given = setpoint_messages.rotation(m.q)
    if given.is_given:
        set_heading_and_speed(modes, v.time_us, euler_of(given.q).yaw, speed)


class RoverSetpoints(setpoint_messages.SetpointService):
    """Mission items with ``current`` 2; in missions that allow set-points, too."""

    def _listens(self) -> bool:
        return super()._listens() or cast("RoverAutopilot", self.bridge.autopilot).is_guided_in_auto()
