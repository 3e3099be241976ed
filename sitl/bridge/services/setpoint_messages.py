# SPDX-License-Identifier: BSD-3-Clause
"""Set-points for GUIDED.

Positions, velocities, accelerations, attitudes (https://mavlink.io/en/services/offboard_control.html).

They are not acknowledged. In another mode than GUIDED they are ignored. Here they become north, east, down; what is
made of each kind is the firmware's (``copter/setpoints.py``, ``rover/setpoints.py``).
"""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import NamedTuple

from ...autopilot.mission.item import MissionItem
from ...autopilot.state import Estimate
from ...core.algebra import IDENTITY, ZERO, horizontal, quat_norm_squared, turned, with_down
from ...core.kernels import law
from ...core.mavlink import MavFrame
from ...core.records import Floats
from ...core.vectors import Quat, Vec3
from ..host import Host
from ..locations import GLOBAL_FRAMES
from ..wire.message import Message, consecutive
from .service import Service

POSITION_IGNORED, VELOCITY_IGNORED, ACCELERATION_IGNORED = 0x007, 0x038, 0x1C0
FORCE, YAW_IGNORED, YAW_RATE_IGNORED = 0x200, 0x400, 0x800
YAWS_IGNORED = YAW_IGNORED | YAW_RATE_IGNORED
"""POSITION_TARGET_TYPEMASK"""
LOCAL_FRAMES = (MavFrame.LOCAL_NED, MavFrame.LOCAL_OFFSET_NED, MavFrame.BODY_NED, MavFrame.BODY_OFFSET_NED)
BODY_FRAMES = (MavFrame.BODY_NED, MavFrame.BODY_OFFSET_NED)

ROLL_RATE_IGNORED, PITCH_RATE_IGNORED, BODY_YAW_RATE_IGNORED = 0x01, 0x02, 0x04
THRUST_IGNORED, ATTITUDE_IGNORED = 0x40, 0x80
"""ATTITUDE_TARGET_TYPEMASK"""

SMALLEST_NORM = 1e-3
"""Of a quaternion that is taken for a rotation."""


class SetPositionTargetLocalNed(Message, name="SET_POSITION_TARGET_LOCAL_NED"):
    """Position [m], velocity [m/s], acceleration [m/s^2] in a local frame, yaw [rad], yaw rate [rad/s]."""

    target_system: int
    coordinate_frame: int
    type_mask: int
    pos: Vec3 = consecutive("x", "y", "z")
    vel: Vec3 = consecutive("vx", "vy", "vz")
    acc: Vec3 = consecutive("afx", "afy", "afz")
    yaw: float
    yaw_rate: float


class SetPositionTargetGlobalInt(Message, name="SET_POSITION_TARGET_GLOBAL_INT"):
    """The same with the position on the globe [degE7, m]; velocity and acceleration are north, east, down."""

    coordinate_frame: int
    type_mask: int
    lat_int: int
    lon_int: int
    alt: float
    vel: Vec3 = consecutive("vx", "vy", "vz")
    acc: Vec3 = consecutive("afx", "afy", "afz")
    yaw: float
    yaw_rate: float


class SetAttitudeTarget(Message, name="SET_ATTITUDE_TARGET"):
    """Attitude (body to NED), body rates [rad/s], thrust."""

    target_system: int
    type_mask: int
    q: Floats
    rates: Vec3 = consecutive("body_roll_rate", "body_pitch_rate", "body_yaw_rate")
    thrust: float


class Target(NamedTuple):
    """What a message's mask does not ignore, north, east, down; the rest is zero. Any number may be NaN or infinite."""

    use_pos: bool
    pos: Vec3  # from the origin [m]
    use_vel: bool
    vel: Vec3  # [m/s]
    use_acc: bool
    acc: Vec3  # [m/s^2]
    use_yaw: bool
    yaw: float  # [rad]
    use_yaw_rate: bool
    yaw_rate: float  # [rad/s]
    relative_yaw: bool  # the yaw counts from the vehicle's


class Rotation(NamedTuple):
    """A quaternion of a message."""

    is_given: bool  # False: its numbers are none of a rotation
    q: Quat  # of length 1


@law
def to_ned(vector: Vec3, frame: int, yaw: float) -> Vec3:
    """A vector of a local frame as north, east, down; ``yaw`` [rad] of the vehicle."""
    if frame in BODY_FRAMES:
        return with_down(turned(horizontal(vector), yaw), vector.z)
    return vector


@law
def local_target(m: SetPositionTargetLocalNed, estimate: Estimate) -> Target:
    """The target of a message whose frame is one of ``LOCAL_FRAMES``."""
    frame, yaw = m.coordinate_frame, estimate.yaw
    pos = to_ned(m.pos, frame, yaw)
    if frame != MavFrame.LOCAL_NED:
        pos = pos + estimate.pos
    vel = to_ned(m.vel, frame, yaw)
    acc = to_ned(m.acc, frame, yaw)
    return masked(m.type_mask, pos, vel, acc, m.yaw, m.yaw_rate, frame in BODY_FRAMES)


@law
def global_target(m: SetPositionTargetGlobalInt, pos: Vec3) -> Target:
    """The target of a message whose location on the globe is ``pos`` (NED from the origin [m])."""
    return masked(m.type_mask, pos, m.vel, m.acc, m.yaw, m.yaw_rate, False)


@law
def masked(mask: int, pos: Vec3, vel: Vec3, acc: Vec3, yaw: float, yaw_rate: float, relative: bool) -> Target:
    """A target without what the mask ignores; one ignored component of a vector ignores all of it."""
    use_pos, use_vel = (mask & POSITION_IGNORED) == 0, (mask & VELOCITY_IGNORED) == 0
    use_acc = (mask & ACCELERATION_IGNORED) == 0
    use_yaw, use_yaw_rate = (mask & YAW_IGNORED) == 0, (mask & YAW_RATE_IGNORED) == 0
    return Target(
        use_pos, pos if use_pos else ZERO,
        use_vel, vel if use_vel else ZERO,
        use_acc, acc if use_acc else ZERO,
        use_yaw, yaw if use_yaw else 0.0,
        use_yaw_rate, yaw_rate if use_yaw_rate else 0.0,
        relative,
    )  # fmt: skip


@law
def rotation(numbers: Floats) -> Rotation:
    """The rotation that four numbers (w, x, y, z) of a message stand for."""
    q = Quat(float(numbers[0]), float(numbers[1]), float(numbers[2]), float(numbers[3]))
    norm = math.sqrt(quat_norm_squared(q))
    if not SMALLEST_NORM < norm < math.inf:  # NaN, too
        return Rotation(False, IDENTITY)
    return Rotation(True, q / norm)


class SetpointService(Service):
    """Mission items with ``current`` 2: locations to go to at once, in GUIDED."""

    def __init__(self, bridge: Host) -> None:
        super().__init__(bridge)
        self._mode: Callable[[], int] = bridge.reader.field("autopilot.modes.number")
        self._guided: int = bridge.profile.guided

    def _listens(self) -> bool:
        """Whether set-points count now."""
        return self._mode() == self._guided

    def mission_item_target(self, item: MissionItem) -> bool:
        """Go to a mission item's location (``current`` = 2), in GUIDED."""
        if not self._listens() or item.frame not in GLOBAL_FRAMES:
            return False
        position = self.bridge.locations.ned(item.x, item.y, item.z, item.frame)
        return position is not None and self.bridge.autopilot.guided_position(position)
