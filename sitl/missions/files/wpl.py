# SPDX-License-Identifier: BSD-3-Clause
"""Missions, fences and rally points as text: "QGC WPL", which every ground station reads and writes.

https://mavlink.io/en/file_formats/#mission_plain_text_file; what is read, and as what, is as in pymavlink's loader
(``mavwp.MAVWPLoader``), which MAVProxy uses.
"""

from __future__ import annotations

import math
from dataclasses import replace

from sitl.autopilot.mission.item import FENCE_COMMANDS, MissionItem
from sitl.autopilot.mission.mission import Mission, MissionError
from sitl.core.mavlink import MavCmd

from .document import MissionFile, MissionFileError, make, numbers
from .lists import of_fence, of_rally

HEADER, OLD_HEADER = "QGC WPL 110", "QGC WPL 100"
COLUMNS = ("index", "current", "frame", "command", "p1", "p2", "p3", "p4", "x", "y", "z", "autocontinue")
OLD_COLUMNS = ("index", "frame", "command", "p3", "p4", "p1", "p2", "current", "y", "x", "z", "unused", "autocontinue")
OLD_COMMANDS = {
    2: MavCmd.NAV_TAKEOFF, 3: MavCmd.NAV_RETURN_TO_LAUNCH, 4: MavCmd.NAV_LAND, 24: MavCmd.NAV_TAKEOFF,
    25: MavCmd.NAV_WAYPOINT, 26: MavCmd.NAV_LAND,
    27: MavCmd.NAV_LOITER_UNLIM,
}  # fmt: skip
"""Actions of the old format -> MAV_CMD."""
SAVE_ANEW = f"open it in the program that wrote it, or in QGroundControl, and save it as {HEADER!r} or .plan"


def parse(text: str, name: str = "mission") -> MissionFile:
    """The file's mission, or the fence or the rally points where that is what it lists.

    Items are numbered in the order of the lines, whatever their index says. Command 0 as the first of all is home, as
    Mission Planner writes it.

    Raises:
        MissionFileError: names the line and the column.
    """
    lines = text.splitlines()
    header = lines[0].strip() if lines else ""
    if header not in (HEADER, OLD_HEADER):
        raise MissionFileError(f"{name}:1: {_header_refusal(header)}")
    columns = COLUMNS if header == HEADER else OLD_COLUMNS
    items: list[MissionItem] = []
    sources: list[str] = []
    first = 0
    for number, line in enumerate(lines[1:], start=2):
        words = line.split()
        if not words or words[0].startswith("#"):
            continue
        where = f"{name}:{number}"
        if len(words) != len(columns):
            raise MissionFileError(f"{where}: {len(words)} columns, expected {len(columns)} ({' '.join(columns)})")
        cells = dict(zip(columns, words, strict=True))
        index, current, frame, command, autocontinue = (
            _whole(cells[k], f"{where}: {k}") for k in ("index", "current", "frame", "command", "autocontinue")
        )
        if columns is OLD_COLUMNS:
            command = _old_command(command, where)
        if not items:
            first = index
            command = MavCmd.NAV_WAYPOINT if command == index == 0 else command
        values = tuple(_number(cells[k], f"{where}: {k}") for k in COLUMNS[4:11])
        items.append(make(command, frame, values, autocontinue, where, current))
        sources.append(where)
    return _file(items, sources, first, name)


def _file(items: list[MissionItem], sources: list[str], first: int, name: str) -> MissionFile:
    """What the items are: a mission, a fence, or rally points. Mission Planner puts home before the latter two."""
    listed = items[1:] if len(items) > 1 and items[0].command == MavCmd.NAV_WAYPOINT else items
    lines = sources[len(sources) - len(listed) :]
    for kinds, read in ((FENCE_COMMANDS, of_fence), ((MavCmd.NAV_RALLY_POINT,), of_rally)):
        if listed and all(item.command in kinds for item in listed):
            return replace(read(listed, lines), name=name)
    for item, where in zip(items, sources, strict=True):
        if item.command in (*FENCE_COMMANDS, MavCmd.NAV_RALLY_POINT):
            raise MissionFileError(
                f"{where}: command {item.command} is of a fence or of rally points, the others are of a mission: "
                "each list is a file of its own"
            )
        if item.command == MavCmd.DO_JUMP and int(item.p1) not in range(1, len(items)):
            raise MissionFileError(f"{where}: p1: DO_JUMP to {item.p1:g}; there are items 1 to {len(items) - 1}")
    try:
        mission = Mission.of(items)
    except MissionError as error:
        raise MissionFileError(f"{name}: {error}") from None
    said = f"items are numbered from {first} on: the first one counts as home, as in ground stations"
    return MissionFile(mission, name, notes=() if first == 0 else (said,))


def _header_refusal(found: str) -> str:
    """Why a first line is not taken, and what to do."""
    if not found.startswith("QGC WPL"):
        return f"expected {HEADER!r}, found {found[:60]!r}"
    return f"{found[:60]!r} is not read, {HEADER!r} and {OLD_HEADER!r} are: {SAVE_ANEW}"


def _old_command(action: int, where: str) -> int:
    if action not in OLD_COMMANDS:
        known = ", ".join(map(str, OLD_COMMANDS))
        raise MissionFileError(
            f"{where}: action {action} of {OLD_HEADER!r} is not known; known are {known} ({SAVE_ANEW})"
        )
    return OLD_COMMANDS[action]


def _number(text: str, where: str) -> float:
    try:
        return float(text)
    except ValueError:
        raise MissionFileError(f"{where}: {text!r} is not a number") from None


def _whole(text: str, where: str) -> int:
    value = _number(text, where)
    if not (math.isfinite(value) and value == int(value)):
        raise MissionFileError(f"{where}: {text!r} is not a whole number")
    return int(value)


def write(file: MissionFile) -> str:
    """The text of a mission; of the fence or the rally points where the file has nothing else.

    Raises:
        MissionFileError: it has both of them and no mission.
    """
    items = file.mission.items
    if not items:
        if file.rally and file.fence_items:
            raise MissionFileError(f"{file.name}: a text holds a fence or rally points, not both; a .plan does")
        items = file.fence_items or file.rally_items
    rows = [HEADER]
    no_current = not any(item.current for item in items)
    for seq, item in enumerate(items):
        current = int(seq == 0) if no_current else item.current
        cells = [seq, current, item.frame, item.command, *map(_shown, numbers(item)), item.autocontinue]
        rows.append("\t".join(map(str, cells)))
    return "\n".join(rows) + "\n"


def _shown(value: float) -> str:
    """A number with all its digits, at least eight behind the point."""
    text = f"{value:.8f}"
    return text if not math.isfinite(value) or float(text) == value else repr(value)
