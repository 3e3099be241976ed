# SPDX-License-Identifier: BSD-3-Clause
"""Event messages of a log: texts, parameters, the mission, and what follows from changes of the record.

What the autopilot's events log, they say themselves (``sitl.autopilot.events``).
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Sequence
from struct import Struct
from typing import Any, NamedTuple

from ...autopilot.log_events import LogErrorSubsystem, LogEvent
from ...autopilot.mission.item import MissionItem
from .common import EVENT_MESSAGES
from .formats import HEAD, TYPES

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
    Edge("autopilot.arming.auto_armed", LogEvent.AUTO_ARMED),
    Edge("autopilot.arming.landed_maybe", LogEvent.LAND_COMPLETE_MAYBE),
    Edge("autopilot.arming.landed", LogEvent.LAND_COMPLETE, LogEvent.NOT_LANDED),
    Edge("autopilot.home.is_set", LogEvent.SET_HOME),
    Edge("autopilot.estimate.reset_d_count", LogEvent.EKF_ALT_RESET),
    Edge("autopilot.estimate.reset_yaw_count", LogEvent.EKF_YAW_RESET),
)


class Health(NamedTuple):
    """A sensor that is healthy while it has been heard of late; a change is logged as an ERR message."""

    subsystem: int
    """Of ERR."""
    path: str
    """Field of the vehicle's record: when it was last received [us since boot]; 0: never, or that is not known."""


SILENCE_US = 500_000
RESOLVED, UNHEALTHY = 0, 4
"""Codes of ERR."""
HEALTH = (
    Health(LogErrorSubsystem.BARO, "autopilot.ekf.baro_us"),
    Health(LogErrorSubsystem.COMPASS, "sensors.mag_us[0]"),
)


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
