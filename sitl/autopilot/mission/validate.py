# SPDX-License-Identifier: BSD-3-Clause
"""Which mission items the firmware takes,
as MAV_MISSION_RESULT (https://mavlink.io/en/messages/common.html#MAV_MISSION_RESULT).
"""

from __future__ import annotations

import math
from collections.abc import Container, Sequence

from ...core.mavlink import MavCmd, MavFrame, MavMissionResult
from .item import COMMANDS, RELATIVE_FRAMES, STORED, TERRAIN_FRAMES, MissionItem

MAX_ITEMS = 724
"""Items that fit, home included."""
HIGHEST = 83000.0
"""Altitudes are below this [m]."""

LOCATION_FRAMES = (MavFrame.GLOBAL, MavFrame.GLOBAL_INT, MavFrame.MISSION, *RELATIVE_FRAMES, *TERRAIN_FRAMES)
MAY_BE_NAN: dict[int, tuple[int, ...]] = {
    **dict.fromkeys(
        (MavCmd.NAV_WAYPOINT, MavCmd.NAV_LOITER_UNLIM, MavCmd.NAV_LAND, MavCmd.NAV_TAKEOFF, MavCmd.NAV_VTOL_TAKEOFF),
        (4,),
    ),
    MavCmd.NAV_ARC_WAYPOINT: (2, 3, 4),
    MavCmd.NAV_VTOL_LAND: (3, 4),
}
"""Which of the first four parameters may be NaN, by command."""
RESERVED = (0, 1)
"""No commands: ArduPilot's storage marks longer numbers with them."""


def check(item: MissionItem, taken: Container[int] = STORED) -> int:
    """Result for one item: parameters are numbers, the command ``taken`` and the frame known, the location on earth.

    NaN is taken where it means "as it is". Commands without a location take any frame, and anything where a location
    stands.
    """
    may_be_nan = MAY_BE_NAN.get(item.command, ())
    for k, value in enumerate((item.p1, item.p2, item.p3, item.p4), 1):
        if not math.isfinite(value) and not (math.isnan(value) and k in may_be_nan):
            return MavMissionResult.INVALID_PARAM1 + k - 1
    if item.command in RESERVED:
        return MavMissionResult.INVALID
    if item.command not in COMMANDS or item.command not in taken:
        return MavMissionResult.UNSUPPORTED
    if COMMANDS[item.command].has_location:
        if not -900000000 <= item.x <= 900000000:
            return MavMissionResult.INVALID_PARAM5_X
        if not -1800000000 <= item.y <= 1800000000:
            return MavMissionResult.INVALID_PARAM6_Y
        if not abs(item.z) < HIGHEST:
            return MavMissionResult.INVALID_PARAM7
        if item.frame not in LOCATION_FRAMES:
            return MavMissionResult.UNSUPPORTED_FRAME
    if item.command == MavCmd.DO_JUMP and int(item.p1) < 1:
        return MavMissionResult.ERROR  # to home, which is not flown
    return MavMissionResult.ACCEPTED


def check_count(count: int) -> int:
    """Result for an announced number of items."""
    return MavMissionResult.NO_SPACE if count > MAX_ITEMS else MavMissionResult.ACCEPTED


def check_all(items: Sequence[MissionItem], taken: Container[int] = STORED) -> tuple[int, int]:
    """(result, number of the first item refused or -1) for a whole mission."""
    if check_count(len(items)) != MavMissionResult.ACCEPTED:
        return (MavMissionResult.NO_SPACE, MAX_ITEMS)
    for seq, item in enumerate(items):
        result = check(item, taken)
        if result == MavMissionResult.ACCEPTED and item.command == MavCmd.DO_JUMP and int(item.p1) >= len(items):
            result = MavMissionResult.ERROR
        if result != MavMissionResult.ACCEPTED:
            return (result, seq)
    return (MavMissionResult.ACCEPTED, -1)
