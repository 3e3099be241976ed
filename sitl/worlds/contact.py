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
from dataclasses import dataclass

import numpy as np

from ..core.array_kernels import kernel
from ..core.kernels import law
from .geometry import (
    BOTTOM,
    COS,
    EAST,
    HALF_LENGTH,
    HALF_WIDTH,
    NORTH,
    RADIUS,
    SIN,
    SOLID_FIGURES,
    TOP,
    Floats,
    Geometry,
)

INF = math.inf
_NOTHING = 1e-100
"""A length [m] whose square is still a number."""


@law
def beside(solids, k, n, e):
    """Signed distance seen from above from a point to the solid of row ``k``, and the unit vector away from it.

    Returns (distance, north, east).
    """
    c, s = solids[k, COS], solids[k, SIN]
    dn, de = n - solids[k, NORTH], e - solids[k, EAST]
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
    return (distance - solids[k, RADIUS], c * away_x - s * away_y, s * away_x + c * away_y)


@law
def separation(solids, k, n, e, top, bottom, radius):
    """Signed distance from a robot to the solid of row ``k``, with the normal: (distance, north, east, down).

    Args:
        solids: rows.
        k: number of the row.
        n, e: axis of the robot's volume.
        top, bottom: down coordinates of its ends, top < bottom.
        radius: of the volume; 0 for a line.
    """
    level, away_n, away_e = beside(solids, k, n, e)
    level -= radius
    above, below = solids[k, TOP] - bottom, top - solids[k, BOTTOM]  # gaps when the robot is above it, below it
    upright = max(above, below)
    away_d = -1.0 if above >= below else 1.0
    if level > _NOTHING and upright > _NOTHING:
        distance = math.sqrt(level * level + upright * upright)
        share = level / distance
        return (distance, away_n * share, away_e * share, away_d * upright / distance)
    if level >= upright:
        return (level, away_n, away_e, 0.0)
    return (upright, 0.0, 0.0, away_d)


@law
def nearest_of(solids, count, n, e, top, bottom, radius):
    """The nearest of the first ``count`` rows: (distance, north, east, down of the normal, row).

    The distance is inf and the row -1 when there is none.
    """
    distance, away_n, away_e, away_d, row = INF, 0.0, 0.0, 0.0, -1
    for k in range(count):
        apart, north, east, down = separation(solids, k, n, e, top, bottom, radius)
        if apart < distance:
            distance, away_n, away_e, away_d, row = apart, north, east, down, k
    return (distance, away_n, away_e, away_d, row)


@law
def gather(solids, n, e, reach, rows):
    """Copy the rows of the solids near a point, the nearest first, into ``rows``: (count, complete); see ``near``."""
    room, count, complete = rows.shape[0], 0, INF
    for k in range(solids.shape[0]):
        distance, _, _ = beside(solids, k, n, e)
        if distance > reach:
            complete = min(complete, distance)
            continue
        place = count
        while place > 0:
            before, _, _ = beside(rows, place - 1, n, e)
            if before <= distance:
                break
            place -= 1
        if count == room:  # the last falls out, or the new one does not get in
            last = distance
            if place < room:
                last, _, _ = beside(rows, room - 1, n, e)
            complete = min(complete, last)
        else:
            count += 1
        if place < room:
            for below in range(count - 1, place, -1):
                for figure in range(SOLID_FIGURES):
                    rows[below, figure] = rows[below - 1, figure]
            for figure in range(SOLID_FIGURES):
                rows[place, figure] = solids[k, figure]
    return (count, complete)


_nearest = kernel("Tuple((f8, f8, f8, f8, i8))(f8[:,::1], i8, f8, f8, f8, f8, f8)")(nearest_of)
_gather = kernel("Tuple((i8, f8))(f8[:,::1], f8, f8, f8, f8[:,::1])")(gather)


@dataclass(frozen=True)
class Clearance:
    """How far a robot is from the nearest solid."""

    distance: float
    """[m]; negative: they overlap by so much; inf: there is no solid."""
    normal: tuple[float, float, float]
    """From the solid to the robot: north, east, down; a unit vector."""
    solid: int
    """Its number in the world's ``solids``; -1: there is none."""


def clearance(geometry: Geometry, north: float, east: float, top: float, bottom: float, radius: float) -> Clearance:
    """The solid nearest to a robot.

    Args:
        geometry: of a world.
        north, east: axis of the robot's volume [m].
        top, bottom: down coordinates of its ends [m], top < bottom.
        radius: of the volume [m].
    """
    distance, n, e, d, row = _nearest(geometry.solids, len(geometry), north, east, top, bottom, radius)
    return Clearance(float(distance), (float(n), float(e), float(d)), int(row))


def near(geometry: Geometry, north: float, east: float, reach: float, rows: Floats) -> tuple[int, float]:
    """The solids near a place, for a vehicle that tests contacts itself: their rows, the nearest first, into ``rows``.

    Args:
        geometry: of a world.
        north, east: the place [m].
        reach: distance seen from above up to which solids are listed [m].
        rows: shape (K, SOLID_FIGURES): at most K solids are listed.

    Returns:
        How many rows were written, and the distance [m] of the nearest solid that was left out (inf: none was). As
        long as a robot's volume stays within that distance of the place it can touch only what is listed.
    """
    count, complete = _gather(geometry.solids, north, east, reach, rows)
    return int(count), float(complete)


def rows(count: int) -> Floats:
    """Room for ``near``."""
    return np.zeros((count, SOLID_FIGURES))
