# SPDX-License-Identifier: BSD-3-Clause
"""What to fly so that a log tells the figures: a mission, in the order of risk, around where it takes off."""

from __future__ import annotations

import math
from pathlib import Path

from ..core.whole_file import write_whole
from ..errors import OptionError

ADVICE = """\
1. LOG_BITMASK: add 1 (fast attitude), so that RATE is logged fast enough. Log on the ground, too: LOG_DISARMED 1.
2. Set BATT_MONITOR for voltage and current; WP_YAW_BEHAVIOR 0, so that the vehicle flies sideways and backwards, too;
   WPNAV_ACCEL 400 and WPNAV_JERK 10 (WP_ACC 4, WP_JERK 10 in newer versions) for sharp turns. Choose a day with little
   wind, and 80 m of free space to each side. Let it stand for half a minute before arming.
3. The mission, from the least risk to the most: hover for 30 s; turns; climb and sink; legs at rising speeds with
   sharp turns.
   It lies around --home; look at it in your ground station before you fly it.
4. Be ready to take over in LOITER."""
_M = 1.0 / 111319.5
"""Degrees of latitude a metre."""
_LEGS = ((40, 0), (40, 40), (0, 40), (0, 0), (40, 40), (0, 40), (40, 0), (0, 0))
_SHORT = ((6, 0), (6, 6), (0, 6), (0, 0))
_TAKEOFF, _WAYPOINT, _SPEED, _HOME, _TURN = 22, 16, 178, 20, 115
_TURNS = ((90, 1), (180, -1), (90, 1), (60, -1), (120, 1), (60, -1))
"""Angle [deg] and direction of turns at a place."""


def items(latitude: float, longitude: float) -> list[tuple[float, ...]]:
    """(Command, four parameters, latitude, longitude, altitude) of each item, home first."""
    found: list[tuple[float, ...]] = [(_WAYPOINT, 0, 0, 0, 0, latitude, longitude, 0)]

    def go(north: float, east: float, up: float, hold: float = 0.0) -> None:
        lon = longitude + east * _M / math.cos(math.radians(latitude))
        found.append((_WAYPOINT, hold, 0, 0, 0, latitude + north * _M, lon, up))

    found.append((_TAKEOFF, 0, 0, 0, 0, 0, 0, 15))
    go(0, 0, 15, 30)
    for angle, side in _TURNS:
        go(0, 0, 15, 5)
        found.append((_TURN, angle, 0, side, 1, 0, 0, 0))
    for up in (25, 17, 29, 15):
        go(0, 0, up, 2)
    for speed in (5.0, 9.0):
        found.append((_SPEED, 1, speed, 0, 0, 0, 0, 0))
        for north, east in _LEGS:
            go(north, east, 15)
    for k in range(12):
        north, east = _SHORT[k % 4]
        go(north, east, 15)
    go(0, 0, 15, 10)
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
