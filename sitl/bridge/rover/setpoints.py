# SPDX-License-Identifier: BSD-3-Clause
"""What the rover makes of set-points: a place to drive to, or a heading or turn rate with a speed.

Rules of ArduRover (https://ardupilot.org/dev/docs/mavlink-rover-commands.html). A position is taken first; else a
velocity becomes the heading of its direction and a speed up to WP_SPEED. With a yaw beside it the velocity gives the
speed alone, backward when its x is negative in whatever frame it came; so with a yaw rate. Yaw or yaw rate without
velocity turn on the spot (which a car cannot). Both at once, or nothing, is ignored, and so is an unknown frame. A
number that is not finite stops the vehicle.
"""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Any, cast

from ...autopilot.mission.item import MissionItem
from ...core.algebra import euler_of
from ...core.vectors import Quat
from ..autopilot_api import Vector
from ..channel import Channel
from ..services.command import GLOBAL, GLOBAL_FRAMES
from ..services.service import INFO, Sender
from ..services.setpoints import (
    BODY_YAW_RATE_IGNORED,
    THRUST_IGNORED,
    YAW_IGNORED,
    YAW_RATE_IGNORED,
    SetpointService,
)
from ..services.statustext import StatusTextService

if TYPE_CHECKING:
    from .autopilot import RoverAutopilot


class RoverSetpoints(SetpointService):
    """Set-points for GUIDED, and mission items with ``current`` 2 or 3."""

    def __init__(self, bridge: Any) -> None:
        super().__init__(bridge)
        self._rover = cast("RoverAutopilot", bridge.autopilot)
        self._origin_set = bridge.reader.field("autopilot.estimate.origin_set")
        self._wp_speed = bridge.reader.field("autopilot.params.WP.SPEED")

    def _listens(self) -> bool:
        return self._mode() == self._guided or self._rover.is_guided_in_auto()

    def _unknown_frame(self) -> None:
        pass

    def _local(self, channel: Channel, m: Any, sender: Sender) -> None:
        if self._origin_set():
            super()._local(channel, m, sender)

    def _global(self, channel: Channel, m: Any, sender: Sender) -> None:
        if m.coordinate_frame in GLOBAL_FRAMES:
            super()._global(channel, m, sender)

    def _place(self, m: Any) -> Vector | None:
        return self.bridge.places.ned(m.lat_int, m.lon_int, 0.0, GLOBAL)

    def _set(self, m: Any, pos: Vector | None, vel: Vector | None, acc: Vector | None, body: bool) -> None:
        rover, mask = self._rover, m.type_mask
        if acc is not None:
            say = self.bridge.get(StatusTextService).say
            say(INFO, f"Ignoring {type(m).__name__}; set ACC_IGNORE in mask")
            return
        yaw = None if mask & YAW_IGNORED else m.yaw
        rate = None if mask & YAW_RATE_IGNORED else m.yaw_rate
        used = (yaw or 0.0) + (rate or 0.0)
        for vector in (pos, vel):
            if vector is not None:
                used += vector[0] + vector[1]
        if not math.isfinite(used):
            rover.guided_stop()
        elif pos is not None:
            rover.guided_position(pos, None)
        elif rate is not None:
            if yaw is None:
                rover.guided_turn_rate(rate, self._speed(vel, m.vx < 0.0))
        elif yaw is not None:
            heading = yaw + self._pose()[2] if body else yaw
            rover.guided_heading(heading, self._speed(vel, m.vx < 0.0))
        elif vel is not None:
            rover.guided_heading(math.atan2(vel[1], vel[0]), self._speed(vel, False))

    def _speed(self, vel: Vector | None, backward: bool) -> float:
        """Speed [m/s] of a velocity, within WP_SPEED; 0 without one."""
        if vel is None:
            return 0.0
        speed, fastest = math.hypot(vel[0], vel[1]), self._fastest()
        if speed > fastest:
            speed = fastest
        return -speed if backward else speed

    def _fastest(self) -> float:
        """Speed [m/s] that stands for full speed."""
        return max(float(self._wp_speed()), 0.0)

    def _attitude(self, channel: Channel, m: Any, sender: Sender) -> None:
        """Thrust -1 .. 1 is a share of WP_SPEED; the heading is that of the quaternion, or turns with body_yaw_rate."""
        if not self._listens() or m.type_mask & THRUST_IGNORED or not math.isfinite(m.thrust):
            return
        speed = min(max(m.thrust, -1.0), 1.0) * self._fastest()
        if not m.type_mask & BODY_YAW_RATE_IGNORED:
            if math.isfinite(m.body_yaw_rate):
                self._rover.guided_turn_rate(m.body_yaw_rate, speed)
            return
        norm = math.sqrt(sum(x * x for x in m.q))
        if math.isfinite(norm) and norm > 1e-3:
            w, x, y, z = (value / norm for value in m.q)
            self._rover.guided_heading(euler_of(Quat(w, x, y, z))[2], speed)

    def _height_target(self, item: MissionItem) -> bool:
        """Taken, and nothing to do: a rover has one height."""
        return True
