# SPDX-License-Identifier: BSD-3-Clause
"""Set-points for GUIDED.

Positions, velocities, accelerations, attitudes (https://mavlink.io/en/services/offboard_control.html).

They are not acknowledged. In another mode than GUIDED they are ignored. Here they become north, east, down; what is
made of each kind is the firmware's (``copter/setpoints.py``, ``rover/setpoints.py``).
"""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import Any

from ...autopilot.mission.item import MissionItem
from ..autopilot_api import Vector
from ..channel import Channel
from .command import FRAMES_AMSL, GLOBAL_FRAMES
from .service import Handler, Sender, Service

POSITION_IGNORED, VELOCITY_IGNORED, ACCELERATION_IGNORED = 0x007, 0x038, 0x1C0
FORCE, YAW_IGNORED, YAW_RATE_IGNORED = 0x200, 0x400, 0x800
YAWS_IGNORED = YAW_IGNORED | YAW_RATE_IGNORED
"""POSITION_TARGET_TYPEMASK"""
LOCAL_NED, LOCAL_OFFSET_NED, BODY_NED, BODY_OFFSET_NED = 1, 7, 8, 9
LOCAL_FRAMES = (LOCAL_NED, LOCAL_OFFSET_NED, BODY_NED, BODY_OFFSET_NED)
BODY_FRAMES = (BODY_NED, BODY_OFFSET_NED)

ROLL_RATE_IGNORED, PITCH_RATE_IGNORED, BODY_YAW_RATE_IGNORED = 0x01, 0x02, 0x04
THRUST_IGNORED, ATTITUDE_IGNORED = 0x40, 0x80
"""ATTITUDE_TARGET_TYPEMASK"""

E_ = "autopilot.estimate."


class SetpointService(Service):
    """Set-points for GUIDED, and mission items with ``current`` 2 or 3."""

    def __init__(self, bridge: Any) -> None:
        super().__init__(bridge)
        self._mode: Callable[[], int] = bridge.reader.field("autopilot.modes.number")
        self._pose = bridge.reader.fields(E_ + "euler", E_ + "pos")
        self._guided: int = bridge.profile.guided

    def handlers(self) -> dict[str, Handler]:
        return {
            "SET_POSITION_TARGET_LOCAL_NED": self._local,
            "SET_POSITION_TARGET_GLOBAL_INT": self._global,
            "SET_ATTITUDE_TARGET": self._attitude,
        }

    # ------------------------------------------------------------------ what a firmware makes of it

    def _listens(self) -> bool:
        """Whether set-points count now."""
        return self._mode() == self._guided

    def _unknown_frame(self) -> None:
        """A position in a frame that there is not."""
        raise NotImplementedError

    def _place(self, m: Any) -> Vector | None:
        """NED [m] of a position on the globe; None: leave the message alone."""
        raise NotImplementedError

    def _set(self, m: Any, pos: Vector | None, vel: Vector | None, acc: Vector | None, body: bool) -> None:
        """Follow what of a message its mask does not ignore (north, east, down).

        ``body``: it came in a body frame, so that its yaw counts from the vehicle's.
        """
        raise NotImplementedError

    def _attitude(self, channel: Channel, m: Any, sender: Sender) -> None:
        raise NotImplementedError

    def _height_target(self, item: MissionItem) -> bool:
        """Go to the height of a mission item (``current`` = 3)."""
        raise NotImplementedError

    # ------------------------------------------------------------------ position, velocity, acceleration

    def _local(self, channel: Channel, m: Any, sender: Sender) -> None:
        if not self._listens():
            return
        mask, frame = m.type_mask, m.coordinate_frame
        if frame not in LOCAL_FRAMES:
            self._unknown_frame()
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
        if not self._listens():
            return
        mask = m.type_mask
        pos: Vector | None = None
        if not mask & POSITION_IGNORED:
            pos = self._place(m)
            if pos is None:
                return
        vel = None if mask & VELOCITY_IGNORED else (m.vx, m.vy, m.vz)
        acc = None if mask & ACCELERATION_IGNORED else (m.afx, m.afy, m.afz)
        self._set(m, pos, vel, acc, False)

    # ------------------------------------------------------------------ mission items as targets

    def mission_item_target(self, item: MissionItem, altitude_only: bool) -> bool:
        """Go to a mission item's place (``current`` = 2).

        Or to its height over the present place (3), in GUIDED.
        """
        if not self._listens() or item.frame not in GLOBAL_FRAMES:
            return False
        if altitude_only:
            return self._height_target(item)
        place = self.bridge.places.ned(item.x, item.y, item.z, item.frame)
        return place is not None and self.bridge.autopilot.guided_position(place, None)

    def _height(self, item: MissionItem) -> float:
        """Height of a mission item [m above sea level]."""
        return item.z if item.frame in FRAMES_AMSL else self.bridge.places.home_alt() + item.z


def _turn(v: Vector | None, c: float, s: float) -> Vector | None:
    """A vector forward, right, down to north, east, down."""
    return None if v is None else (v[0] * c - v[1] * s, v[0] * s + v[1] * c, v[2])
