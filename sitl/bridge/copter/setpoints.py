# SPDX-License-Identifier: BSD-3-Clause
"""What the copter makes of set-points.

A combination, frame or number that cannot be flown stops the vehicle where it is, as ArduCopter does.
"""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Any, cast

from ...autopilot.mission.item import MissionItem
from ..autopilot_api import NO_YAW, Vector, Yaw
from ..channel import Channel
from ..services.command import GLOBAL_FRAMES
from ..services.service import Sender
from ..services.setpoints import (
    ATTITUDE_IGNORED,
    BODY_YAW_RATE_IGNORED,
    FORCE,
    PITCH_RATE_IGNORED,
    ROLL_RATE_IGNORED,
    THRUST_IGNORED,
    YAW_IGNORED,
    YAW_RATE_IGNORED,
    YAWS_IGNORED,
    SetpointService,
)

if TYPE_CHECKING:
    from .autopilot import CopterAutopilot

ZERO: Vector = (0.0, 0.0, 0.0)


class CopterSetpoints(SetpointService):
    """Set-points for GUIDED, and mission items with ``current`` 2 or 3."""

    def __init__(self, bridge: Any) -> None:
        super().__init__(bridge)
        self._copter = cast("CopterAutopilot", bridge.autopilot)

    def _unknown_frame(self) -> None:
        self.bridge.autopilot.guided_stop()

    def _place(self, m: Any) -> Vector | None:
        if m.coordinate_frame not in GLOBAL_FRAMES or not math.isfinite(m.alt):
            self.bridge.autopilot.guided_stop()
            return None
        return self.bridge.places.ned(m.lat_int, m.lon_int, m.alt, m.coordinate_frame)

    def _set(self, m: Any, pos: Vector | None, vel: Vector | None, acc: Vector | None, body: bool) -> None:
        autopilot, mask = self._copter, m.type_mask
        yaw = NO_YAW
        if mask & YAWS_IGNORED != YAWS_IGNORED:
            yaw = Yaw(not mask & YAW_IGNORED, m.yaw, not mask & YAW_RATE_IGNORED, m.yaw_rate, body)
        total = (yaw.yaw if yaw.use_yaw else 0.0) + (yaw.rate if yaw.use_rate else 0.0)
        for vector in (pos, vel, acc):
            if vector is not None:
                total += vector[0] + vector[1] + vector[2]
        if mask & FORCE and acc is not None:
            return  # a force is not an acceleration
        if not math.isfinite(total):
            autopilot.guided_stop()
        elif vel is not None:
            if pos is not None:
                autopilot.guided_position_velocity(pos, vel, acc or ZERO, yaw)
            else:
                autopilot.guided_velocity(vel, acc or ZERO, yaw)
        elif acc is not None:
            if pos is None:
                autopilot.guided_acceleration(acc, yaw)
            else:
                autopilot.guided_stop()
        elif pos is not None:
            autopilot.guided_position(pos, yaw)
        else:
            autopilot.guided_stop()

    def _attitude(self, channel: Channel, m: Any, sender: Sender) -> None:
        mask = m.type_mask
        if not self._listens() or mask & THRUST_IGNORED:
            return
        rates = (
            0.0 if mask & ROLL_RATE_IGNORED else m.body_roll_rate,
            0.0 if mask & PITCH_RATE_IGNORED else m.body_pitch_rate,
            0.0 if mask & BODY_YAW_RATE_IGNORED else m.body_yaw_rate,
        )
        q: tuple[float, ...] | None = None
        if not mask & ATTITUDE_IGNORED:
            norm = math.sqrt(sum(x * x for x in m.q))
            if not (math.isfinite(norm) and norm > 1e-3):
                return  # not a rotation
            q = tuple(x / norm for x in m.q)
        if math.isfinite(sum(rates) + m.thrust):
            self._copter.guided_attitude(q, rates, m.thrust)

    def _height_target(self, item: MissionItem) -> bool:
        _, _, _, n, e, _ = self._pose()
        place = self.bridge.places.over_origin(n, e, self._height(item))
        return place is not None and self.bridge.autopilot.guided_position(place, None)
