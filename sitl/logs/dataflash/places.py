# SPDX-License-Identifier: BSD-3-Clause
"""FNCE and RALY: areas and rally points that are loaded; OABR and OADJ: ways around fences and objects."""

from __future__ import annotations

import math
from typing import Any

from ...autopilot import events
from ...autopilot.fence.state import CIRCLE_IN, CIRCLE_OUT, STAY_IN, STAY_OUT
from ...core.algebra import vector_at
from ...core.elementary import atan2, hypot
from ...core.geodesy import add_offset
from ...core.vectors import Vec3
from .system_id import Row

_AREAS = {STAY_IN: 98, STAY_OUT: 97, CIRCLE_IN: 92, CIRCLE_OUT: 93}
"""Kind of area -> Type of FNCE."""
_FOUND, _ERROR, _NO_WAY = 2, 3, 2
"""State and Err of OADJ."""
_FROM_HOME = 12
_FROM_SEA = 4
"""Flags of RALY: its height is one, above home or mean sea level."""


def fence(v: Any) -> list[Row]:
    """FNCE of each corner, and of each circle's centre."""
    fence, rows = v.autopilot.fence, list[Row]()
    for s in range(fence.shapes):
        kind, first = int(fence.kind[s]), int(fence.first[s])
        is_round = kind in (CIRCLE_IN, CIRCLE_OUT)
        for k in range(first, first + int(fence.count[s])):
            at = add_offset(fence.reference_lat, fence.reference_lon, float(fence.north[k]), float(fence.east[k]))
            size = (0, float(fence.radius[s])) if is_round else (int(fence.count[s]) & 255, 0.0)
            rows.append(("FNCE", (fence.corners & 255, k & 255, _AREAS[kind], round(at.lat), round(at.lon), *size)))
    return rows


def rally(v: Any) -> list[Row]:
    """RALY of each point that counts."""
    points, total = v.autopilot.rally, min(int(v.autopilot.params.RALLY.TOTAL), len(v.autopilot.rally.lat))
    return [
        ("RALY", (total, k, int(points.lat[k]), int(points.lon[k]), min(max(int(points.alt[k]), -32768), 32767),
                  _FROM_SEA if points.is_amsl[k] else _FROM_HOME))
        for k in range(total)
    ]  # fmt: skip


def rows(v: Any, code: int, a: float, b: float) -> list[Row]:
    """The messages of an event that has just come, as the vehicle's record ``v`` is."""
    if code == events.FENCE_LOADED:
        return fence(v)
    if code == events.RALLY_LOADED:
        return rally(v)
    if code == events.BENDY_RULER_LOOKED:
        return [("OABR", _ruler(v, a, int(b)))]
    if code in (events.WAY_LAID, events.NO_WAY):
        return [("OADJ", _way(v, code == events.NO_WAY))]
    return []


def _degrees(v: Any, place: Vec3) -> tuple[int, int]:
    at = add_offset(v.autopilot.estimate.origin_lat, v.autopilot.estimate.origin_lon, place.x, place.y)
    return round(at.lat), round(at.lon)


def _bearing(angle: float) -> int:
    return round(math.degrees(angle)) % 360


def _ruler(v: Any, margin: float, how: int) -> tuple[float, ...]:
    ap = v.autopilot
    nav, here, home = ap.modes.nav, ap.estimate.pos, ap.home.pos.z
    upright = getattr(ap.params.OA, "BR_TYPE", 1.0) == 2.0  # a copter's
    target = nav.detour.bent_target
    towards = atan2(nav.target.y - here.y, nav.target.x - here.x)
    slope = _bearing(atan2(here.z - target.z, hypot(target.x - here.x, target.y - here.y))) if upright else 0
    numbers = (2 if upright else 1, how & 1, _bearing(towards), _bearing(ap.estimate.yaw), slope, how >> 1, margin)
    places = (*_degrees(v, nav.target), home - nav.target.z, *_degrees(v, target), home - target.z)
    return (*numbers, *places)


def _way(v: Any, is_closed: bool) -> tuple[float, ...]:
    nav = v.autopilot.modes.nav
    detour = nav.detour
    goal = vector_at(detour.places, 0) if detour.left > 0 else nav.target
    state = (_ERROR, _NO_WAY, 0, 0) if is_closed else (_FOUND, 0, 1, min(detour.left + 2, 255))
    return (*state, *_degrees(v, goal), *_degrees(v, nav.target))
