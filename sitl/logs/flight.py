# SPDX-License-Identifier: BSD-3-Clause
"""A flight read back from its .tlog, as columns."""

from __future__ import annotations

import struct
from collections import defaultdict
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import numpy as np
from pymavlink.dialects.v20 import ardupilotmega as dialect

Series = np.ndarray[Any, Any]

_COLUMNS = {
    "LOCAL_POSITION_NED": ("x", "y", "z", "vx", "vy", "vz"),
    "ATTITUDE": ("roll", "pitch", "yaw", "rollspeed", "pitchspeed", "yawspeed"),
    "SERVO_OUTPUT_RAW": ("servo1_raw", "servo2_raw", "servo3_raw", "servo4_raw"),
    "VFR_HUD": ("throttle", "groundspeed"),
}


class LogError(ValueError):
    """A file that is not a telemetry log, or a log without the messages that were asked for."""


@dataclass
class Flight:
    """Time series and events of one vehicle.

    ``series[message]`` is an array (n, 1 + columns): seconds since the vehicle's boot, then the message's fields in
    their own units (``columns(message)``).
    """

    series: dict[str, Series] = field(default_factory=dict)
    texts: list[tuple[float, str]] = field(default_factory=list)
    reached: list[tuple[float, int]] = field(default_factory=list)
    """(time, mission item) of each MISSION_ITEM_REACHED."""
    modes: list[tuple[float, int]] = field(default_factory=list)
    """(time, custom mode) whenever it changed."""
    armed: list[tuple[float, bool]] = field(default_factory=list)
    """(time, armed) whenever it changed."""

    def __getitem__(self, message: str) -> Series:
        if message not in self.series:
            raise LogError(f"the log holds no {message}; it holds {', '.join(sorted(self.series)) or 'nothing'}")
        return self.series[message]

    @staticmethod
    def columns(message: str) -> tuple[str, ...]:
        """Names of the columns after the time."""
        return _COLUMNS[message]


def read(path: str | Path, system: int = 1) -> Flight:
    """Read a .tlog (frames, each behind a big-endian 8-byte time stamp in microseconds).

    Raises:
        LogError: the file cannot be read or holds no MAVLink frame.
    """
    try:
        data = Path(path).read_bytes()
    except OSError as error:
        raise LogError(f"log {str(path)!r} cannot be read: {error.strerror}") from None
    flight = Flight()
    rows: dict[str, list[tuple[float, ...]]] = defaultdict(list)
    parser = dialect.MAVLink(None)
    parser.robust_parsing = True
    offset, epoch_us = 0, None
    while offset + 20 <= len(data):
        (stamp_us,) = struct.unpack_from(">Q", data, offset)
        length = _frame_length(data, offset + 8)
        if length is None:
            raise LogError(f"log {str(path)!r}: no MAVLink frame at byte {offset + 8}")
        frame = data[offset + 8 : offset + 8 + length]
        offset += 8 + length
        epoch_us = stamp_us if epoch_us is None else epoch_us
        for message in parser.parse_buffer(frame) or ():
            if message.get_srcSystem() == system and message.get_srcComponent() == 1:
                _take(flight, rows, (stamp_us - epoch_us) * 1e-6, message)
    if epoch_us is None:
        raise LogError(f"log {str(path)!r} holds no MAVLink frame")
    flight.series = {name: np.array(values) for name, values in rows.items()}
    return flight


def _frame_length(data: bytes, start: int) -> int | None:
    if start + 3 > len(data):
        return None
    if data[start] == 0xFD:
        return 12 + data[start + 1] + (13 if data[start + 2] & 1 else 0)
    return 8 + data[start + 1] if data[start] == 0xFE else None


def _take(flight: Flight, rows: dict[str, list[tuple[float, ...]]], t: float, message: Any) -> None:
    name = message.get_type()
    if name in _COLUMNS:
        rows[name].append((t, *(getattr(message, column) for column in _COLUMNS[name])))
    elif name == "STATUSTEXT":
        flight.texts.append((t, message.text))
    elif name == "MISSION_ITEM_REACHED":
        flight.reached.append((t, message.seq))
    elif name == "HEARTBEAT":
        armed = bool(message.base_mode & dialect.MAV_MODE_FLAG_SAFETY_ARMED)
        if not flight.armed or flight.armed[-1][1] != armed:
            flight.armed.append((t, armed))
        if not flight.modes or flight.modes[-1][1] != message.custom_mode:
            flight.modes.append((t, message.custom_mode))
