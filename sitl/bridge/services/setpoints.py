# SPDX-License-Identifier: BSD-3-Clause
"""Set-points for GUIDED.

Positions, velocities, accelerations, attitudes (https://mavlink.io/en/services/offboard_control.html).

They are not acknowledged. In another mode than GUIDED they are ignored; a combination, frame or number that
cannot be flown stops the vehicle where it is, as ArduCopter does.
"""

from __future__ import annotations

import math
from typing import Any

from ...autopilot.mission.item import MissionItem
from ..autopilot_api import NO_YAW, Vector, Yaw
from ..channel import Channel
from .command import FRAMES_AMSL, GLOBAL_FRAMES
from .service import Handler, Sender, Service

POSITION_IGNORED, VELOCITY_IGNORED, ACCELERATION_IGNORED = 0x007, 0x038, 0x1C0
FORCE, YAW_IGNORED, YAW_RATE_IGNORED = 0x200, 0x400, 0x800
YAWS_IGNORED = YAW_IGNORED | YAW_RATE_IGNORED
LOCAL_NED, LOCAL_OFFSET_NED, BODY_NED, BODY_OFFSET_NED = 1, 7, 8, 9
BODY_FRAMES = (BODY_NED, BODY_OFFSET_NED)

ROLL_RATE_IGNORED, PITCH_RATE_IGNORED, BODY_YAW_RATE_IGNORED = 0x01, 0x02, 0x04
THRUST_IGNORED, ATTITUDE_IGNORED = 0x40, 0x80

GUIDED_MODE = 4
E_ = "autopilot.estimate."
ZERO: Vector = (0.0, 0.0, 0.0)


class SetpointService(Service):
    """Set-points for GUIDED, and mission items with ``current`` 2 or 3."""

    def __init__(self, bridge: Any) -> None:
        super().__init__(bridge)
        self._mode = bridge.reader.field("autopilot.modes.number")
        self._pose = bridge.reader.fields(E_ + "euler", E_ + "pos")

    def handlers(self) -> dict[str, Handler]:
        return {
            "SET_POSITION_TARGET_LOCAL_NED": self._local,
            "SET_POSITION_TARGET_GLOBAL_INT": self._global,
            "SET_ATTITUDE_TARGET": self._attitude,
        }

    # ------------------------------------------------------------------ position, velocity, acceleration

    def _local(self, channel: Channel, m: Any, sender: Sender) -> None:
        if self._mode() != GUIDED_MODE:
            return
        mask, frame = m.type_mask, m.coordinate_frame
        if frame not in (LOCAL_NED, LOCAL_OFFSET_NED, BODY_NED, BODY_OFFSET_NED):
            self.bridge.autopilot.guided_stop()
            return
        pos = None if mask & POSITION_IGNORED else (m.x, m.y, m.z)
        vel = None if mask & VELOCITY_IGNORED else (m.vx, m.vy, m.vz)
        acc = None if mask & ACCELERATION_IGNORED else (m.afx, m.afy, m.afz)
        if frame != LOCAL_NED:
            _, _, yaw, n, e, d = self._pose()
            if frame in BODY_FRAMES:
                c, s = math.cos(yaw), math.sin(yaw)
                pos, vel, acc = _turn(pos, c, s), _turn(vel, c, s), _turn(acc, c, s)
            if pos is not None:
                pos = (pos[0] + n, pos[1] + e, pos[2] + d)
        self._set(m, pos, vel, acc, frame in BODY_FRAMES)

    def _global(self, channel: Channel, m: Any, sender: Sender) -> None:
        if self._mode() != GUIDED_MODE:
            return
        mask = m.type_mask
        pos: Vector | None = None
        if not mask & POSITION_IGNORED:
            if m.coordinate_frame not in GLOBAL_FRAMES or not math.isfinite(m.alt):
                self.bridge.autopilot.guided_stop()
                return
            pos = self.bridge.places.ned(m.lat_int, m.lon_int, m.alt, m.coordinate_frame)
            if pos is None:
                return
        vel = None if mask & VELOCITY_IGNORED else (m.vx, m.vy, m.vz)
        acc = None if mask & ACCELERATION_IGNORED else (m.afx, m.afy, m.afz)
        self._set(m, pos, vel, acc, False)

    def _set(
        self, m: Any, pos: Vector | None, vel: Vector | None, acc: Vector | None, relative: bool
    ) -> None:
        autopilot, mask = self.bridge.autopilot, m.type_mask
        yaw = NO_YAW
        if mask & YAWS_IGNORED != YAWS_IGNORED:
            yaw = Yaw(not mask & YAW_IGNORED, m.yaw, not mask & YAW_RATE_IGNORED, m.yaw_rate, relative)
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

    # ------------------------------------------------------------------ attitude

    def _attitude(self, channel: Channel, m: Any, sender: Sender) -> None:
        mask = m.type_mask
        if self._mode() != GUIDED_MODE or mask & THRUST_IGNORED:
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
            self.bridge.autopilot.guided_attitude(q, rates, m.thrust)

    # ------------------------------------------------------------------ mission items as targets

    def mission_item_target(self, item: MissionItem, altitude_only: bool) -> bool:
        """Fly to a mission item's place (``current`` = 2).

        Or to its height over the present place (3), in GUIDED.
        """
        if self._mode() != GUIDED_MODE or item.frame not in GLOBAL_FRAMES:
            return False
        if altitude_only:
            height = item.z if item.frame in FRAMES_AMSL else self.bridge.places.home_alt() + item.z
            _, _, _, n, e, _ = self._pose()
            place = self.bridge.places.over_origin(n, e, height)
        else:
            place = self.bridge.places.ned(item.x, item.y, item.z, item.frame)
        return place is not None and self.bridge.autopilot.guided_position(place, None)


def _turn(v: Vector | None, c: float, s: float) -> Vector | None:
    """A vector forward, right, down to north, east, down."""
    return None if v is None else (v[0] * c - v[1] * s, v[0] * s + v[1] * c, v[2])
