# SPDX-License-Identifier: BSD-3-Clause
"""What was done to the vehicle of a log: missions, modes, commands, set-points, sticks, wind.

Times are since arming [s].
"""

from __future__ import annotations

import math
from collections import Counter
from collections.abc import Iterator
from dataclasses import dataclass, field
from typing import Any, NamedTuple

import numpy as np

from sitl.autopilot.mission.item import MissionItem
from sitl.bridge.services.setpoint_messages import (
    ACCELERATION_IGNORED,
    POSITION_IGNORED,
    VELOCITY_IGNORED,
    YAWS_IGNORED,
)
from sitl.core import elementary_arrays as arrays
from sitl.core.elementary import atan2, cos, hypot, sin
from sitl.core.mavlink import MavCmd, MavFrame, MavResult
from sitl.logs.dataflash.columns import Table
from sitl.logs.kind import mode_name

from ..tlog_replay.steps import QUESTIONS
from . import gaps
from .flight_log import FlightLog

Array = np.ndarray[Any, Any]

_CHOSEN = frozenset((0, 1, 2, 18, 26, 31, 32, 52, 53))
"""MODE.Rsn of modes that a pilot, a ground station or a switch chose; the others are the autopilot's own doing."""
_GUIDED_MASKS = {
    1: VELOCITY_IGNORED | ACCELERATION_IGNORED | YAWS_IGNORED,
    2: VELOCITY_IGNORED | ACCELERATION_IGNORED | YAWS_IGNORED,
    3: YAWS_IGNORED,
    4: POSITION_IGNORED | YAWS_IGNORED,
    5: POSITION_IGNORED | VELOCITY_IGNORED | YAWS_IGNORED,
}
"""GUIP.Type (ArduCopter's sub-modes of GUIDED) -> type_mask of a set-point. 0 is a take-off, 6 attitudes."""
_ON_THE_GLOBE = 1e5
"""A GUIP position beyond it is latitude and longitude [m]."""
_METRES_SINCE = (4, 7)
"""Version since which GUIP is in metres, down; before: centimetres, up."""
_LONG_GUIDED_S = 3.0
_LONG_GAP_S = 0.25
CHANNELS = 16
_OPENING_S = 5.0
"""A mission that is written into a log so soon after its beginning was there before: arming opens logs."""
_START_S = 0.1
"""So long after AUTO a mission is begun whose start the log lacks."""
_START = {"frame": 0, "command": int(MavCmd.MISSION_START), "x": 0, "y": 0, "z": 0.0,
          "param1": 0.0, "param2": 0.0, "param3": 0.0, "param4": 0.0}  # fmt: skip
_CALM = 0.05
"""A wind estimate that never exceeds it is none [m/s]."""


class Mode(NamedTuple):
    """A change of mode."""

    time: float
    number: int
    chosen: bool
    """Else the autopilot changed it by itself."""


class Message(NamedTuple):
    """A message to send."""

    time: float
    name: str
    fields: dict[str, Any]


class Wind(NamedTuple):
    """Wind at a time."""

    time: float
    speed: float
    """[m/s]"""
    direction: float
    """Where it comes from [deg]."""


@dataclass
class Inputs:
    """All that was done."""

    missions: list[tuple[float, tuple[MissionItem, ...]]] = field(default_factory=list)
    modes: list[Mode] = field(default_factory=list)
    """The first one was there at arming."""
    messages: list[Message] = field(default_factory=list)
    sticks: tuple[Array, Array] | None = None
    """Times, and pulses (n, channels) [us]; None: no receiver."""
    wind: list[Wind] = field(default_factory=list)
    """As the log's estimator knew it; empty: it did not."""
    notes: list[str] = field(default_factory=list)


def of(log: FlightLog) -> Inputs:
    """Everything that a log shows of what was done to its vehicle."""
    found = Inputs()
    found.missions = _missions(log)
    found.modes = _modes(log)
    found.messages = _in_time([*_commands(log, found.notes), *_positions(log, found.notes), *_attitudes(log)])
    found.sticks = _sticks(log)
    found.wind = _wind(log)
    if count := gaps.dropped(log):
        found.notes.append(f"the vehicle could not write {count} messages of the flight into its log (DSF.Dp)")
    commands = [(one.time, one.fields["command"]) for one in found.messages if "command" in one.fields]
    start = gaps.uncommanded_start(log, gaps.mode_names(log.kind, found.modes), commands, found.sticks)
    if start is not None:
        found.messages = _in_time([*found.messages, Message(start + _START_S, "COMMAND_INT", _START)])
        found.notes.append("the log does not tell what began its mission on the ground: the twin is sent MISSION_START")
    if found.sticks is not None:
        gap = float(np.diff(found.sticks[0]).max(initial=0.0))
        if gap > _LONG_GAP_S:
            found.notes.append(f"sticks are missing in the log for up to {gap:.1f} s: they move evenly in between")
    else:
        found.notes.append("the log has no RCIN: nobody holds the sticks")
    if _guided_s(log, found.modes) > _LONG_GUIDED_S and not found.messages:
        found.notes.append("the log has no set-points of GUIDED (MAVC, GUIP, GUIA)")
    return found


def _in_time(messages: list[Message]) -> list[Message]:
    """Those of one time in the order in which they were logged."""
    return sorted(messages, key=lambda message: message.time)


def _guided_s(log: FlightLog, modes: list[Mode]) -> float:
    """How long it was in GUIDED [s]."""
    ends = [*(mode.time for mode in modes[1:]), log.span.length]
    guided = (max(mode.time, 0.0) for mode in modes)
    return math.fsum(
        end - begin for mode, begin, end in zip(modes, guided, ends) if mode_name(log.kind, mode.number) == "GUIDED"
    )


def _inside(log: FlightLog, table: Table) -> Array:
    time = log.since_arming(table)
    return (time >= -1e-6) & (time < log.span.length)


def _missions(log: FlightLog) -> list[tuple[float, tuple[MissionItem, ...]]]:
    """Missions as they were written into the log, whole each time."""
    table = log.every("CMD")
    if table is None:
        return []
    has_frame = "Frame" in table
    rows = zip(
        log.since_arming(table), table["CTot"], table["CNum"], table["CId"], table["Prm1"], table["Prm2"],
        table["Prm3"], table["Prm4"], table["Lat"], table["Lng"], table["Alt"],
        table["Frame"] if has_frame else np.full(len(table), 3.0),
    )  # fmt: skip
    found: list[tuple[float, tuple[MissionItem, ...]]] = []
    items: dict[int, MissionItem] = {}
    for time, total, number, command, p1, p2, p3, p4, lat, lon, alt, frame in rows:
        if time > log.span.length:
            break
        if number == 0 or int(number) in items:
            items = {}
        items[int(number)] = MissionItem(
            int(command), int(frame), p1, p2, p3, p4, round(lat * 1e7), round(lon * 1e7), alt, 1
        )
        if len(items) == int(total) and sorted(items) == list(range(int(total))):
            mission = tuple(items[seq] for seq in range(int(total)))
            if not found or found[-1][1] != mission:
                is_old = not found and (time <= 0.0 or table.time[0] - log.columns.began < _OPENING_S)
                found.append((min(float(time), 0.0) if is_old else float(time), mission))
    return found


def _modes(log: FlightLog) -> list[Mode]:
    table = log.every("MODE")
    if table is None:
        return []
    numbers = table["ModeNum"] if "ModeNum" in table else table["Mode"]
    reasons = table["Rsn"] if "Rsn" in table else np.zeros(len(table))
    found: list[Mode] = []
    for time, number, reason in zip(log.since_arming(table).tolist(), numbers.astype(int), reasons.astype(int)):
        if time <= 0.0:
            found = [Mode(time, int(number), True)]
        elif time < log.span.length:
            found.append(Mode(time, int(number), int(reason) in _CHOSEN))
    return found


def _commands(log: FlightLog, notes: list[str]) -> Iterator[Message]:
    """Commands of clients that the vehicle accepted, but for those that only ask, arm, or choose a mode."""
    table = log.every("MAVC")
    if table is None:
        return
    times = log.since_arming(table)
    refused: Counter[int] = Counter()
    for k in np.flatnonzero(_inside(log, table)):
        row = {name: float(table[name][k]) for name in table.fields}
        command = int(row["Cmd"])
        if (
            command in QUESTIONS
            or command == MavCmd.DO_SET_MODE
            or (command == MavCmd.COMPONENT_ARM_DISARM and row["P1"] == 1.0)
        ):
            continue
        if int(row.get("Res", MavResult.ACCEPTED)) != MavResult.ACCEPTED:
            refused[command] += 1
            continue
        fields = {
            "frame": int(row["Fr"]), "command": command, "param1": row["P1"], "param2": row["P2"],
            "param3": row["P3"], "param4": row["P4"], "x": int(row["X"]), "y": int(row["Y"]), "z": row["Z"],
        }  # fmt: skip
        yield Message(float(times[k]), "COMMAND_INT", fields)
    if refused:
        notes.append("left out, for the log's vehicle refused it: " + ", ".join(f"command {n}" for n in refused))


def _positions(log: FlightLog, notes: list[str]) -> Iterator[Message]:
    table = log.every("GUIP")
    if table is None:
        return
    estimate = log.estimate()
    since = log.since_arming(estimate)
    north, east, down = (log.at_arming(since, estimate[field]) for field in ("PN", "PE", "PD"))
    scale, up = (1.0, 1.0) if log.version >= _METRES_SINCE else (0.01, -1.0)
    columns = {name: table[name] for name in table.fields}
    times, home = log.since_arming(table), log.home()[2]
    left = on_globe = 0
    for k in np.flatnonzero(_inside(log, table)):
        row = {name: float(column[k]) for name, column in columns.items()}
        mask = _GUIDED_MASKS.get(int(row["Type"]))
        if mask is None:
            continue
        if row.get("Terrain", 0.0):
            left += 1
            continue
        if not mask & POSITION_IGNORED and abs(row["pX"]) > _ON_THE_GLOBE:
            on_globe += 1
            yield Message(float(times[k]), "SET_POSITION_TARGET_GLOBAL_INT", _on_the_globe(row, mask, home))
            continue
        fields = {
            "coordinate_frame": MavFrame.LOCAL_NED, "type_mask": mask,
            "x": scale * row["pX"] - north, "y": scale * row["pY"] - east, "z": up * scale * row["pZ"] - down,
            "vx": scale * row["vX"], "vy": scale * row["vY"], "vz": up * scale * row["vZ"],
            "afx": scale * row.get("aX", 0.0), "afy": scale * row.get("aY", 0.0),
            "afz": up * scale * row.get("aZ", 0.0),
        }  # fmt: skip
        yield Message(float(times[k]), "SET_POSITION_TARGET_LOCAL_NED", fields)
    if left:
        notes.append(f"{left} set-points of GUIDED over terrain are left out")
    if on_globe:
        notes.append(f"{on_globe} set-points of GUIDED are positions on the globe, which logs keep to about a metre")


def _on_the_globe(row: dict[str, float], mask: int, home: float) -> dict[str, Any]:
    """A set-point whose position is in 1e-7 degrees and centimetres. Whether its altitude is above home or above the
    sea is not logged: the nearer one is taken."""
    alt = 0.01 * row["pZ"]
    return {
        "coordinate_frame": MavFrame.GLOBAL_INT if abs(alt - home) < abs(alt) else MavFrame.GLOBAL_RELATIVE_ALT_INT,
        "type_mask": mask | VELOCITY_IGNORED | ACCELERATION_IGNORED,
        "lat_int": int(row["pX"]), "lon_int": int(row["pY"]), "alt": alt,
    }  # fmt: skip


def _attitudes(log: FlightLog) -> Iterator[Message]:
    table = log.every("GUIA")
    if table is None:
        return
    columns = {name: table[name] for name in table.fields}
    times = log.since_arming(table)
    for k in np.flatnonzero(_inside(log, table)):
        row = {name: float(column[k]) for name, column in columns.items()}
        half = [math.radians(row[name]) / 2.0 for name in ("Roll", "Pitch", "Yaw")]
        (sr, sp, sy), (cr, cp, cy) = map(sin, half), map(cos, half)
        q = (
            cr * cp * cy + sr * sp * sy, sr * cp * cy - cr * sp * sy,
            cr * sp * cy + sr * cp * sy, cr * cp * sy - sr * sp * cy,
        )  # fmt: skip
        rates = [math.radians(row[name]) for name in ("RollRt", "PitchRt", "YawRt")]
        fields = {
            "q": q, "body_roll_rate": rates[0], "body_pitch_rate": rates[1], "body_yaw_rate": rates[2],
            "thrust": row["Thrust"] or 0.5 + 0.5 * row["ClimbRt"], "type_mask": 0,
        }  # fmt: skip
        yield Message(float(times[k]), "SET_ATTITUDE_TARGET", fields)


def _sticks(log: FlightLog) -> tuple[Array, Array] | None:
    if not log.has("RCIN", "C1"):
        return None
    table = log.table("RCIN")
    names = [f"C{channel}" for channel in range(1, CHANNELS + 1) if f"C{channel}" in table]
    pulses = np.stack([table[name] for name in names], 1)
    time = log.since_arming(table)
    near = (time >= -5.0) & (time <= log.span.length)
    if not near.any() or not pulses[near].any():
        return None
    return time[near], pulses[near]


def _wind(log: FlightLog) -> list[Wind]:
    for name in ("XKF2", "NKF2"):
        if not log.has(name, "VWN", "VWE"):
            continue
        table = log.table(name, 0)
        time, north, east = log.since_arming(table), table["VWN"], table["VWE"]
        if not len(time) or arrays.hypot(north, east).max() < _CALM:
            continue
        seconds = np.arange(0.0, log.span.length, 1.0)
        north, east = (np.interp(seconds, time, values) for values in (north, east))
        return [
            Wind(t, hypot(n, e), math.degrees(atan2(-e, -n)) % 360.0)
            for t, n, e in zip(seconds.tolist(), north.tolist(), east.tolist())
        ]
    return []
