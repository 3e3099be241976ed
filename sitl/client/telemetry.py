# SPDX-License-Identifier: BSD-3-Clause
"""What a vehicle's telemetry said last."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass, field, replace
from typing import Any, NamedTuple

from ..core.geodesy import offset_ne
from ..core.mavlink import MavAutopilot, MavModeFlag, MavSysStatus
from . import px4

READY_BITS = 0x10 | 0x01
"""EKF_STATUS_REPORT: attitude, absolute position."""
NO_MISSION = 1
"""MISSION_CURRENT: MISSION_STATE_NO_MISSION."""


class Position(NamedTuple):
    """From home."""

    north: float
    """[m]"""
    east: float
    """[m]"""
    altitude: float
    """Above home [m]."""

    @property
    def height(self) -> float:
        """The altitude, under the name that the pytest plugin has for it [m]."""
        return self.altitude

    def __str__(self) -> str:
        return f"{self.north:.1f} m north, {self.east:.1f} m east, {self.altitude:.1f} m high"


class Attitude(NamedTuple):
    """From ATTITUDE."""

    roll: float
    """[rad]"""
    pitch: float
    """[rad]"""
    yaw: float
    """-pi .. pi [rad]"""


NO_ATTITUDE = Attitude(math.nan, math.nan, math.nan)


class Text(NamedTuple):
    """A status text."""

    time: float
    """Simulated [s]."""
    severity: int
    """MAV_SEVERITY"""
    text: str


@dataclass
class Telemetry:
    """The last of each; NaN until it was received."""

    mode_names: Mapping[int, str] = field(default_factory=dict)
    """Of this vehicle, by their numbers."""
    mode_number: int = -1
    """custom_mode of HEARTBEAT; -1 before the first."""
    armed: bool = False
    lat: int = 0
    """[degE7]"""
    lon: int = 0
    """[degE7]"""
    alt: float = math.nan
    """Above mean sea level [m]."""
    altitude: float = math.nan
    """Above home [m]."""
    velocity: tuple[float, float, float] = (math.nan, math.nan, math.nan)
    """North, east, down [m/s]."""
    heading: float = math.nan
    """[deg], 0 .. 360"""
    attitude: Attitude = NO_ATTITUDE
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
    """Values by name, as they were sent last."""
    texts: list[Text] = field(default_factory=list)
    reached: list[tuple[float, int]] = field(default_factory=list)
    """(time [s], mission item)"""
    pieces: dict[int, str] = field(default_factory=dict)
    """Beginnings of long texts."""
    disarmed_since: float = math.nan
    """Time since which all HEARTBEATs have said that it is disarmed [s]; NaN: the last did not."""
    heartbeat_at: float = -math.inf
    """Time of the last HEARTBEAT [s]."""
    last_item: int = -1
    """Of its mission, 0: it has none; -1: it does not say."""
    mission_at: float = -math.inf
    """Time at which it said so last [s]."""
    untold: tuple[int, ...] = ()
    """The last items that were under way, and were not yet said to be reached."""
    autopilot: int = -1
    """MAV_AUTOPILOT of HEARTBEAT; -1 before the first."""
    parameter_types: dict[str, int] = field(default_factory=dict)
    """MAV_PARAM_TYPE by name, as they were sent last."""

    def copy(self) -> Telemetry:
        """As it is now."""
        return replace(
            self,
            parameters=dict(self.parameters), parameter_types=dict(self.parameter_types), texts=list(self.texts),
            reached=list(self.reached), items=list(self.items), pieces=dict(self.pieces),
        )  # fmt: skip

    @property
    def is_px4(self) -> bool:
        """Whether the autopilot is PX4, which does some things otherwise (``px4``)."""
        return self.autopilot == MavAutopilot.PX4

    @property
    def before_first(self) -> int:
        """Number of items that the vehicle does not count: home, which only ArduPilot has as item 0."""
        return int(self.is_px4)

    @property
    def mode(self) -> str:
        """Flight mode; "" before the first HEARTBEAT."""
        return "" if self.mode_number < 0 else self.mode_names.get(self.mode_number, str(self.mode_number))

    @property
    def position(self) -> Position:
        """From home; NaN without one."""
        if self.home is None or math.isnan(self.altitude):
            return Position(math.nan, math.nan, self.altitude)
        north, east = offset_ne(self.home[0], self.home[1], self.lat, self.lon)
        return Position(float(north), float(east), self.altitude)

    @property
    def groundspeed(self) -> float:
        """[m/s]"""
        north, east, _ = self.velocity
        return math.sqrt(north * north + east * east)

    @property
    def climb_rate(self) -> float:
        """Upward [m/s]."""
        return -self.velocity[2]

    def _reached(self, time: float, seq: int) -> None:
        """An item was reached; of a waypoint and a do-command behind it vehicles tell only the do-command."""
        if seq not in self.untold:
            passed = [a for a in self.untold if 0 < a < seq and (a == self.item or seq < self.item)]
            self.reached.extend((time, a) for a in passed[-1:])
            self.untold = tuple(a for a in self.untold if a not in passed)
        self.untold = tuple(a for a in self.untold if a != seq)
        self.reached.append((time, seq))

    def take(self, time: float, name: str, m: Any) -> None:
        """A message, received at a simulated time [s]."""
        if name == "GLOBAL_POSITION_INT":
            self.lat, self.lon, self.alt, self.altitude = m.lat, m.lon, m.alt * 1e-3, m.relative_alt * 1e-3
            self.velocity = (m.vx * 0.01, m.vy * 0.01, m.vz * 0.01)
            self.heading = m.hdg * 0.01 if m.hdg != 65535 else math.nan
        elif name == "ATTITUDE":
            self.attitude = Attitude(m.roll, m.pitch, m.yaw)
        elif name == "HEARTBEAT":
            self.mode_number, self.armed, self.heartbeat_at = (
                int(m.custom_mode),
                bool(m.base_mode & MavModeFlag.SAFETY_ARMED),
                time,
            )
            self.autopilot = int(m.autopilot)
            if self.armed:
                self.disarmed_since = math.nan
            elif math.isnan(self.disarmed_since):
                self.disarmed_since = time
        elif name == "STATUSTEXT":
            self._text(time, m)
        elif name == "MISSION_ITEM_REACHED":
            seq = int(m.seq) + self.before_first
            if not (self.is_px4 and self.reached and self.reached[-1][1] == seq):  # which says it again and again
                self._reached(time, seq)
        elif name == "MISSION_CURRENT":
            item = int(m.seq) + self.before_first
            if item != self.item:
                self.untold = (*self.untold[-1:], item)
            self.item = item
            if m.mission_state:  # else it is an autopilot that does not tell
                self.last_item, self.mission_at = 0 if m.mission_state == NO_MISSION else int(m.total), time
            if self.armed and self.item not in self.items[-1:]:
                self.items.append(self.item)
        elif name == "PARAM_VALUE":
            name = m.param_id.decode("ascii", "replace")
            self.parameter_types[name] = int(m.param_type)
            self.parameters[name] = px4.value_of(m) if self.is_px4 else float(m.param_value)
        elif name == "EKF_STATUS_REPORT":
            self.has_position = m.flags & READY_BITS == READY_BITS
        elif name == "ESTIMATOR_STATUS" and self.is_px4:
            self.has_position = m.flags & px4.VALID == px4.VALID
        elif name == "SYS_STATUS":
            self.checked = bool(m.onboard_control_sensors_health & MavSysStatus.PREARM_CHECK)
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
