# SPDX-License-Identifier: BSD-3-Clause
"""Runs do-commands and starts conditions."""

from __future__ import annotations

import math
from typing import Any

from ...core.geodesy import add_offset
from ..modes.copter import auto_yaw
from ..navigation import planner
from ..navigation.state import CONDITION_DELAY, CONDITION_DISTANCE, CONDITION_YAW
from . import item as commands
from .item import MissionItem
from .place import down, point

CLIMB_SPEED, DESCENT_SPEED = 2, 3
"""SPEED_TYPE of DO_CHANGE_SPEED; 0 and 1 are both horizontal."""


def run(v: Any, item: MissionItem) -> None:
    """Run a do-command, or start a condition: then ``nav.condition_kind`` is not zero until it is met."""
    ap = v.autopilot
    nav = ap.modes.nav
    if item.command == commands.DO_CHANGE_SPEED:
        change_speed(ap, int(item.p1), item.p2)
    elif item.command == commands.CONDITION_DELAY:
        nav.condition_kind = CONDITION_DELAY
        nav.condition_until_us = int(v.time_us) + round(min(max(item.p1, 0.0), 1e9) * 1e6)
    elif item.command == commands.CONDITION_DISTANCE:
        nav.condition_kind = CONDITION_DISTANCE
        nav.condition_distance = item.p1
    elif item.command == commands.CONDITION_YAW:
        direction = int(math.copysign(1.0, item.p3)) if item.p3 else 0
        auto_yaw.fixed(v, math.radians(item.p1), math.radians(item.p2), direction, 1 if item.p4 > 0.0 else 0)
        nav.condition_kind = CONDITION_YAW
    elif item.command in (commands.DO_SET_ROI, commands.DO_SET_ROI_LOCATION):
        set_roi(v, item)
    elif item.command == commands.DO_SET_ROI_NONE:
        auto_yaw.set_default(v, 0)
    elif item.command == commands.DO_SET_HOME:
        set_home(ap, item)


def change_speed(ap: Any, kind: int, speed: float) -> None:
    """DO_CHANGE_SPEED: limits of the legs from now on, until AUTO is left;
    a speed of 0 or less changes nothing.
    """
    if not speed > 0.0:
        return
    nav = ap.modes.nav
    if kind == CLIMB_SPEED:
        nav.speed_up = speed
    elif kind == DESCENT_SPEED:
        nav.speed_down = speed
    else:
        nav.speed_ne = speed
    planner.change_speed(ap)


def set_roi(v: Any, item: MissionItem) -> None:
    """Keep the nose on a place; a place of zeros ends that."""
    if item.no_place and item.z == 0.0:
        auto_yaw.set_default(v, 0)
        return
    here = tuple(float(x) for x in v.autopilot.estimate.pos)
    auto_yaw.look_at(v, *point(v.autopilot, item, here))  # type: ignore[arg-type]


def set_home(ap: Any, item: MissionItem) -> None:
    """DO_SET_HOME: to where the vehicle is (parameter 1 is 1, or no place), else to the item's place."""
    home, estimate = ap.home, ap.estimate
    if estimate.origin_set == 0:
        return
    if item.p1 == 1.0 or (item.no_place and item.z == 0.0):
        n, e, d = (float(x) for x in estimate.pos)
        lat, lon = add_offset(int(estimate.origin_lat), int(estimate.origin_lon), n, e)
    else:
        d = down(ap, item)
        n, e, _ = point(ap, item, (0.0, 0.0, d))
        lat, lon = item.x, item.y
    home.lat, home.lon, home.alt = round(lat), round(lon), float(estimate.origin_alt) - d
    home.pos[0], home.pos[1], home.pos[2] = n, e, d
    home.is_set = home.locked = 1
