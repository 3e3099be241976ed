# SPDX-License-Identifier: BSD-3-Clause
"""A flight read back from its .tlog, as columns."""

from __future__ import annotations

from collections import defaultdict
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import numpy as np
from pymavlink.dialects.v20 import ardupilotmega as dialect

from .tlog import LogError, read_tlog

Series = np.ndarray[Any, Any]

COLUMNS = {
    "LOCAL_POSITION_NED": ("x", "y", "z", "vx", "vy", "vz"),
    "ATTITUDE": ("roll", "pitch", "yaw", "rollspeed", "pitchspeed", "yawspeed"),
    "SERVO_OUTPUT_RAW": tuple(f"servo{k}_raw" for k in range(1, 9)),
    "VFR_HUD": ("throttle", "groundspeed"),
}


@dataclass
class Flight:
    """Time series and events of one vehicle.

    ``series[message]`` is an array (n, 1 + columns): seconds since the log's first frame, then the message's fields in
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


def read(path: str | Path, system: int = 1) -> Flight:
    """Read a .tlog up to its end, or to where it stops being one.

    Raises:
        LogError: the file cannot be read or holds no MAVLink frame.
    """
    flight = Flight()
    rows: dict[str, list[tuple[float, ...]]] = defaultdict(list)
    parser = dialect.MAVLink(None)
    parser.robust_parsing = True
    epoch_us = None
    try:
        for stamp_us, frame in read_tlog(path):
            epoch_us = stamp_us if epoch_us is None else epoch_us
            for message in parser.parse_buffer(frame) or ():
                if message.get_srcSystem() == system and message.get_srcComponent() == 1:
                    _take(flight, rows, (stamp_us - epoch_us) * 1e-6, message)
    except OSError as error:
        raise LogError(f"log {str(path)!r} cannot be read: {error.strerror}") from None
    if epoch_us is None:
        raise LogError(f"log {str(path)!r} holds no MAVLink frame")
    flight.series = {name: np.array(values) for name, values in rows.items()}
    return flight


def _take(flight: Flight, rows: dict[str, list[tuple[float, ...]]], t: float, message: Any) -> None:
    name = message.get_type()
    if name in COLUMNS:
        rows[name].append((t, *(getattr(message, column) for column in COLUMNS[name])))
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
