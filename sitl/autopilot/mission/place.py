# SPDX-License-Identifier: BSD-3-Clause
"""Where an item is, in NED metres from the EKF origin."""

from __future__ import annotations

from typing import Any

from ...core.geodesy import offset_ne
from .item import RELATIVE_FRAMES, TERRAIN_FRAMES, MissionItem

Point = tuple[float, float, float]


def down(ap: Any, item: MissionItem) -> float:
    """Down coordinate of an item's altitude [m].

    Altitudes above terrain count from home's height: the ground is flat here.
    """
    if item.frame in RELATIVE_FRAMES or item.frame in TERRAIN_FRAMES:
        return float(ap.home.pos[2]) - item.z
    return float(ap.estimate.origin_alt) - item.z


def point(ap: Any, item: MissionItem, default: Point) -> Point:
    """Place of an item; latitude and longitude zero, or altitude zero,
    take the default's (as ArduPilot does).
    """
    north, east = default[0], default[1]
    if not item.no_place:
        north, east = offset_ne(int(ap.estimate.origin_lat), int(ap.estimate.origin_lon), item.x, item.y)
    return (float(north), float(east), default[2] if item.z == 0.0 else down(ap, item))
