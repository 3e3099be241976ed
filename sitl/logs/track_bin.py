# SPDX-License-Identifier: BSD-3-Clause
"""The track of a flight in a DataFlash log (.bin, or .log as text), ours or a real vehicle's, of ArduPilot 3.0 on.

Versions differ in messages and fields: what is there is taken, and what is missing is noted.
Messages: https://ardupilot.org/copter/docs/logmessages.html
"""

from __future__ import annotations

import re
from pathlib import Path

import numpy as np

from ..autopilot.log_events import LogEvent
from ..core.mavlink import MavSeverity
from .dataflash.columns import Columns
from .dataflash.tables import Table
from .kind import mode_name
from .track import Track
from .track_columns import Array, TrackError
from .track_rows import MOST_DEG, complete, integrated

_POSITIONS = ("POS", "AHR2", "GPS")
"""Messages with locations, the best first: the estimate that is flown by, the backup's, the first receiver's."""
_FIELDS = {
    "ATT": ("Roll", "Pitch", "Yaw", "AEKF"), "BAT": ("Inst", "Instance", "Volt", "Curr", "EnrgTot"),
    "CURR": ("Volt", "Curr"), "XKF1": ("C", "VN", "VE", "VD"), "NKF1": ("C", "VN", "VE", "VD"),
    "EKF1": ("VN", "VE", "VD"), "XKF4": ("C", "PI"), "NKF4": ("C", "PI"),
}  # fmt: skip
_NAMES = dict.fromkeys((*_POSITIONS, "MODE", "ARM", "EV", "ORGN")) | _FIELDS
_HOME = 1
_FIX_3D = 3
_REACHED = re.compile(r"Reached (?:command|waypoint) #(\d+)")
_STARTED = re.compile(r"Mission: (\d+) (\S+)")
_WHOLE = "bBhHiI"
"""Letters of whole numbers: voltage and current were in hundredths then (ArduPilot 3.3 and before)."""


def read(path: str | Path) -> Track:
    """The flight in a log. Its ``notes`` say what it lacks.

    Mission items are known by what is said of them (DataFlash has no message for it), texts are of severity INFO.

    Raises:
        LogError: the file cannot be read, or it shows no copter and no rover that moves.
    """
    log, title = Columns(path, _NAMES), f"log {str(path)!r}"
    track = Track(log.kind, np.zeros((0, 11)))
    positions = {name: _positions(log, name) for name in _POSITIONS}
    best = next((name for name in _POSITIONS if len(positions[name]) > 1), "")
    if not best:
        there = ", ".join(name for name in _POSITIONS if name in log.formats) or "none of them has a format"
        raise TrackError(
            f"{title} tells no path: it has no two positions in POS, AHR2 or GPS (formats: {there}); a vehicle without "
            "GPS logs none"
        )
    if best != "POS":
        track.notes.append(f"positions are those of {best}: it has no POS")
    if log.skipped:
        track.notes.append(f"{log.skipped} bytes of it are no messages, and left out")
    if log.left_out:
        track.notes.append(f"{log.left_out} messages of it have times that cannot be, and are left out")
    track.modes = _modes(log)
    if not track.modes:
        track.notes.append("it has no MODE")
    track.armed = armings(log)
    if not track.armed:
        track.notes.append("it tells of no arming (ARM, EV)")
    track.texts = [(time, MavSeverity.INFO, text) for time, text in log.texts]
    track.items = _items(log.texts)
    energies = _energies(log, track)
    attitude = _numbers(log, "ATT", "Roll", "Pitch", "Yaw")
    attitude[:, 1:] = np.radians(attitude[:, 1:])
    return complete(
        track, title, positions[best], _positions(log, "ORGN").tolist(), _velocities(log), attitude, energies
    )


def armings(log: Columns) -> list[tuple[float, bool]]:
    """(Time since boot [s], armed) whenever that changed."""
    found: list[tuple[float, bool]] = []
    if "ARM" in log and "ArmState" in log["ARM"]:
        found += zip(log["ARM"].time.tolist(), (log["ARM"]["ArmState"] != 0.0).tolist())
    if "EV" in log and "Id" in log["EV"]:
        event = log["EV"].where(np.isin(log["EV"]["Id"], (LogEvent.ARMED, LogEvent.DISARMED)))
        found += zip(event.time.tolist(), (event["Id"] == LogEvent.ARMED).tolist())
    changes: list[tuple[float, bool]] = []
    for time, state in sorted(found, key=lambda change: change[0]):
        if not changes and not state:  # LOG_DISARMED 0: the log was opened by the arming, which it misses
            changes.append((log.began, True))
        if not changes or changes[-1][1] != state:
            changes.append((time, state))
    return changes


def _numbers(log: Columns, name: str, *fields: str) -> Array:
    """Times and these fields of all messages of a name; no rows when it lacks one of them."""
    if name not in log or not all(field in log[name] for field in fields):
        return np.zeros((0, 1 + len(fields)))
    return _rows(log[name], *fields)


def _rows(table: Table, *fields: str) -> Array:
    return np.column_stack([table.time, *(table[field] for field in fields)])


def _positions(log: Columns, name: str) -> Array:
    """Time [s], latitude, longitude [deg], altitude above sea level [m]: of a filter, of the first receiver with a fix,
    or of home. Before it knows where it is, an autopilot is at 0, 0."""
    found = _numbers(log, name, "Lat", "Lng", "Alt")
    if not len(found):
        return found
    table, good = log[name], np.isfinite(found).all(axis=1)
    if name == "GPS":
        good &= (table["Status"] >= _FIX_3D) if "Status" in table else True
        good &= (table["I"] == 0) if "I" in table else True
    elif name == "ORGN":
        good &= (table["Type"] == _HOME) if "Type" in table else False
    lat, lon = found[:, 1], found[:, 2]
    good &= (np.abs(lat) <= MOST_DEG[0]) & (np.abs(lon) <= MOST_DEG[1]) & ((lat != 0.0) | (lon != 0.0))
    return np.asarray(found[good])


def _modes(log: Columns) -> list[tuple[float, str]]:
    if "MODE" not in log:
        return []
    table = log["MODE"]
    field = next((field for field in ("ModeNum", "Mode") if field in table), "")
    if not field:
        return []
    found: list[tuple[float, str]] = []
    kind = log.kind
    for time, mode in zip(table.time.tolist(), table[field].tolist()):
        if isinstance(mode, float) and not np.isfinite(mode):
            continue
        words = isinstance(mode, str) and not mode.isdigit()
        name = str(mode) if words else mode_name(kind, int(mode))
        if not found or found[-1][1] != name:
            found.append((time, name))
    return found


def _items(texts: list[tuple[float, str]]) -> list[tuple[float, int]]:
    """(Time [s], mission item) as they were reached."""
    found, takes_off = [], 0
    for time, text in texts:
        reached, started = _REACHED.match(text), _STARTED.match(text)
        if started is not None:
            if takes_off:
                found.append((time, takes_off))
            takes_off = int(started[1]) if started[2] == "Takeoff" else 0
        elif reached is not None:
            found.append((time, int(reached[1])))
    return found


def _energies(log: Columns, track: Track) -> Array:
    """Time [s], energy taken from the first battery [Wh]."""
    name = next((name for name in ("BAT", "CURR") if name in log), "")
    if not name:
        return np.zeros((0, 2))
    table = log[name]
    label = next((label for label in ("Inst", "Instance") if label in table), "")
    if label:
        table = table.where(table[label] == 0)
    if "EnrgTot" in table and np.isfinite(table["EnrgTot"]).any():
        return _rows(table, "EnrgTot")
    if "Volt" not in table or "Curr" not in table:
        return np.zeros((0, 2))
    scale = 0.01 if table.letters["Curr"] in _WHOLE else 1.0
    power = np.column_stack([table.time, table["Volt"] * table["Curr"] * scale * scale])
    track.notes.append("energy is summed up from voltage and current: it has no EnrgTot")
    return integrated(power[np.isfinite(power).all(axis=1)])


def _velocities(log: Columns) -> Array:
    """Time [s], north, east, down [m/s] of the filter, and of its lane, that was flown by."""
    name = log.estimate
    if not name or not all(field in log[name] for field in ("VN", "VE", "VD")):
        return np.zeros((0, 4))
    return _rows(log.lane(name), "VN", "VE", "VD")
