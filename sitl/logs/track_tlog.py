# SPDX-License-Identifier: BSD-3-Clause
"""The track of a flight in a .tlog, ours or a ground station's."""

from __future__ import annotations

import math
from collections import defaultdict
from pathlib import Path
from typing import Any

import numpy as np
from pymavlink.dialects.v20 import ardupilotmega as dialect

from ..core.mavlink import MavAutopilot, MavModeFlag
from .kind import kind_of_mav_type, mode_name
from .tlog import LogError, read_steady
from .track import Track
from .track_columns import STEP_US, TrackError
from .track_rows import Rows, complete, integrated, location_row

_STEP = STEP_US * 1e-6
_PIECE = 50
"""Bytes of a STATUSTEXT."""


class _Reader:
    """Follows one vehicle through its frames."""

    def __init__(self, path: Path, system: int | None) -> None:
        self.path, self.system = path, system
        self.kind = ""
        self.others: dict[int, int] = {}
        """System -> MAV_TYPE of vehicles that we do not have."""
        self.rows: dict[str, list[tuple[float, ...]]] = defaultdict(list)
        self.track = Track("", np.zeros((0, 11)))
        self.frames = self.bad = 0
        self._boot: tuple[int, int] | None = None
        """(time in the log [us], time since boot [ms]) of the last message that had both."""
        self._before_us = 0
        """Simulated time of earlier boots."""
        self._pieces: dict[int, str] = {}

    def time(self, logged_us: int) -> float:
        """Time of a message that has none of its own [s]."""
        if self._boot is None:
            return logged_us * 1e-6
        at_us, boot_ms = self._boot
        return (self._before_us + boot_ms * 1000 + logged_us - at_us) * 1e-6

    def read(self) -> None:
        """Read all frames."""
        parser = dialect.MAVLink(None)
        for _, logged_us, raw in read_steady(self.path):
            self.frames += 1
            try:
                message = parser.decode(bytearray(raw))
            except dialect.MAVError:
                self.bad += 1
                continue
            if message.get_srcComponent() == 1:
                self.take(logged_us, message)

    def take(self, logged_us: int, message: Any) -> None:
        """One message of an autopilot."""
        name = message.get_type()
        if name == "HEARTBEAT" and message.autopilot != MavAutopilot.INVALID and not self.kind:
            kind = kind_of_mav_type(message.type)
            if self.system in (None, message.get_srcSystem()):
                if kind is not None:
                    self.system, self.kind = message.get_srcSystem(), kind
                else:
                    self.others[message.get_srcSystem()] = message.type
        if message.get_srcSystem() != self.system:
            return
        boot_ms = getattr(message, "time_boot_ms", None)
        if boot_ms:
            if self._boot is not None and boot_ms + 1000 < self._boot[1]:  # a reboot: time goes on
                self._before_us += self._boot[1] * 1000 + max(logged_us - self._boot[0] - boot_ms * 1000, 0)
            self._boot = (logged_us, boot_ms)
        take = getattr(self, "_" + name.lower(), None)
        if take is not None:
            take(self.time(logged_us), message)

    def _add(self, what: str, *values: float) -> None:
        if all(math.isfinite(value) for value in values):
            self.rows[what].append(values)

    def _global_position_int(self, t: float, m: Any) -> None:
        location = location_row(t, m.lat * 1e-7, m.lon * 1e-7, m.alt * 1e-3)
        if location is not None:
            self.rows["location"].append(location)
            self.rows["speed"].append((t, m.vx * 0.01, m.vy * 0.01, m.vz * 0.01))

    def _attitude(self, t: float, m: Any) -> None:
        self._add("attitude", t, m.roll, m.pitch, m.yaw)

    def _battery_status(self, t: float, m: Any) -> None:
        if m.id == 0 and m.energy_consumed >= 0:
            self._add("energy", t, m.energy_consumed / 36.0)  # hJ

    def _sys_status(self, t: float, m: Any) -> None:
        if m.current_battery >= 0:
            self._add("power", t, m.voltage_battery * 1e-3 * m.current_battery * 1e-2)

    def _home_position(self, t: float, m: Any) -> None:
        location = location_row(t, m.latitude * 1e-7, m.longitude * 1e-7, m.altitude * 1e-3)
        self.rows["home"] += [location] if location is not None else []

    def _heartbeat(self, t: float, m: Any) -> None:
        armed, mode = bool(m.base_mode & MavModeFlag.SAFETY_ARMED), mode_name(self.kind, m.custom_mode)
        track = self.track
        if not track.armed or track.armed[-1][1] != armed:
            track.armed.append((t, armed))
        if not track.modes or track.modes[-1][1] != mode:
            track.modes.append((t, mode))

    def _statustext(self, t: float, m: Any) -> None:
        number, piece = getattr(m, "id", 0), getattr(m, "chunk_seq", 0)
        if number:
            text = self._pieces.get(number, "") if piece else ""
            self._pieces[number] = text + m.text
            if len(m.text) == _PIECE:
                return
            self.track.texts.append((t, m.severity, self._pieces.pop(number)))
        else:
            self.track.texts.append((t, m.severity, m.text))

    def _mission_item_reached(self, t: float, m: Any) -> None:
        if not self.track.items or self.track.items[-1][1] != m.seq or t - self.track.items[-1][0] > _STEP:
            self.track.items.append((t, m.seq))


def read(path: str | Path, system: int | None = None) -> Track:
    """The flight of the first copter or rover in a .tlog, or of ``system``; its ``notes`` say what the log lacks.

    Times are the vehicle's own since boot; energy is that of BATTERY_STATUS, or summed up from SYS_STATUS.

    Raises:
        LogError: the file cannot be read, or it shows no such vehicle.
    """
    reader = _Reader(Path(path), system)
    title = f"log {str(path)!r}"
    try:
        reader.read()
    except OSError as error:
        raise LogError(f"{title} cannot be read: {error.strerror or error}") from None
    if not reader.frames - reader.bad:
        raise LogError(f"{title} holds no MAVLink frame: it is no .tlog")
    if not reader.kind:
        which = "no copter and no rover" if system is None else f"no copter or rover with system id {system}"
        there = ", ".join(f"system {number} is {_words(type_)}" for number, type_ in sorted(reader.others.items()))
        raise TrackError(f"{title} tells of {which}" + (f": {there}" if there else ": it has no HEARTBEAT of one"))
    if len(reader.rows["location"]) < 2:
        raise TrackError(f"{title} tells no path: it has no GLOBAL_POSITION_INT")
    track, rows = reader.track, reader.rows
    track.kind = reader.kind
    if reader.bad:
        track.notes.append(f"{reader.bad} of its frames are damaged, and left out")
    energies: Rows = rows["energy"]
    if not rows["energy"] and rows["power"]:
        energies = integrated(rows["power"])
        track.notes.append("energy is summed up from SYS_STATUS: it has no BATTERY_STATUS")
    return complete(track, title, rows["location"], rows["home"], rows["speed"], rows["attitude"], energies)


def _words(mav_type: int) -> str:
    """A type of vehicle: "of MAV_TYPE 1 (FIXED_WING)"."""
    entry = dialect.enums["MAV_TYPE"].get(mav_type)
    return f"of MAV_TYPE {mav_type}" + (f" ({entry.name.removeprefix('MAV_TYPE_')})" if entry is not None else "")
