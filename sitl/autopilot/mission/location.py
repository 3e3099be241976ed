# SPDX-License-Identifier: BSD-3-Clause
"""Where an item is, in NED metres from the EKF origin; home as an item sets it."""

from __future__ import annotations

from ...core.geodesy import offset_ne
from ...core.vectors import Vec3
from .. import home
from ..state import Autopilot
from .item import RELATIVE_FRAMES, TERRAIN_FRAMES, MissionItem


def down(ap: Autopilot, item: MissionItem) -> float:
    """Down coordinate of an item's altitude [m].

    Altitudes above terrain count from home's height: the ground is flat here.
    """
    if item.frame in RELATIVE_FRAMES or item.frame in TERRAIN_FRAMES:
        return ap.home.pos.z - item.z
    return ap.estimate.origin_alt - item.z


def point(ap: Autopilot, item: MissionItem, default: Vec3) -> Vec3:
    """Location of an item; latitude and longitude zero, or altitude zero, take the default's (as ArduPilot does)."""
    north, east = default.x, default.y
    if not item.no_location:
        north, east = offset_ne(ap.estimate.origin_lat, ap.estimate.origin_lon, item.x, item.y)
    return Vec3(north, east, default.z if item.z == 0.0 else down(ap, item))


def set_home(ap: Autopilot, item: MissionItem) -> None:
    """DO_SET_HOME: to where the vehicle is (parameter 1 is 1, or no location), else to the item's location. Unlike a
    client's, it does not keep home from being moved by the next arming (ArduPilot's ``set_home(location, false)``)."""
    state, estimate = ap.home, ap.estimate
    locked = state.locked
    if item.p1 == 1.0 or (item.no_location and item.z == 0.0):
        home.set_here(state, estimate)
    else:
        home.set_location(state, estimate, item.x, item.y, estimate.origin_alt - down(ap, item))
    state.locked = locked
