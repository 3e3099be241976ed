# SPDX-License-Identifier: BSD-3-Clause
"""Mission files: "QGC WPL 110" text (every ground station) and QGroundControl's .plan (JSON).

https://mavlink.io/en/file_formats/
"""

from __future__ import annotations

import json
import math
from pathlib import Path
from typing import Any

from .item import COMMANDS, GLOBAL, NAV_WAYPOINT, MissionItem, home_item
from .mission import Mission, MissionError
from .validate import ACCEPTED, check

HEADER = "QGC WPL 110"
QUADROTOR, GROUND_ROVER = 2, 10
"""MAV_TYPE"""
_COLUMNS = ("index", "current", "frame", "command", "p1", "p2", "p3", "p4", "x", "y", "z", "autocontinue")


class MissionFileError(ValueError):
    """A mission file that cannot be read; names the file, the line and the value."""


def load(path: str | Path) -> Mission:
    """Mission of a file; .plan is JSON, everything else QGC WPL 110.

    Raises:
        MissionFileError: the file cannot be read or a line of it cannot be taken.
    """
    path = Path(path)
    try:
        text = path.read_text(encoding="utf-8")
    except (OSError, UnicodeDecodeError) as error:
        raise MissionFileError(f"{path}: {error}") from error
    return parse_plan(text, str(path)) if path.suffix.lower() == ".plan" else parse_wpl(text, str(path))


def save(mission: Mission, path: str | Path, vehicle_type: int = QUADROTOR) -> None:
    """Write a mission; the suffix chooses the format as in ``load``, plans say for which MAV_TYPE they are."""
    path = Path(path)
    text = format_plan(mission, vehicle_type) if path.suffix.lower() == ".plan" else format_wpl(mission)
    path.write_text(text, encoding="utf-8")


def _has_degrees(command: int) -> bool:
    return command not in COMMANDS or COMMANDS[command].has_place


def _scaled(value: float, command: int) -> int:
    return round(value * 1e7) if _has_degrees(command) else round(value)


def _shown(value: int, command: int) -> str:
    return f"{value * 1e-7:.8f}" if _has_degrees(command) else f"{value}"


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


def parse_wpl(text: str, name: str = "mission") -> Mission:
    """Mission of QGC WPL 110 text; raises MissionFileError as ``load`` does."""
    lines = text.splitlines()
    if not lines or lines[0].strip() != HEADER:
        found = lines[0].strip() if lines else ""
        raise MissionFileError(f"{name}:1: expected {HEADER!r}, found {found!r}")
    items: list[MissionItem] = []
    for number, line in enumerate(lines[1:], start=2):
        words = line.split()
        if not words or words[0].startswith("#"):
            continue
        where = f"{name}:{number}"
        if len(words) != len(_COLUMNS):
            raise MissionFileError(f"{where}: {len(words)} columns, expected {len(_COLUMNS)} ({' '.join(_COLUMNS)})")
        cells = dict(zip(_COLUMNS, words, strict=True))
        seq, current, frame, command, autocontinue = (
            _whole(cells[k], f"{where}: {k}") for k in ("index", "current", "frame", "command", "autocontinue")
        )
        if seq != len(items):
            raise MissionFileError(f"{where}: index {seq}, expected {len(items)}")
        p1, p2, p3, p4, x, y, z = (_number(cells[k], f"{where}: {k}") for k in _COLUMNS[4:11])
        items.append(_item(command, frame, (p1, p2, p3, p4, x, y, z), autocontinue, where, current))
    return Mission.of(items)


def _item(
    command: int, frame: int, values: tuple[float, ...], autocontinue: int, where: str, current: int = 0
) -> MissionItem:
    p1, p2, p3, p4, x, y, z = values
    if not (math.isfinite(x) and math.isfinite(y)):
        raise MissionFileError(f"{where}: place {x}, {y} is not a pair of numbers")
    item = MissionItem(
        command, frame, p1, p2, p3, p4, _scaled(x, command), _scaled(y, command), z, autocontinue, current
    )
    if check(item) != ACCEPTED:
        try:
            Mission.of([item])
        except MissionError as error:
            reason = str(error).rpartition(": ")[2]
            raise MissionFileError(f"{where}: {reason} (command {command}, frame {frame})") from None
    return item


def format_wpl(mission: Mission) -> str:
    """QGC WPL 110 text of a mission."""
    rows = [HEADER]
    for seq, i in enumerate(mission.items):
        values = [f"{v:.8f}" for v in (i.p1, i.p2, i.p3, i.p4)]
        place = [_shown(i.x, i.command), _shown(i.y, i.command), f"{i.z:.6f}"]
        current = 1 if seq == 0 else 0
        rows.append(
            "\t".join([str(seq), str(current), str(i.frame), str(i.command), *values, *place, str(i.autocontinue)])
        )
    return "\n".join(rows) + "\n"


def parse_plan(text: str, name: str = "mission") -> Mission:
    """Mission of a QGroundControl plan: the planned home, then the items;
    raises MissionFileError as ``load`` does.
    """
    try:
        plan = json.loads(text)
    except json.JSONDecodeError as error:
        raise MissionFileError(f"{name}:{error.lineno}: {error.msg}") from None
    mission = plan.get("mission") if isinstance(plan, dict) else None
    if not isinstance(mission, dict) or not isinstance(mission.get("items"), list):
        raise MissionFileError(f"{name}: no 'mission' with a list of 'items'")
    home = _plan_values(mission.get("plannedHomePosition", [0.0, 0.0, 0.0]), 3, f"{name}: plannedHomePosition")
    items = [_item(NAV_WAYPOINT, GLOBAL, (0.0, 0.0, 0.0, 0.0, *home), 1, f"{name}: plannedHomePosition")]
    for k, entry in enumerate(mission["items"]):
        where = f"{name}: mission.items[{k}]"
        if not isinstance(entry, dict) or entry.get("type") != "SimpleItem":
            kind = entry.get("type") if isinstance(entry, dict) else entry
            raise MissionFileError(f"{where}: type {kind!r}, only 'SimpleItem' can be flown")
        values = _plan_values(entry.get("params"), 7, f"{where}.params")
        command, frame = (_plan_integer(entry.get(key), f"{where}.{key}") for key in ("command", "frame"))
        place = tuple(0.0 if math.isnan(v) else v for v in values[4:])
        items.append(_item(command, frame, (*values[:4], *place), 1 if entry.get("autoContinue", True) else 0, where))
    return Mission.of(items)


def _plan_integer(value: Any, where: str) -> int:
    if isinstance(value, bool) or not isinstance(value, int):
        raise MissionFileError(f"{where}: {value!r} is not a whole number")
    return value


def _plan_values(values: Any, count: int, where: str) -> tuple[float, ...]:
    """Numbers of a JSON list; null is NaN."""
    if not isinstance(values, list) or len(values) != count:
        raise MissionFileError(f"{where}: expected a list of {count} numbers, found {values!r}")
    found = []
    for value in values:
        if value is not None and (isinstance(value, bool) or not isinstance(value, int | float)):
            raise MissionFileError(f"{where}: {value!r} is not a number")
        found.append(math.nan if value is None else float(value))
    return tuple(found)


def format_plan(mission: Mission, vehicle_type: int = QUADROTOR) -> str:
    """A QGroundControl plan of a mission for a MAV_TYPE."""
    home = mission.items[0] if mission.items else home_item(0, 0, 0.0)
    entries = []
    for seq, i in enumerate(mission.items[1:], start=1):
        scale = 1e-7 if _has_degrees(i.command) else 1.0
        values = (i.p1, i.p2, i.p3, i.p4, round(i.x * scale, 8), round(i.y * scale, 8), i.z)
        entries.append(
            {
                "type": "SimpleItem",
                "autoContinue": bool(i.autocontinue),
                "command": i.command,
                "doJumpId": seq,
                "frame": i.frame,
                "params": [None if math.isnan(v) else v for v in values],
            }
        )
    plan = {
        "fileType": "Plan",
        "groundStation": "QGroundControl",
        "version": 1,
        "geoFence": {"circles": [], "polygons": [], "version": 2},
        "rallyPoints": {"points": [], "version": 2},
        "mission": {
            "version": 2,
            "firmwareType": 3,
            "vehicleType": vehicle_type,
            "cruiseSpeed": 10,
            "hoverSpeed": 5,
            "plannedHomePosition": [round(home.x * 1e-7, 8), round(home.y * 1e-7, 8), home.z],
            "items": entries,
        },
    }
    return json.dumps(plan, indent=4) + "\n"
