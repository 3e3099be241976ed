# SPDX-License-Identifier: BSD-3-Clause
"""Writes navigation commands, and the legs they need, to the record; the modes fly them."""

from __future__ import annotations

import math
from typing import Any

from ..modes.copter import auto
from ..navigation import planner
from ..navigation import state as kinds
from ..navigation.profile import clear
from . import item as commands
from .item import MissionItem
from .place import Point, down, point

EDGE = 3.0
"""A vehicle this near to the circle starts it where it is [m]."""

WIDEST = 2550.0
"""Greatest radius of circles that ArduPilot's mission storage holds [m]."""

KINDS = {
    commands.NAV_TAKEOFF: kinds.TAKEOFF,
    commands.NAV_WAYPOINT: kinds.WAYPOINT,
    commands.NAV_LOITER_UNLIM: kinds.LOITER_UNLIMITED,
    commands.NAV_LOITER_TURNS: kinds.LOITER_TURNS,
    commands.NAV_LOITER_TIME: kinds.LOITER_TIME,
    commands.NAV_RETURN_TO_LAUNCH: kinds.RTL,
    commands.NAV_LAND: kinds.LAND,
    commands.NAV_DELAY: kinds.DELAY,
}


def give(v: Any, seq: int, item: MissionItem) -> None:
    """Make ``item`` the command under way."""
    ap, time_us = v.autopilot, int(v.time_us)
    nav = ap.modes.nav
    kind = KINDS[item.command]
    auto.face(v, kind)
    here, _ = planner.origin_of_next(ap, time_us)
    if kind in (kinds.WAYPOINT, kinds.LOITER_UNLIMITED, kinds.LOITER_TIME):
        planner.begin(ap, time_us, point(ap, item, here))
    elif kind == kinds.DELAY:
        planner.begin(ap, time_us, here)
    elif kind == kinds.LOITER_TURNS:
        _circle(ap, time_us, item, here)
    elif kind == kinds.LAND and not item.no_place:
        north, east, _ = point(ap, item, here)
        planner.begin(ap, time_us, (north, east, here[2]))  # at the present height
    else:
        _end_path(nav)
        height = down(ap, item) if kind == kinds.TAKEOFF else here[2]
        nav.target[0], nav.target[1], nav.target[2] = here[0], here[1], height
    _write(nav, kind, seq)
    nav.has_place = 0 if item.no_place else 1
    if kind in (kinds.WAYPOINT, kinds.LOITER_TIME):
        nav.delay = float(int(min(max(item.p1, 0.0), 65535.0)))  # whole seconds
    elif kind == kinds.DELAY:
        nav.delay = max(item.p1, 0.0)
    elif kind == kinds.LOITER_TURNS:
        nav.turns = max(item.p1, 0.0)


def give_hold(v: Any) -> None:
    """Stay where the vehicle would come to rest (end of a mission in the air)."""
    ap, time_us = v.autopilot, int(v.time_us)
    planner.begin(ap, time_us, planner.origin_of_next(ap, time_us)[0])
    _write(ap.modes.nav, kinds.LOITER_UNLIMITED, int(ap.modes.nav.command_seq))


def give_none(nav: Any) -> None:
    """No command under way."""
    _write(nav, kinds.NONE, 0)


def look_ahead(ap: Any, item: MissionItem | None) -> None:
    """Plan the leg to the following navigation command when the vehicle flies through without a stop.

    The current one must be a waypoint without delay, the next one a leg to a place.
    """
    nav = ap.modes.nav
    if nav.command_kind != kinds.WAYPOINT or nav.delay > 0.0:
        return
    through = item is not None and KINDS[item.command] in (
        kinds.WAYPOINT,
        kinds.LOITER_UNLIMITED,
        kinds.LOITER_TIME,
    )
    corner = planner.end(nav.current)
    planner.look_ahead(ap, point(ap, item, corner) if item is not None and through else None)


def _write(nav: Any, kind: int, seq: int) -> None:
    nav.command_kind, nav.command_seq = kind, seq
    nav.command_count += 1
    nav.completed, nav.since_us, nav.circle_running = 0, 0, 0
    nav.has_place, nav.delay, nav.turns = 0, 0.0, 0.0


def _end_path(nav: Any) -> None:
    clear(nav.previous)
    clear(nav.current)
    clear(nav.next)
    nav.reached = nav.fresh = 0
    nav.active_us = 0


def _circle(ap: Any, time_us: int, item: MissionItem, here: Point) -> None:
    """The leg to the nearest point of the circle, none when it is near."""
    nav = ap.modes.nav
    centre = point(ap, item, here)
    radius = item.p3 if item.p3 != 0.0 else 0.01 * float(ap.params.CIRCLE_RADIUS)
    radius = min(max(radius, -WIDEST), WIDEST)
    n, e = float(ap.estimate.pos[0]) - centre[0], float(ap.estimate.pos[1]) - centre[1]
    away = math.hypot(n, e)
    if away < 0.01:  # from the centre straight back, so that it looks ahead
        yaw = float(ap.estimate.euler[2]) + math.pi
        n, e, away = math.cos(yaw), math.sin(yaw), 1.0
        distance = abs(radius)
    else:
        distance = abs(away - abs(radius))
    edge = (centre[0] + n / away * abs(radius), centre[1] + e / away * abs(radius), centre[2])
    if max(distance, abs(centre[2] - here[2])) > EDGE:
        planner.begin(ap, time_us, edge)
    else:
        planner.begin(ap, time_us, here)
        nav.reached = 1
    nav.circle_radius = radius
    for k in range(3):
        nav.circle_centre[k] = centre[k]
        nav.target[k] = centre[k]
