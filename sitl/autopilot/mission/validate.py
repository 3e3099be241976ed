# SPDX-License-Identifier: BSD-3-Clause
"""Which mission items the firmware takes,
as MAV_MISSION_RESULT (https://mavlink.io/en/messages/common.html#MAV_MISSION_RESULT).
"""

from __future__ import annotations

import math
from collections.abc import Container, Sequence

from .item import (
    COMMANDS,
    DO_JUMP,
    GLOBAL,
    GLOBAL_INT,
    MISSION,
    NAV_ARC_WAYPOINT,
    NAV_LAND,
    NAV_LOITER_UNLIM,
    NAV_TAKEOFF,
    NAV_VTOL_LAND,
    NAV_VTOL_TAKEOFF,
    NAV_WAYPOINT,
    RELATIVE_FRAMES,
    STORED,
    TERRAIN_FRAMES,
    MissionItem,
)

ACCEPTED = 0
ERROR = 1
UNSUPPORTED_FRAME = 2
UNSUPPORTED = 3
NO_SPACE = 4
INVALID = 5
INVALID_PARAM1 = 6
INVALID_PARAM5_X = 10
INVALID_PARAM6_Y = 11
INVALID_PARAM7 = 12
INVALID_SEQUENCE = 13
DENIED = 14

MAX_ITEMS = 724
"""Items that fit, home included."""
HIGHEST = 83000.0
"""Altitudes are below this [m]."""

PLACE_FRAMES = (GLOBAL, GLOBAL_INT, MISSION, *RELATIVE_FRAMES, *TERRAIN_FRAMES)
MAY_BE_NAN = {
    **dict.fromkeys((NAV_WAYPOINT, NAV_LOITER_UNLIM, NAV_LAND, NAV_TAKEOFF, NAV_VTOL_TAKEOFF), (4,)),
    NAV_ARC_WAYPOINT: (2, 3, 4),
    NAV_VTOL_LAND: (3, 4),
}
"""Which of the first four parameters may be NaN, by command."""
RESERVED = (0, 1)
"""No commands: ArduPilot's storage marks longer numbers with them."""


def check(item: MissionItem, taken: Container[int] = STORED) -> int:
    """Result for one item: parameters are numbers, the command ``taken`` and the frame known, the place on earth.

    NaN is taken where it means "as it is". Commands without a place take any frame, and anything where a place stands.
    """
    may_be_nan = MAY_BE_NAN.get(item.command, ())
    for k, value in enumerate((item.p1, item.p2, item.p3, item.p4), 1):
        if not math.isfinite(value) and not (math.isnan(value) and k in may_be_nan):
            return INVALID_PARAM1 + k - 1
    if item.command in RESERVED:
        return INVALID
    if item.command not in COMMANDS or item.command not in taken:
        return UNSUPPORTED
    if COMMANDS[item.command].has_place:
        if not -900000000 <= item.x <= 900000000:
            return INVALID_PARAM5_X
        if not -1800000000 <= item.y <= 1800000000:
            return INVALID_PARAM6_Y
        if not abs(item.z) < HIGHEST:
            return INVALID_PARAM7
        if item.frame not in PLACE_FRAMES:
            return UNSUPPORTED_FRAME
    if item.command == DO_JUMP and int(item.p1) < 1:
        return ERROR  # to home, which is not flown
    return ACCEPTED


def check_count(count: int) -> int:
    """Result for an announced number of items."""
    return NO_SPACE if count > MAX_ITEMS else ACCEPTED


def check_all(items: Sequence[MissionItem], taken: Container[int] = STORED) -> tuple[int, int]:
    """(result, number of the first item refused or -1) for a whole mission."""
    if check_count(len(items)) != ACCEPTED:
        return (NO_SPACE, MAX_ITEMS)
    for seq, item in enumerate(items):
        result = check(item, taken)
        if result == ACCEPTED and item.command == DO_JUMP and int(item.p1) >= len(items):
            result = ERROR
        if result != ACCEPTED:
            return (result, seq)
    return (ACCEPTED, -1)
