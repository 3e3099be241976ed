# SPDX-License-Identifier: BSD-3-Clause
"""The track of a flight in a .tlog, ours or a ground station's."""

from __future__ import annotations

import math
from collections import defaultdict
from pathlib import Path
from typing import Any

import numpy as np
from pymavlink.dialects.v20 import ardupilotmega as dialect

from ..core.geodesy import offset_ne
from .kind import kind_of_mav_type, mode_name
from .tlog import LogError, read_tlog
from .track import STEP_US, Array, Track, TrackError, is_angle, sampled

_ARMED = 128
"""MAV_MODE_FLAG_SAFETY_ARMED"""
_NO_AUTOPILOT = 8
"""MAV_AUTOPILOT_INVALID"""
_STEP = STEP_US * 1e-6


class _Reader:
    """Follows one vehicle through its frames."""

    def __init__(self, path: Path, system: int | None) -> None:
        self.path, self.system = path, system
        self.kind = ""
        self.rows: dict[str, list[tuple[float, ...]]] = defaultdict(list)
        self.track = Track("", np.zeros((0, 11)))
        self.homes: list[tuple[float, float, float, float]] = []
        self._boot: tuple[int, int] | None = None
        """(stamp [us], time since boot [ms]) of the last message that had both."""
        self._first_us = 0
        self._before_us = 0
        """Simulated time of earlier boots."""
        self._pieces: dict[int, str] = {}

    def time(self, stamp_us: int) -> float:
        """Time of a message that has none of its own [s]."""
        if self._boot is None:
            return (stamp_us - self._first_us) * 1e-6
        at_us, boot_ms = self._boot
        return (self._before_us + boot_ms * 1000 + stamp_us - at_us) * 1e-6

    def read(self) -> None:
        """Read all frames."""
        parser = dialect.MAVLink(None)
        parser.robust_parsing = True
        for stamp_us, raw in read_tlog(self.path):
            self._first_us = self._first_us or stamp_us
            for message in parser.parse_buffer(raw) or ():
                if message.get_srcComponent() == 1:
                    self.take(stamp_us, message)

    def take(self, stamp_us: int, message: Any) -> None:
        """One message of an autopilot."""
        name = message.get_type()
        if name == "HEARTBEAT" and message.autopilot != _NO_AUTOPILOT and not self.kind:
            kind = kind_of_mav_type(message.type)
            if kind is not None and self.system in (None, message.get_srcSystem()):
                self.system, self.kind = message.get_srcSystem(), kind
        if message.get_srcSystem() != self.system:
            return
        boot_ms = getattr(message, "time_boot_ms", None)
        if boot_ms:
            if self._boot is not None and boot_ms + 1000 < self._boot[1]:  # a reboot: time goes on
                self._before_us += self._boot[1] * 1000 + max(stamp_us - self._boot[0] - boot_ms * 1000, 0)
            self._boot = (stamp_us, boot_ms)
        take = getattr(self, "_" + name.lower(), None)
        if take is not None:
            take(self.time(stamp_us), message)

    def _global_position_int(self, t: float, m: Any) -> None:
        if m.lat or m.lon:  # before it knows where it is, it is at 0, 0
            self.rows["place"].append((t, m.lat, m.lon, m.alt * 1e-3, m.vx * 0.01, m.vy * 0.01, m.vz * 0.01))

    def _attitude(self, t: float, m: Any) -> None:
        self.rows["attitude"].append((t, m.roll, m.pitch, m.yaw))

    def _battery_status(self, t: float, m: Any) -> None:
        if m.id == 0 and m.energy_consumed >= 0:
            self.rows["energy"].append((t, m.energy_consumed / 36.0))  # hJ

    def _sys_status(self, t: float, m: Any) -> None:
        if m.current_battery >= 0:
            self.rows["power"].append((t, m.voltage_battery * 1e-3 * m.current_battery * 1e-2))

    def _home_position(self, t: float, m: Any) -> None:
        self.homes.append((t, m.latitude * 1e-7, m.longitude * 1e-7, m.altitude * 1e-3))

    def _heartbeat(self, t: float, m: Any) -> None:
        armed, mode = bool(m.base_mode & _ARMED), mode_name(self.kind, m.custom_mode)
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
            if len(m.text) == 50:
                return
            self.track.texts.append((t, m.severity, self._pieces.pop(number)))
        else:
            self.track.texts.append((t, m.severity, m.text))

    def _mission_item_reached(self, t: float, m: Any) -> None:
        if not self.track.items or self.track.items[-1][1] != m.seq or t - self.track.items[-1][0] > _STEP:
            self.track.items.append((t, m.seq))


def read(path: str | Path, system: int | None = None) -> Track:
    """The flight of the first copter or rover in a .tlog, or of ``system``.

    Times are the vehicle's own since boot; energy is that of BATTERY_STATUS, or summed up from SYS_STATUS.

    Raises:
        LogError: the file cannot be read, or it tells of no such vehicle.
    """
    reader = _Reader(Path(path), system)
    try:
        reader.read()
    except OSError as error:
        raise LogError(f"log {str(path)!r} cannot be read: {error.strerror or error}") from None
    if not reader.kind:
        which = "no copter and no rover" if system is None else f"no copter or rover with system id {system}"
        raise TrackError(f"log {str(path)!r} tells of {which}")
    place = np.array(sorted(reader.rows["place"]))
    if len(place) < 2:
        raise TrackError(f"log {str(path)!r} tells no way: it has no GLOBAL_POSITION_INT")
    track = reader.track
    track.kind, track.home = reader.kind, _home(track, reader.homes, place)
    lat, lon, alt = track.home
    ne = np.array([offset_ne(lat * 1e7, lon * 1e7, row[1], row[2]) for row in place])
    t = place[:, 0]
    series: dict[str, tuple[Array, Array]] = {
        "north": (t, ne[:, 0]),
        "east": (t, ne[:, 1]),
        "down": (t, alt - place[:, 3]),
    }
    for k, name in enumerate(("vn", "ve", "vd")):
        series[name] = (t, place[:, 4 + k])
    attitude = np.array(sorted(reader.rows["attitude"])) if reader.rows["attitude"] else np.zeros((0, 4))
    for k, name in enumerate(("roll", "pitch", "yaw")):
        series[name] = (attitude[:, 0], attitude[:, 1 + k])
    series["energy"] = _energy(reader.rows)
    times = np.arange(math.ceil(t[0] / _STEP - 1e-6), math.floor(t[-1] / _STEP + 1e-6) + 1) * _STEP
    track.data = sampled(times, series, is_angle)
    return track


def _home(track: Track, homes: list[tuple[float, float, float, float]], place: Array) -> tuple[float, float, float]:
    """Home as of the first arming, or what comes nearest to it."""
    armed = next((t for t, state in track.armed if state), float(place[0, 0]))
    known = [home for home in homes if home[0] <= armed + 1.0] or homes
    if known:
        chosen = next((home for home in known if home[0] >= armed), known[-1])
        return chosen[1:]
    row = place[min(int(np.searchsorted(place[:, 0], armed)), len(place) - 1)]
    return (row[1] * 1e-7, row[2] * 1e-7, float(row[3]))


def _energy(rows: dict[str, list[tuple[float, ...]]]) -> tuple[Array, Array]:
    if rows["energy"]:
        found = np.array(sorted(rows["energy"]))
        return found[:, 0], found[:, 1]
    if not rows["power"]:
        return np.zeros(0), np.zeros(0)
    power = np.array(sorted(rows["power"]))
    steps = np.diff(power[:, 0], prepend=power[0, 0]) * power[:, 1] / 3600.0
    return power[:, 0], np.cumsum(steps)
