# SPDX-License-Identifier: BSD-3-Clause
"""What a vehicle's telemetry said last."""

from __future__ import annotations

import math
from dataclasses import dataclass, field, replace
from typing import Any, NamedTuple

from sitl.core.geodesy import offset_ne

ARMED = 0x80
"""HEARTBEAT.base_mode: MAV_MODE_FLAG_SAFETY_ARMED."""
READY_BITS = 0x10 | 0x01
"""EKF_STATUS_REPORT: attitude, absolute position."""
PREARM_BIT = 0x10000000
"""SYS_STATUS: MAV_SYS_STATUS_PREARM_CHECK."""
RATES_HZ = {"HEARTBEAT": 10, "GLOBAL_POSITION_INT": 10, "ATTITUDE": 10, "SYS_STATUS": 2, "EKF_STATUS_REPORT": 2}
"""What is asked for, and how often."""


class Place(NamedTuple):
    """From home."""

    north: float
    """[m]"""
    east: float
    """[m]"""
    height: float
    """[m]"""

    def __str__(self) -> str:
        return f"{self.north:.1f} m north, {self.east:.1f} m east, {self.height:.1f} m high"


class Text(NamedTuple):
    """A status text."""

    time: float
    """Simulated [s]."""
    severity: int
    """MAV_SEVERITY"""
    text: str


@dataclass
class Telemetry:
    """The last of each; NaN until it was heard."""

    custom_mode: int = -1
    armed: bool = False
    lat: int = 0
    """[degE7]"""
    lon: int = 0
    alt: float = math.nan
    """Above mean sea level [m]."""
    height: float = math.nan
    """Above home [m]."""
    velocity: tuple[float, float, float] = (math.nan, math.nan, math.nan)
    """North, east, down [m/s]."""
    heading: float = math.nan
    """[deg], 0 .. 360"""
    attitude: tuple[float, float, float] = (math.nan, math.nan, math.nan)
    """Roll, pitch, yaw [rad]."""
    home: tuple[int, int, float] | None = None
    """[degE7], [degE7], [m] above mean sea level."""
    has_position: bool = False
    """Attitude and absolute position are known."""
    checked: bool = False
    """Pre-arm checks are good."""
    voltage: float = math.nan
    """[V]"""
    remaining: float = math.nan
    """Of the battery [%]."""
    item: int = 0
    """Mission item under way."""
    items: list[int] = field(default_factory=list)
    """Mission items that were under way while it was armed."""
    parameters: dict[str, float] = field(default_factory=dict)
    texts: list[Text] = field(default_factory=list)
    reached: list[tuple[float, int]] = field(default_factory=list)
    """(time, mission item)"""
    pieces: dict[int, str] = field(default_factory=dict)
    """Beginnings of long texts."""

    def copy(self) -> Telemetry:
        """As it is now."""
        return replace(
            self,
            parameters=dict(self.parameters), texts=list(self.texts), reached=list(self.reached),
            items=list(self.items), pieces=dict(self.pieces),
        )  # fmt: skip

    @property
    def place(self) -> Place:
        """Where it is from home; NaN without a position."""
        if self.home is None or math.isnan(self.height):
            return Place(math.nan, math.nan, self.height)
        north, east = offset_ne(self.home[0], self.home[1], self.lat, self.lon)
        return Place(north, east, self.height)

    def take(self, time: float, name: str, m: Any) -> None:
        """A message."""
        if name == "GLOBAL_POSITION_INT":
            self.lat, self.lon, self.alt, self.height = m.lat, m.lon, m.alt * 1e-3, m.relative_alt * 1e-3
            self.velocity = (m.vx * 0.01, m.vy * 0.01, m.vz * 0.01)
            self.heading = m.hdg * 0.01 if m.hdg != 65535 else math.nan
        elif name == "ATTITUDE":
            self.attitude = (m.roll, m.pitch, m.yaw)
        elif name == "HEARTBEAT":
            self.custom_mode, self.armed = int(m.custom_mode), bool(m.base_mode & ARMED)
        elif name == "STATUSTEXT":
            self._text(time, m)
        elif name == "MISSION_ITEM_REACHED":
            self.reached.append((time, int(m.seq)))
        elif name == "MISSION_CURRENT":
            self.item = int(m.seq)
            if self.armed and self.item not in self.items[-1:]:
                self.items.append(self.item)
        elif name == "PARAM_VALUE":
            self.parameters[m.param_id.decode("ascii", "replace")] = float(m.param_value)
        elif name == "EKF_STATUS_REPORT":
            self.has_position = m.flags & READY_BITS == READY_BITS
        elif name == "SYS_STATUS":
            self.checked = bool(m.onboard_control_sensors_health & PREARM_BIT)
            self.voltage, self.remaining = m.voltage_battery * 1e-3, float(m.battery_remaining)
        elif name == "HOME_POSITION":
            self.home = (m.latitude, m.longitude, m.altitude * 1e-3)

    def _text(self, time: float, m: Any) -> None:
        """Texts of more than 50 bytes come in pieces."""
        text = m.text.decode("ascii", "replace")
        if m.id:
            text = self.pieces.pop(m.id, "") + text if m.chunk_seq else text
            if len(m.text) == 50:  # the last piece is shorter
                self.pieces[m.id] = text
                return
        self.texts.append(Text(time, int(m.severity), text))
