# SPDX-License-Identifier: BSD-3-Clause
"""Fences as items (MAV_MISSION_TYPE_FENCE): which are taken, and how they become the record's areas (shell side).

https://mavlink.io/en/services/mission.html#geofence
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from typing import Any, NamedTuple

from ...core.geodesy import add_offset, offset_ne
from ...core.mavlink import MavCmd
from ...errors import SitlError
from ..events import Event, Row
from ..mission.item import MissionItem
from .state import CIRCLE_IN, CIRCLE_OUT, CORNERS, SHAPES, STAY_IN, STAY_OUT, FenceState

KINDS: dict[int, int] = {
    MavCmd.NAV_FENCE_POLYGON_VERTEX_INCLUSION: STAY_IN,
    MavCmd.NAV_FENCE_POLYGON_VERTEX_EXCLUSION: STAY_OUT,
    MavCmd.NAV_FENCE_CIRCLE_INCLUSION: CIRCLE_IN,
    MavCmd.NAV_FENCE_CIRCLE_EXCLUSION: CIRCLE_OUT,
}
POLYGONS = (MavCmd.NAV_FENCE_POLYGON_VERTEX_INCLUSION, MavCmd.NAV_FENCE_POLYGON_VERTEX_EXCLUSION)
FEWEST_CORNERS = 3
_TYPES: dict[int, int] = {
    MavCmd.NAV_FENCE_POLYGON_VERTEX_INCLUSION: 98,
    MavCmd.NAV_FENCE_POLYGON_VERTEX_EXCLUSION: 97,
    MavCmd.NAV_FENCE_RETURN_POINT: 95,
    MavCmd.NAV_FENCE_CIRCLE_EXCLUSION: 93,
    MavCmd.NAV_FENCE_CIRCLE_INCLUSION: 92,
}
"""How ArduPilot's texts name kinds of items."""


class Shape(NamedTuple):
    """One area."""

    kind: int
    radius: float
    """Of a circle [m]."""
    locations: tuple[tuple[int, int], ...]
    """Latitude and longitude [degE7] of its corners, or of a circle's centre."""


class FenceError(SitlError, ValueError):
    """Items that make no fence; the text is the pilot's."""


def shapes(items: Sequence[MissionItem]) -> Iterator[Shape]:
    """The areas that a list of items describes; the point of return is none.

    Raises:
        FenceError: they make none.
    """
    k, returns = 0, 0
    while k < len(items):
        item = items[k]
        count = int(item.p1) if item.command in POLYGONS else 1
        if item.command == MavCmd.NAV_FENCE_RETURN_POINT:
            returns += 1
            if returns > 1:
                raise FenceError("Multiple return points")
        elif item.command in POLYGONS:
            own = items[k : k + count]
            if count < FEWEST_CORNERS:
                raise FenceError(f"Invalid vertex count ({count})")
            for other in own:
                if other.command != item.command:
                    wanted, got = _TYPES[item.command], _TYPES[other.command]
                    raise FenceError(f"Received incorrect vertex type (want={wanted} got={got})")
                if int(other.p1) != count:
                    raise FenceError(f"Unexpected vertex count want={count} got={int(other.p1)}")
            if len(own) < count:
                raise FenceError("Incorrect item count")
            yield Shape(KINDS[item.command], 0.0, tuple((other.x, other.y) for other in own))
        else:
            if not item.p1 > 0.0:
                raise FenceError("Non-positive circle radius")
            yield Shape(KINDS[item.command], item.p1, ((item.x, item.y),))
        k += count


def load(fence: FenceState, areas: Sequence[Shape]) -> None:
    """Put areas into the record, instead of those that are there.

    Raises:
        FenceError: there is no space for them; those of before stay.
    """
    if len(areas) > SHAPES or sum(len(area.locations) for area in areas) > CORNERS:
        raise FenceError("Fence exceeds storage size")
    fence.shapes = fence.corners = 0
    fence.is_placed = False
    if areas:
        fence.reference_lat, fence.reference_lon = areas[0].locations[0]
    for s, area in enumerate(areas):
        fence.kind[s], fence.radius[s] = area.kind, area.radius
        fence.first[s], fence.count[s] = fence.corners, len(area.locations)
        for lat, lon in area.locations:
            position = offset_ne(fence.reference_lat, fence.reference_lon, lat, lon)
            fence.north[fence.corners], fence.east[fence.corners] = position.x, position.y
            fence.corners += 1
    fence.shapes = len(areas)


def stored_bytes(items: Sequence[MissionItem], areas: Sequence[Shape]) -> int:
    """Bytes that a list takes in ArduPilot's storage: its size depends on the board, not on this record."""
    total = 5 + sum(9 for item in items if item.command == MavCmd.NAV_FENCE_RETURN_POINT)
    return total + sum(13 if area.radius > 0.0 else 2 + 8 * len(area.locations) for area in areas)


_LOGGED_KINDS = {STAY_IN: 98, STAY_OUT: 97, CIRCLE_IN: 92, CIRCLE_OUT: 93}
"""Kind of area -> Type of FNCE."""


def rows(v: Any, a: float = 0.0, b: float = 0.0) -> list[Row]:
    """FNCE of each corner, and of each circle's centre."""
    fence, found = v.autopilot.fence, list[Row]()
    for s in range(fence.shapes):
        kind, first = int(fence.kind[s]), int(fence.first[s])
        is_round = kind in (CIRCLE_IN, CIRCLE_OUT)
        for k in range(first, first + int(fence.count[s])):
            at = add_offset(fence.reference_lat, fence.reference_lon, float(fence.north[k]), float(fence.east[k]))
            size = (0, float(fence.radius[s])) if is_round else (int(fence.count[s]) & 255, 0.0)
            location = (round(at.lat), round(at.lon))
            found.append(("FNCE", (fence.corners & 255, k & 255, _LOGGED_KINDS[kind], *location, *size)))
    return found


FENCE_LOADED = Event(73, log=rows)
