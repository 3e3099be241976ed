# SPDX-License-Identifier: BSD-3-Clause
"""Event messages of a log: modes, arming, errors, texts, parameters, the mission.

Numbers of EV and ERR: https://ardupilot.org/copter/docs/logmessages.html#ev
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Sequence
from struct import Struct
from typing import Any, NamedTuple

from ...autopilot import events as core
from ...autopilot import failsafe_checks as failsafes
from ...autopilot.fence.checks import AUTO_ON, BY_FLOOR, ON
from ...autopilot.fence.state import AREAS, CIRCLE, MAX_ALT, MIN_ALT
from ...autopilot.mission.item import MissionItem
from .common import EVENT_MESSAGES
from .formats import HEAD, TYPES

EV_ARMED, EV_DISARMED, EV_AUTO_ARMED, EV_LAND_MAYBE, EV_LANDED, EV_LOST_GPS = 10, 11, 15, 17, 18, 19
EV_SET_HOME, EV_NOT_LANDED, EV_ALT_RESET, EV_YAW_RESET = 25, 28, 60, 62
EV_FENCE_ON, EV_FENCE_OFF = 41, 42
_FENCES = {MAX_ALT: 76, CIRCLE: 78, MIN_ALT: 80, AREAS: 82}
"""Fence -> EV number when it is switched on; off: the next."""
_RADIO, _BATTERY, _GCS, _FENCE, _MODE, _CRASH, _EKF, _TERRAIN, _THRUST = 5, 6, 8, 9, 10, 12, 17, 23, 25
_FAILSAFES = {
    failsafes.RADIO: _RADIO,
    failsafes.GCS: _GCS,
    failsafes.BATTERY_LOW: _BATTERY,
    failsafes.BATTERY_CRITICAL: _BATTERY,
    failsafes.EKF: _EKF,
    failsafes.TERRAIN: _TERRAIN,
}
"""Failsafe -> subsystem of ERR."""
TEXT_BYTES = 64
ORIGIN, HOME = 0, 1
"""Type of ORGN."""


class Edge(NamedTuple):
    """A field of the vehicle's record; a change of its value is logged as an EV message."""

    path: str
    up: int
    """EV number when the value grows; 0: none."""
    down: int = 0


EDGES = (
    Edge("autopilot.arming.auto_armed", EV_AUTO_ARMED),
    Edge("autopilot.arming.landed_maybe", EV_LAND_MAYBE),
    Edge("autopilot.arming.landed", EV_LANDED, EV_NOT_LANDED),
    Edge("autopilot.home.is_set", EV_SET_HOME),
    Edge("autopilot.estimate.reset_d_count", EV_ALT_RESET),
    Edge("autopilot.estimate.reset_yaw_count", EV_YAW_RESET),
)


class Health(NamedTuple):
    """A sensor that is healthy while it has been heard of late; a change is logged as an ERR message."""

    subsystem: int
    """Of ERR."""
    path: str
    """Field of the vehicle's record: when it was last heard [us since boot]; 0: never, or that is not known."""


_COMPASS, _BARO = 3, 18
SILENCE_US = 500_000
RESOLVED, UNHEALTHY = 0, 4
"""Codes of ERR."""
HEALTH = (Health(_BARO, "autopilot.ekf.baro_us"), Health(_COMPASS, "sensors.mag_us[0]"))


class EventEncoder:
    """Encodes the messages of EVENT_MESSAGES.

    Args:
        numbers: message name -> message number in this log.
    """

    def __init__(self, numbers: dict[str, int]) -> None:
        self._packers: dict[str, tuple[Callable[..., bytes], int]] = {}
        self._texts = 0
        for m in EVENT_MESSAGES:
            layout: Struct = m.packer
            self._packers[m.name] = (layout.pack, numbers[m.name])

    def pack(self, name: str, time_us: int, *fields: Any) -> bytes:
        """One message; texts as bytes."""
        pack, number = self._packers[name]
        return pack(*HEAD, number, time_us, *fields)

    def event(self, time_us: int, code: int, a: float, b: float, checks: int) -> bytes:
        """Messages for an event of the autopilot; empty for events that are not logged.

        Args:
            time_us: simulated time since boot [us].
            code: number of the event.
            a, b: its arguments.
            checks: bits of ARMING_CHECK.
        """
        if code == core.MODE_CHANGED:
            return self.pack("MODE", time_us, int(a) & 255, int(a) & 255, int(b) & 255)
        if code == core.ARMED:
            armed = self.pack("ARM", time_us, 1, checks & 0xFFFFFFFF, 0, int(a) & 255)
            return armed + self.pack("EV", time_us, EV_ARMED)
        if code == core.DISARMED:
            disarmed = self.pack("ARM", time_us, 0, checks & 0xFFFFFFFF, 0, int(a) & 255)
            return disarmed + self.pack("EV", time_us, EV_DISARMED)
        if code == core.FAILSAFE and int(a) in _FAILSAFES:
            return self.pack("ERR", time_us, _FAILSAFES[int(a)], int(b != 0.0))
        if code == core.MODE_REFUSED:
            return self.pack("ERR", time_us, _MODE, int(a) & 255)
        if code in (core.CRASH_DISARM, core.CRASH_HOLD):
            return self.pack("ERR", time_us, _CRASH, 1)
        if code == core.THRUST_LOST:
            return self.pack("ERR", time_us, _THRUST, 1)
        if code in (core.FENCE_BREACHED, core.FENCE_CLEAR):
            return self.pack("ERR", time_us, _FENCE, int(a))
        if code == core.FENCE_SWITCHED:
            on = int(b) in (AUTO_ON, BY_FLOOR, ON)
            numbers = [EV_FENCE_ON if on else EV_FENCE_OFF]
            numbers += [number if on else number + 1 for bit, number in _FENCES.items() if int(a) & bit]
            return b"".join(self.pack("EV", time_us, number) for number in numbers)
        if code == core.EKF_STOPPED_GPS:
            return self.pack("EV", time_us, EV_LOST_GPS)
        return b""

    def text(self, time_us: int, text: str) -> bytes:
        """MSG: a message for every 64 bytes, with the text's number (``ID``) and its own in the text (``Seq``)."""
        data, number = text.encode("ascii", "replace"), self._texts & 255
        self._texts += 1
        starts = range(0, max(len(data), 1), TEXT_BYTES)
        return b"".join(self.pack("MSG", time_us, number, k, data[at : at + TEXT_BYTES]) for k, at in enumerate(starts))

    def command(self, name: str, time_us: int, total: int, seq: int, item: MissionItem) -> bytes:
        """CMD or MISE."""
        numbers = (total, seq, item.command & 0xFFFF, item.p1, item.p2, item.p3, item.p4)
        return self.pack(name, time_us, *numbers, item.x, item.y, item.z, item.frame & 255)

    def mission(self, time_us: int, items: Sequence[MissionItem]) -> bytes:
        """CMD: all items."""
        return b"".join(self.command("CMD", time_us, len(items), k, item) for k, item in enumerate(items))

    def origin(self, time_us: int, kind: int, lat: float, lon: float, alt: float) -> bytes:
        """ORGN: degE7, m."""
        return self.pack("ORGN", time_us, kind, int(lat), int(lon), round(alt * TYPES["e"][2]))

    def parameters(self, time_us: int, values: Iterable[tuple[str, float, float]]) -> bytes:
        """PARM of (name, value, default) each."""
        return b"".join(self.pack("PARM", time_us, name.encode(), value, default) for name, value, default in values)
