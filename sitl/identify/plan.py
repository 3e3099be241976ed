# SPDX-License-Identifier: BSD-3-Clause
"""What to fly so that a log tells the figures: a mission, in the order of risk, around where it takes off."""

from __future__ import annotations

import math
from pathlib import Path

from ..core.whole_file import write_whole
from ..errors import OptionError

ADVICE = """\
1. LOG_BITMASK: add 1 (fast attitude), so that RATE is logged fast enough. Log on the ground, too: LOG_DISARMED 1.
2. Set BATT_MONITOR for voltage and current. Choose a day with little wind, and 80 m of free space to each side.
3. The mission, from the least risk to the most: hover for 40 s; climb and sink; legs at rising speeds with sharp turns.
   It lies around --home; look at it in your ground station before you fly it.
4. Be ready to take over in LOITER."""
_M = 1.0 / 111319.5
"""Degrees of latitude a metre."""
_LEGS = ((40, 0), (40, 40), (0, 40), (0, 0), (40, 40), (0, 40), (40, 0), (0, 0))
_TAKEOFF, _WAYPOINT, _SPEED, _HOME = 22, 16, 178, 20


def items(latitude: float, longitude: float) -> list[tuple[float, ...]]:
    """(Command, four parameters, latitude, longitude, altitude) of each item, home first."""
    found: list[tuple[float, ...]] = [(_WAYPOINT, 0, 0, 0, 0, latitude, longitude, 0)]

    def go(north: float, east: float, up: float, hold: float = 0.0) -> None:
        lon = longitude + east * _M / math.cos(math.radians(latitude))
        found.append((_WAYPOINT, hold, 0, 0, 0, latitude + north * _M, lon, up))

    found.append((_TAKEOFF, 0, 0, 0, 0, 0, 0, 10))
    go(0, 0, 10, 40)
    for up in (20, 12, 24, 12):
        go(0, 0, up, 2)
    for speed in (3.0, 6.0, 9.0):
        found.append((_SPEED, 1, speed, 0, 0, 0, 0, 0))
        for north, east in _LEGS:
            go(north, east, 15)
    go(0, 0, 10, 20)
    found.append((_HOME, 0, 0, 0, 0, 0, 0, 0))
    return found


def write(path: Path, home: tuple[float, float]) -> None:
    """Write the mission (QGC WPL 110)."""
    if path.suffix not in (".waypoints", ".txt"):
        raise OptionError(f"--plan {str(path)!r} does not end in .waypoints or .txt, the formats of ground stations")
    lines = ["QGC WPL 110"]
    for k, (command, a, b, c, d, lat, lon, alt) in enumerate(items(*home)):
        frame = 0 if k == 0 else 3
        lines.append(f"{k}\t{int(k == 0)}\t{frame}\t{command:.0f}\t{a}\t{b}\t{c}\t{d}\t{lat:.8f}\t{lon:.8f}\t{alt}\t1")
    write_whole(path, "\n".join(lines) + "\n", OptionError, f"--plan {str(path)!r}")
