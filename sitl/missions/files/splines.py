# SPDX-License-Identifier: BSD-3-Clause
"""Spline waypoints as waypoints, for vehicles that have no NAV_SPLINE_WAYPOINT (rovers).

The curve from one location to the next is a cubic Hermite spline. At a spline waypoint it goes in the direction from
the location before to the location after; where it meets a straight leg it goes along that leg; at its very ends
straight on.
"""

from __future__ import annotations

import math
from dataclasses import replace

from sitl.autopilot.mission.item import MissionItem
from sitl.autopilot.mission.mission import Mission, MissionError
from sitl.core.mavlink import MavCmd
from sitl.core.sums import separation

from .document import MissionFile, MissionFileError
from .plane import Plane

PIECE = 5.0
"""A curve is cut into pieces of about this length [m], at least two; shorter ones make the vehicle slow."""
PIECES_MAX = 24
_LOCATED = (MavCmd.NAV_WAYPOINT, MavCmd.NAV_SPLINE_WAYPOINT, MavCmd.NAV_LOITER_TIME, MavCmd.NAV_LOITER_UNLIM)

Point = tuple[float, float, float]


def straightened(file: MissionFile) -> MissionFile:
    """The mission with waypoints along its curves; jumps keep their targets.

    Raises:
        MissionFileError: a spline waypoint without a location, or more items than a mission holds.
    """
    items = file.mission.items
    if not any(item.command == MavCmd.NAV_SPLINE_WAYPOINT for item in items):
        return file
    plane = Plane((items[0].x * 1e-7, items[0].y * 1e-7))
    new: list[MissionItem] = []
    numbers: dict[int, int] = {}
    for seq, item in enumerate(items):
        numbers[seq] = len(new)
        if item.command != MavCmd.NAV_SPLINE_WAYPOINT:
            new.append(item)
            continue
        if item.no_location:
            raise MissionFileError(f"{file.name}: item {seq}: a spline waypoint needs a latitude and a longitude")
        for point in _curve(items, seq, plane)[:-1]:
            lat, lon = plane.location(point[:2])
            new.append(
                MissionItem(
                    MavCmd.NAV_WAYPOINT, item.frame, p4=item.p4, x=round(lat * 1e7), y=round(lon * 1e7), z=point[2]
                )
            )
        new.append(item._replace(command=MavCmd.NAV_WAYPOINT))
    numbers[len(items)] = len(new)
    jumped = [i._replace(p1=float(numbers.get(int(i.p1), i.p1))) if i.command == MavCmd.DO_JUMP else i for i in new]
    complexes = tuple(replace(c, first=numbers[c.first]) for c in file.complexes)
    try:
        return replace(file, mission=Mission.of(jumped), complexes=complexes)
    except MissionError as error:
        raise MissionFileError(f"{file.name}: with its splines as waypoints: {error}") from None


def _curve(items: tuple[MissionItem, ...], seq: int, plane: Plane) -> list[Point]:
    """Points on the way to a spline waypoint, its own location last."""
    end = _point(items[seq], plane)
    start = _neighbour(items, seq, -1, plane)
    if start is None:  # its first location: straight there
        return [end]
    chord = separation(start, end)
    before, after = _start_direction(items, seq, plane), _end_direction(items, seq, start, plane)
    away = tuple(chord * x for x in before or _unit(start, end))
    into = tuple(chord * x for x in after or _unit(start, end))
    pieces = min(max(2, math.ceil(chord * 1.1 / PIECE)), PIECES_MAX)
    return [_hermite(start, away, end, into, k / pieces) for k in range(1, pieces)] + [end]


def _start_direction(items: tuple[MissionItem, ...], seq: int, plane: Plane) -> Point | None:
    """Direction at the start of the curve to item ``seq``; None: undefined."""
    k = _beside(items, seq, -1)
    if k is None or items[k].p1 > 0.0:  # it waits there
        return None
    before, here = _neighbour(items, k, -1, plane), _point(items[k], plane)
    if before is None:
        return None
    ahead = _point(items[seq], plane) if items[k].command == MavCmd.NAV_SPLINE_WAYPOINT else here
    return _unit(before, ahead)


def _end_direction(items: tuple[MissionItem, ...], seq: int, start: Point, plane: Plane) -> Point | None:
    """Direction at the end of the curve to item ``seq``."""
    k = _beside(items, seq, 1)
    if k is None or items[seq].p1 > 0.0:
        return None
    behind = start if items[k].command == MavCmd.NAV_SPLINE_WAYPOINT else _point(items[seq], plane)
    return _unit(behind, _point(items[k], plane))


def _beside(items: tuple[MissionItem, ...], seq: int, step: int) -> int | None:
    """The next item with a location of its own in the list, in one direction; another navigation command ends it."""
    k = seq + step
    while 0 < k < len(items):
        if items[k].is_nav:
            return k if items[k].command in _LOCATED and not items[k].no_location else None
        k += step
    return None


def _neighbour(items: tuple[MissionItem, ...], seq: int, step: int, plane: Plane) -> Point | None:
    k = _beside(items, seq, step)
    return None if k is None else _point(items[k], plane)


def _point(item: MissionItem, plane: Plane) -> Point:
    return (*plane.point((item.x * 1e-7, item.y * 1e-7)), item.z)


def _unit(a: Point, b: Point) -> Point:
    length = separation(a, b)
    return tuple((y - x) / length for x, y in zip(a, b)) if length > 0.0 else (0.0, 0.0, 0.0)  # type: ignore[return-value]


def _hermite(a: Point, away: tuple[float, ...], b: Point, into: tuple[float, ...], u: float) -> Point:
    """Point at ``u`` (0 .. 1) of the curve from a to b with these directions at its ends."""
    h1, h2 = (1.0 + 2.0 * u) * (1.0 - u) * (1.0 - u), u * (1.0 - u) * (1.0 - u)
    h3, h4 = u * u * (3.0 - 2.0 * u), u * u * (u - 1.0)
    return tuple(h1 * p + h2 * q + h3 * r + h4 * s for p, q, r, s in zip(a, away, b, into))  # type: ignore[return-value]
