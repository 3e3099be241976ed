# SPDX-License-Identifier: BSD-3-Clause
"""Mission files by their suffix, and text files (QGC WPL 110).

"QGC WPL 110" text, which every ground station reads and writes.

https://mavlink.io/en/file_formats/#mission_plain_text_file
"""

from __future__ import annotations

import math
from pathlib import Path

from sitl.autopilot.mission.item import DO_JUMP, MissionItem
from sitl.autopilot.mission.mission import Mission, MissionError
from sitl.core.whole_file import write_whole

from . import plan
from .document import MissionFile, MissionFileError, has_degrees, make

HEADER = "QGC WPL 110"
COLUMNS = ("index", "current", "frame", "command", "p1", "p2", "p3", "p4", "x", "y", "z", "autocontinue")


def parse(text: str, name: str = "mission") -> MissionFile:
    """The file's mission.

    Raises:
        MissionFileError: names the line and the column.
    """
    lines = text.splitlines()
    if not lines or lines[0].strip() != HEADER:
        found = lines[0].strip()[:60] if lines else ""
        raise MissionFileError(f"{name}:1: expected {HEADER!r}, found {found!r}")
    items: list[MissionItem] = []
    places: list[str] = []
    for number, line in enumerate(lines[1:], start=2):
        words = line.split()
        if not words or words[0].startswith("#"):
            continue
        where = f"{name}:{number}"
        if len(words) != len(COLUMNS):
            raise MissionFileError(f"{where}: {len(words)} columns, expected {len(COLUMNS)} ({' '.join(COLUMNS)})")
        cells = dict(zip(COLUMNS, words, strict=True))
        seq, current, frame, command, autocontinue = (
            _whole(cells[k], f"{where}: {k}") for k in ("index", "current", "frame", "command", "autocontinue")
        )
        if seq != len(items):
            raise MissionFileError(f"{where}: index {seq}, expected {len(items)}: items are numbered from 0 (home) on")
        values = tuple(_number(cells[k], f"{where}: {k}") for k in COLUMNS[4:11])
        items.append(make(command, frame, values, autocontinue, where, current))
        places.append(where)
    for item, where in zip(items, places, strict=True):
        if item.command == DO_JUMP and item.p1 not in range(1, len(items)):
            raise MissionFileError(f"{where}: p1: DO_JUMP to {item.p1:g}; there are items 1 to {len(items) - 1}")
    try:
        return MissionFile(Mission.of(items), name)
    except MissionError as error:
        raise MissionFileError(f"{name}: {error}") from None


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
    """The text of a mission; fence and rally points have no place in it."""
    rows = [HEADER]
    for seq, i in enumerate(file.mission.items):
        cells = [str(seq), "1" if seq == 0 else "0", str(i.frame), str(i.command)]
        cells += [f"{v:.8f}" for v in (i.p1, i.p2, i.p3, i.p4)]
        cells += [f"{v * 1e-7:.8f}" if has_degrees(i.command) else f"{v}" for v in (i.x, i.y)]
        rows.append("\t".join([*cells, f"{i.z:.6f}", str(i.autocontinue)]))
    return "\n".join(rows) + "\n"


SUFFIXES = (".plan", ".waypoints", ".txt")


def load(path: str | Path) -> MissionFile:
    """Read a file; .plan is QGroundControl's JSON, everything else QGC WPL 110.

    Raises:
        MissionFileError: the file cannot be read, or something in it cannot be taken.
    """
    path = Path(path)
    try:
        text = path.read_text(encoding="utf-8-sig")
    except OSError as error:
        raise MissionFileError(f"{path}: {error.strerror or error}") from None
    except UnicodeDecodeError as error:
        raise MissionFileError(f"{path}: byte {error.start} is no text (UTF-8)") from None
    is_plan = path.suffix.lower() == ".plan"
    return plan.parse(text, str(path)) if is_plan else parse(text, str(path))


def save(file: MissionFile, path: str | Path) -> None:
    """Write a file; what the text format cannot hold (fence, rally points) is left out there.

    Raises:
        MissionFileError: the suffix is of neither format, or the file cannot be written.
    """
    path = Path(path)
    suffix = path.suffix.lower()
    if suffix not in SUFFIXES:
        raise MissionFileError(f"{path}: suffix {suffix!r} is not one of {', '.join(SUFFIXES)}")
    write_whole(path, plan.write(file) if suffix == ".plan" else write(file), MissionFileError, f"mission {path}")
