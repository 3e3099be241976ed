# SPDX-License-Identifier: BSD-3-Clause
"""What to fly so that a log shows the properties: a mission, in the order of risk, around where it takes off."""

from __future__ import annotations

import math
from pathlib import Path

from ..core.whole_file import write_whole
from ..errors import OptionError

_ADVICE_COPTER = """\
1. LOG_BITMASK: add 1 (fast attitude), so that RATE is logged fast enough. Log on the ground, too: LOG_DISARMED 1.
2. Set BATT_MONITOR for voltage and current; WP_YAW_BEHAVIOR 0, so that the vehicle flies sideways and backwards, too;
   WPNAV_ACCEL 400 and WPNAV_JERK 10 (WP_ACC 4, WP_JERK 10 in newer versions) for sharp turns. Choose a day with little
   wind, and 80 m of free space to each side. Let it stand for half a minute before arming.
3. The mission, from the least risk to the most: hover for 30 s; turns; climb and sink; legs at rising speeds with
   sharp turns.
   It lies around --home; look at it in your ground station before you fly it.
4. Be ready to take over in LOITER."""
_ADVICE_ROVER = """\
1. LOG_BITMASK: throttle, steering, IMU, RC and battery (65535, which is the default). Log on the ground, too:
   LOG_DISARMED 1. Set BATT_MONITOR for voltage and current. Free, level ground of {space:.0f} m to each side.
   Let it stand for half a minute before arming.
2. The mission: legs at rising speeds, a slalom, legs in reverse. It lies around --home; look at it in your ground
   station before you drive it.
3. Then by the sticks in MANUAL, as far as the ground allows: throttle 30, 60 and 100 % for five seconds each and 0 for
   three, forward, then backward; full throttle forward and at once full backward.
4. At a quarter, then at half of the throttle, then backward at a quarter: steering 25, 50 and 100 % to each side,
   moved at once and held for three seconds."""
ADVICE = {"copter": _ADVICE_COPTER, "rover": _ADVICE_ROVER}
"""What to set and to do, besides the mission."""
_M = 1.0 / 111319.5
"""Degrees of latitude a metre."""
_LEGS = ((40, 0), (40, 40), (0, 40), (0, 0), (40, 40), (0, 40), (40, 0), (0, 0))
_SHORT = ((6, 0), (6, 6), (0, 6), (0, 0))
_TAKEOFF, _WAYPOINT, _SPEED, _HOME, _TURN, _REVERSE = 22, 16, 178, 20, 115, 194
_LEG_S, _SHORT_S = 8.0, 3.0
"""A rover's legs, by its speed [s]."""
_TURNS = ((90, 1), (180, -1), (90, 1), (60, -1), (120, 1), (60, -1))
"""Angle [deg] and direction of turns at a position."""


Item = tuple[float, ...]
"""Command, four parameters, latitude, longitude, altitude."""


def advice(kind: str, speed: float) -> str:
    """What to set and to do, besides the mission, of a kind of vehicle."""
    return ADVICE[kind].format(space=(_LEG_S + 2.0 * _SHORT_S) * speed)


def _waypoint(home: tuple[float, float], north: float, east: float, up: float, hold: float = 0.0) -> Item:
    lon = home[1] + east * _M / math.cos(math.radians(home[0]))
    return _WAYPOINT, hold, 0, 0, 0, home[0] + north * _M, lon, up


def rover_items(latitude: float, longitude: float, speed: float) -> list[Item]:
    """Of a rover whose fastest leg is of this speed [m/s], home first."""
    home, leg, short = (latitude, longitude), _LEG_S * speed, _SHORT_S * speed
    found = [_waypoint(home, 0, 0, 0)]

    def drive(share: float, *positions: tuple[float, float]) -> None:
        found.append((_SPEED, 1, share * speed, 0, 0, 0, 0, 0))
        found.extend(_waypoint(home, north, east, 0) for north, east in positions)

    drive(0.5, (leg, 0), (leg, leg))
    drive(1.0, (0, leg), (0, 0), (leg, 0), (0, leg))
    drive(0.6, *(((k + 1) * 0.5 * short, leg + short * (k % 2)) for k in range(6)))
    found.append((_REVERSE, 1, 0, 0, 0, 0, 0, 0))
    drive(0.7, (0, leg), (0, 0))
    found.append((_REVERSE, 0, 0, 0, 0, 0, 0, 0))
    drive(0.7, (0.5 * leg, 0))
    return found


def items(latitude: float, longitude: float) -> list[Item]:
    """Of a copter, home first."""
    home = (latitude, longitude)
    found: list[Item] = [_waypoint(home, 0, 0, 0)]

    def go(north: float, east: float, up: float, hold: float = 0.0) -> None:
        found.append(_waypoint(home, north, east, up, hold))

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


def write(path: Path, home: tuple[float, float], kind: str = "copter", speed: float = 1.5) -> None:
    """Write the mission (QGC WPL 110).

    Args:
        path: of the file.
        home: latitude and longitude around which it lies [deg].
        kind: of vehicle.
        speed: of a rover's fastest legs [m/s].
    """
    if path.suffix not in (".waypoints", ".txt"):
        raise OptionError(f"--plan {str(path)!r} does not end in .waypoints or .txt, the formats of ground stations")
    lines = ["QGC WPL 110"]
    mission = items(*home) if kind == "copter" else rover_items(*home, speed)
    for k, (command, a, b, c, d, lat, lon, alt) in enumerate(mission):
        frame = 0 if k == 0 else 3
        lines.append(f"{k}\t{int(k == 0)}\t{frame}\t{command:.0f}\t{a}\t{b}\t{c}\t{d}\t{lat:.8f}\t{lon:.8f}\t{alt}\t1")
    write_whole(path, "\n".join(lines) + "\n", OptionError, f"--plan {str(path)!r}")
