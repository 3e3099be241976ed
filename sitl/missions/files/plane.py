# SPDX-License-Identifier: BSD-3-Clause
"""Geometry of mission files on a flat earth."""

from __future__ import annotations

import math

from sitl.core.elementary import hypot
from sitl.core.geodesy import add_offset, offset_ne

Location = tuple[float, float]
"""Latitude, longitude [deg]."""
Point = tuple[float, float]
"""North, east [m]."""


class Plane:
    """Flat earth around an origin, as the vehicle's own navigation has it."""

    def __init__(self, origin: Location) -> None:
        self._lat, self._lon = origin[0] * 1e7, origin[1] * 1e7

    def point(self, location: Location) -> Point:
        """Metres of a location."""
        north, east = offset_ne(self._lat, self._lon, location[0] * 1e7, location[1] * 1e7)
        return (float(north), float(east))

    def location(self, point: Point) -> Location:
        """Degrees of a point."""
        lat, lon = add_offset(self._lat, self._lon, point[0], point[1])
        return (float(lat) * 1e-7, float(lon) * 1e-7)


def along(a: Point, b: Point) -> Point:
    """Unit vector from ``a`` to ``b``; zero when they are the same."""
    north, east = b[0] - a[0], b[1] - a[1]
    length = hypot(north, east)
    return (north / length, east / length) if length > 0.0 else (0.0, 0.0)


def moved(p: Point, direction: Point, distance: float) -> Point:
    """``p`` moved by a distance [m] along a unit vector."""
    return (p[0] + direction[0] * distance, p[1] + direction[1] * distance)


def shifted(line: list[Point], distance: float, closed: bool = False) -> list[Point]:
    """A line (or the corners of a polygon) moved to its right by a distance [m], corners mitred, at most threefold."""
    count = len(line)
    moved_points = []
    for k, p in enumerate(line):
        before = line[k - 1] if closed or k > 0 else None
        after = line[(k + 1) % count] if closed or k < count - 1 else None
        into = along(before, p) if before is not None else along(p, line[k + 1])
        out = along(p, after) if after is not None else into
        right_in, right_out = (-into[1], into[0]), (-out[1], out[0])
        north, east = right_in[0] + right_out[0], right_in[1] + right_out[1]
        half = hypot(north, east) / 2.0  # cosine of half the turn
        reach = distance / max(half, 1.0 / 3.0)
        moved_points.append(moved(p, along((0.0, 0.0), (north, east)), reach))
    return moved_points


def area(polygon: list[Point]) -> float:
    """Area [m^2]; positive when its corners go round clockwise, seen from above."""
    return 0.5 * math.fsum(
        polygon[k - 1][0] * polygon[k][1] - polygon[k][0] * polygon[k - 1][1] for k in range(len(polygon))
    )
