# SPDX-License-Identifier: BSD-3-Clause
"""The track of a flight in a DataFlash log (.bin, or .log as text), ours or a real vehicle's, of ArduPilot 3.0 on.

Versions differ in messages and fields: what is there is taken, and what is missing is noted.
Messages: https://ardupilot.org/copter/docs/logmessages.html
"""

from __future__ import annotations

import math
import re
from collections import Counter, defaultdict
from pathlib import Path
from typing import Any

import numpy as np

from ..autopilot.log_events import LogEvent
from ..core.mavlink import MavSeverity
from . import firmwares
from .dataflash.reader import DataFlash, Row
from .kind import mode_name
from .track import Track
from .track_columns import TrackError
from .track_rows import complete, integrated, place_row

_PLACES = ("POS", "AHR2", "GPS")
"""Messages with places, the best first: the estimate that is flown by, the backup's, the first receiver's."""
_FILTERS = {"XKF1": 3, "NKF1": 2, "EKF1": 2}
"""Messages with velocities -> the filter of ATT.AEKF."""
_PRIMARY = {"XKF4": "XKF1", "NKF4": "NKF1"}
_NAMES = (
    *_PLACES, *_FILTERS, *_PRIMARY, "ATT", "BAT", "CURR", "MODE", "ARM", "EV", "MSG", "ORGN", "CMD", "VER", "PARM",
)  # fmt: skip
_HOME = 1
_FIX_3D = 3
_REACHED = re.compile(r"Reached (?:command|waypoint) #(\d+)")
_STARTED = re.compile(r"Mission: (\d+) (\S+)")
_WHOLE = "bBhHiI"
"""Letters of whole numbers: voltage and current were in hundredths then (ArduPilot 3.3 and before)."""


class _Reader:
    """Takes in what a log says."""

    def __init__(self) -> None:
        self.track = Track("", np.zeros((0, 11)))
        self.rows: dict[str, list[tuple[float, ...]]] = defaultdict(list)
        self.modes: list[tuple[float, float | str]] = []
        self.filters: Counter[int] = Counter()
        """ATT.AEKF"""
        self.primary: dict[str, int] = defaultdict(int)
        self.kinds: list[tuple[str, str]] = []
        """Kind of vehicle, or what it is else, by all that tells it, the first that is sure before others."""
        self.homes: list[tuple[float, ...]] = []
        self._takes_off = 0
        self._has_name = False
        self._time = 0.0
        self.began: float | None = None
        """Time of the first message [s]."""

    def take(self, row: Row) -> None:
        """One message; one without a time is of the time of the message before, if there was one."""
        if row.time is not None:
            self._time = row.time
            if self.began is None:
                self.began = row.time
        if self.began is None and row.name not in ("MSG", "PARM", "MODE"):
            return
        take = getattr(self, "_" + row.name.lower(), None)
        if row.name in _PLACES:
            self._place(row)
        elif row.name in _FILTERS:
            self._speed(row)
        elif row.name in _PRIMARY:
            self.primary[_PRIMARY[row.name]] = int(row.fields.get("PI", 0))
        elif take is not None:
            take(row.fields, row.letters)

    def _add(self, what: str, *values: float) -> None:
        if all(math.isfinite(value) for value in values):
            self.rows[what].append((self._time, *values))

    def _place(self, row: Row) -> None:
        f = row.fields
        if row.name == "GPS" and (f.get("I", 0) or f.get("Status", _FIX_3D) < _FIX_3D):
            return
        place = place_row(self._time, *(f.get(name, math.nan) for name in ("Lat", "Lng", "Alt")))
        if place is not None:
            self.rows[row.name].append(place)

    def _speed(self, row: Row) -> None:
        if row.fields.get("C", 0) == self.primary[row.name]:
            self._add(row.name, *(row.fields.get(name, math.nan) for name in ("VN", "VE", "VD")))

    def _att(self, f: dict[str, Any], letters: dict[str, str]) -> None:
        self._add("attitude", *(math.radians(f.get(name, math.nan)) for name in ("Roll", "Pitch", "Yaw")))
        if "AEKF" in f:
            self.filters[int(f["AEKF"])] += 1

    def _bat(self, f: dict[str, Any], letters: dict[str, str]) -> None:
        if f.get("Inst", f.get("Instance", 0)) != 0:
            return
        self._add("energy", f.get("EnrgTot", math.nan))
        scale = 0.01 if letters.get("Curr", "f") in _WHOLE else 1.0
        self._add("power", f.get("Volt", math.nan) * f.get("Curr", math.nan) * scale * scale)

    _curr = _bat

    def _mode(self, f: dict[str, Any], letters: dict[str, str]) -> None:
        mode = f.get("ModeNum", f.get("Mode"))
        if mode is not None and (not self.modes or self.modes[-1][1] != mode):
            self.modes.append((self._time, mode))

    def _arm(self, f: dict[str, Any], letters: dict[str, str]) -> None:
        if "ArmState" in f:
            self._armed(bool(f["ArmState"]))

    def _ev(self, f: dict[str, Any], letters: dict[str, str]) -> None:
        if f.get("Id") in (LogEvent.ARMED, LogEvent.DISARMED):
            self._armed(f["Id"] == LogEvent.ARMED)

    def _armed(self, state: bool) -> None:
        track = self.track
        if not track.armed and not state:  # LOG_DISARMED 0: the log was opened by the arming, which it misses
            track.armed.append((self._time if self.began is None else self.began, True))
        if not track.armed or track.armed[-1][1] != state:
            track.armed.append((self._time, state))

    def _orgn(self, f: dict[str, Any], letters: dict[str, str]) -> None:
        if f.get("Type") == _HOME:
            place = place_row(self._time, *(f.get(name, math.nan) for name in ("Lat", "Lng", "Alt")))
            self.homes += [place] if place is not None else []

    def _ver(self, f: dict[str, Any], letters: dict[str, str]) -> None:
        self.kinds.append(firmwares.of_build(int(f.get("BU", 0))))

    def _parm(self, f: dict[str, Any], letters: dict[str, str]) -> None:
        found = firmwares.of_parameter(str(f.get("Name", "")))
        if found != ("", ""):
            self.kinds.append(found)

    def _msg(self, f: dict[str, Any], letters: dict[str, str]) -> None:
        text = str(f.get("Message", ""))
        if not self._has_name:
            found = firmwares.of_text(text)
            self._has_name = found != ("", "")
            if self._has_name:
                self.kinds.insert(0, found)
        self.track.texts.append((self._time, MavSeverity.INFO, text))
        reached, started = _REACHED.match(text), _STARTED.match(text)
        if started is not None:
            if self._takes_off:
                self.track.items.append((self._time, self._takes_off))
            self._takes_off = int(started[1]) if started[2] == "Takeoff" else 0
        elif reached is not None:
            self.track.items.append((self._time, int(reached[1])))

    def finish(self, log: DataFlash) -> Track:
        """The track.

        Raises:
            TrackError: the log is of another kind of vehicle, or tells of no way.
        """
        track, title = self.track, f"log {str(log.path)!r}"
        track.kind, other = next((kind for kind in self.kinds if kind != ("", "")), ("", ""))
        if other:
            raise TrackError(f"{title} is of {other}: copters and rovers can be shown and compared")
        if not track.kind:
            raise TrackError(f"{title} does not say what vehicle it is of: no firmware is named (MSG, VER, PARM)")
        places = next((name for name in _PLACES if len(self.rows[name]) > 1), "")
        if not places:
            there = ", ".join(name for name in _PLACES if name in log.names) or "none of them has a format"
            raise TrackError(
                f"{title} tells no way: it has no two places in POS, AHR2 or GPS (formats: {there}); a vehicle without "
                "GPS logs none"
            )
        if places != "POS":
            track.notes.append(f"places are those of {places}: it has no POS")
        if log.skipped:
            track.notes.append(f"{log.skipped} bytes of it are no messages, and left out")
        if log.left_out:
            track.notes.append(f"{log.left_out} messages of it have times that cannot be, and are left out")
        track.modes = [
            (t, mode if isinstance(mode, str) else mode_name(track.kind, int(mode))) for t, mode in self.modes
        ]
        if not track.modes:
            track.notes.append("it has no MODE")
        if not track.armed:
            track.notes.append("it tells of no arming (ARM, EV)")
        energies = self.rows["energy"]
        if not energies and self.rows["power"]:
            energies = integrated(self.rows["power"])
            track.notes.append("energy is summed up from voltage and current: it has no EnrgTot")
        speeds = self.rows[self._filter()]
        return complete(track, title, self.rows[places], self.homes, speeds, self.rows["attitude"], energies)

    def _filter(self) -> str:
        """The message with the velocities of the filter that was flown by."""
        there = [name for name in _FILTERS if self.rows[name]]
        if not there:
            return ""
        flown, _ = self.filters.most_common(1)[0] if self.filters else (0, 0)
        return next(
            (name for name in there if _FILTERS[name] == flown), max(there, key=lambda name: len(self.rows[name]))
        )


def read(path: str | Path) -> Track:
    """The flight in a log. Its ``notes`` say what it lacks.

    Mission items are known by what is said of them (DataFlash has no message for it), texts are of severity INFO.

    Raises:
        LogError: the file cannot be read, or it tells of no copter and no rover that moves.
    """
    log, reader = DataFlash(path), _Reader()
    for row in log.rows(_NAMES):
        reader.take(row)
    return reader.finish(log)
