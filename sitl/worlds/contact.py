# SPDX-License-Identifier: BSD-3-Clause
"""How near a robot is to solids. The robot's volume is a vertical cylinder: a disc of some radius between two heights.

All in NED, metres. Discs and rounded rectangles both span a range of heights, so the distance of two such volumes is
made of that seen from above and that of the heights. Distances are negative where the volumes overlap: then it is the
shortest way that separates them. The normal points from the solid to the robot.

The laws work on rows of solids: a world's, or a vehicle's short list of those near it (``near``), which has the same
rows. The floor is no solid.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from functools import cache
from typing import NamedTuple

import numpy as np

from ..core.array_kernels import Kernel, Table
from ..core.kernels import law
from ..core.vectors import Vec2, Vec3
from .geometry import (
    BOTTOM,
    COS,
    EAST,
    HALF_LENGTH,
    HALF_WIDTH,
    NORTH,
    RADIUS,
    SIN,
    SOLID_COLUMNS,
    TOP,
    Floats,
    Geometry,
)

INF = math.inf
_NOTHING = 1e-100
"""A length [m] whose square is still a number."""


class Volume(NamedTuple):
    """A robot's volume, or a disc of it."""

    axis: Vec2
    """North, east [m]."""
    top: float
    """Down coordinate of its upper end [m]."""
    bottom: float
    """Down coordinate of its lower end [m], below: top < bottom."""
    radius: float
    """[m]; 0 for a line."""


class Side(NamedTuple):
    """How near a solid is, seen from above."""

    distance: float
    """[m]; negative inside."""
    normal: Vec2
    """Unit vector away from the solid: north, east."""


class Contact(NamedTuple):
    """How near a solid is."""

    distance: float
    """[m]; negative where the volumes overlap; inf: there is none."""
    normal: Vec3
    """Unit vector from the solid to the robot, NED."""
    solid: int
    """Its row, which is its number in the world's ``solids``; -1: there is none."""


class Listed(NamedTuple):
    """What ``near`` has listed."""

    rows: int
    """How many were written."""
    complete: float
    """Distance of the nearest solid that was left out [m]; inf: none was."""


@law
def beside(solids: Table, k: int, point: Vec2) -> Side:
    """How near the solid of row ``k`` is to a point (north, east [m]), seen from above."""
    c, s = solids[k, COS], solids[k, SIN]
    dn, de = point.x - solids[k, NORTH], point.y - solids[k, EAST]
    x, y = c * dn + s * de, c * de - s * dn
    side_x, side_y = 1.0 if x >= 0.0 else -1.0, 1.0 if y >= 0.0 else -1.0
    out_x, out_y = side_x * x - solids[k, HALF_LENGTH], side_y * y - solids[k, HALF_WIDTH]
    if out_x > _NOTHING and out_y > _NOTHING:
        distance = math.sqrt(out_x * out_x + out_y * out_y)
        away_x, away_y = side_x * out_x / distance, side_y * out_y / distance
    elif out_x >= out_y:
        distance, away_x, away_y = out_x, side_x, 0.0
    else:
        distance, away_x, away_y = out_y, 0.0, side_y
    return Side(distance - solids[k, RADIUS], Vec2(c * away_x - s * away_y, s * away_x + c * away_y))


@law
def separation(solids: Table, k: int, volume: Volume) -> Contact:
    """How near the solid of row ``k`` is to a robot."""
    side = beside(solids, k, volume.axis)
    away, level = side.normal, side.distance - volume.radius
    above, below = solids[k, TOP] - volume.bottom, volume.top - solids[k, BOTTOM]  # gaps when it is above, below
    upright = max(above, below)
    away_d = -1.0 if above >= below else 1.0
    if level > _NOTHING and upright > _NOTHING:
        distance = math.sqrt(level * level + upright * upright)
        share = level / distance
        return Contact(distance, Vec3(away.x * share, away.y * share, away_d * upright / distance), k)
    if level >= upright:
        return Contact(level, Vec3(away.x, away.y, 0.0), k)
    return Contact(upright, Vec3(0.0, 0.0, away_d), k)


@law
def nearest_of(solids: Table, count: int, volume: Volume) -> Contact:
    """The nearest of the first ``count`` rows."""
    nearest = Contact(INF, Vec3(0.0, 0.0, 0.0), -1)
    for k in range(count):
        contact = separation(solids, k, volume)
        if contact.distance < nearest.distance:
            nearest = contact
    return nearest


@law
def gather(solids: Table, position: Vec2, reach: float, rows: Table) -> Listed:
    """Copy the rows of the solids near a position, the nearest first, into ``rows``; see ``near``."""
    capacity, count, complete = rows.shape[0], 0, INF
    for k in range(solids.shape[0]):
        distance = beside(solids, k, position).distance
        if distance > reach:
            complete = min(complete, distance)
            continue
        row = count
        while row > 0 and beside(rows, row - 1, position).distance > distance:
            row -= 1
        if count == capacity:  # the last falls out, or the new one does not get in
            complete = min(complete, beside(rows, capacity - 1, position).distance if row < capacity else distance)
        else:
            count += 1
        if row < capacity:
            for below in range(count - 1, row, -1):
                for column in range(SOLID_COLUMNS):
                    rows[below, column] = rows[below - 1, column]
            for column in range(SOLID_COLUMNS):
                rows[row, column] = solids[k, column]
    return Listed(count, complete)


@law
def distance_of(
    solids: Table, count: int, north: float, east: float, top: float, bottom: float, radius: float
) -> float:
    """Distance to the nearest of ``count`` solids [m]; see ``distance``."""
    return nearest_of(solids, count, Volume(Vec2(north, east), top, bottom, radius)).distance


_nearest = Kernel(nearest_of)
_distance = Kernel(distance_of)
_gather = Kernel(gather)


def clearance(geometry: Geometry, north: float, east: float, top: float, bottom: float, radius: float) -> Contact:
    """The solid nearest to a robot.

    Args:
        geometry: of a world.
        north, east: axis of the robot's volume [m].
        top, bottom: down coordinates of its ends [m], top < bottom.
        radius: of the volume [m].
    """
    volume = Volume(Vec2(north, east), float(top), float(bottom), float(radius))
    found = _nearest(geometry.solids, len(geometry), volume)
    return Contact(float(found.distance), found.normal, found.solid)


@cache
def _quick() -> Callable[..., float]:
    return _distance.unchecked()


def distance(geometry: Geometry, north: float, east: float, top: float, bottom: float, radius: float) -> float:
    """How far the nearest solid is from a robot [m], below 0 inside; takes what ``clearance`` takes, and less time."""
    numbers = float(north), float(east), float(top), float(bottom), float(radius)
    return float(_quick()(geometry.solids, len(geometry), *numbers))


def near(geometry: Geometry, north: float, east: float, reach: float, rows: Floats) -> Listed:
    """The solids near a position, for a vehicle that tests contacts itself: their rows, the nearest first, into
    ``rows``.

    Args:
        geometry: of a world.
        north, east: the position [m].
        reach: distance seen from above up to which solids are listed [m].
        rows: shape (K, SOLID_COLUMNS): at most K solids are listed.

    Returns:
        How many rows were written, and the distance [m] of the nearest solid that was left out (inf: none was). As
        long as a robot's volume stays within that distance of the position it can touch only what is listed.
    """
    count, complete = _gather(geometry.solids, Vec2(north, east), reach, rows)
    return Listed(count, float(complete))


def rows(count: int) -> Floats:
    """Memory for ``near``: shape (solids, SOLID_COLUMNS)."""
    return np.zeros((count, SOLID_COLUMNS))
