# SPDX-License-Identifier: BSD-3-Clause
"""What a world looks like cut at a height: footprints, and the outline of all that is solid there.

In the frame of world files (x forward, y left), metres. For drawing: rays and contacts do not use it. Circles are
polygons here.
"""

from __future__ import annotations

import numpy as np

from ..core.sums import lengths, products
from .shapes import Array
from .world import World

_SEAM = 0.0005
"""Solids that stand this near to each other count as joined, and lesser parts of edges are left out [m]."""
_NEAR = 20.0 * _SEAM
"""Polygons that stand farther apart than this, seen along x or y, hide nothing of each other [m]."""
_PARALLEL = 0.99


def footprints(world: World, height: float) -> list[Array]:
    """Convex polygons, each shape (n, 2), counter-clockwise, of the solids that span the height [m]."""
    return [solid.footprint() for solid in world.solids if solid.low <= height <= solid.high]


def outline(world: World, height: float) -> Array:
    """Segments (x1, y1, x2, y2), shape (n, 4), round the union of what is solid at the height [m].

    The solid lies left of each segment.
    """
    polygons = footprints(world, height)
    low = np.array([polygon.min(axis=0) for polygon in polygons]).reshape(-1, 2)
    high = np.array([polygon.max(axis=0) for polygon in polygons]).reshape(-1, 2)
    kept = []
    for number, polygon in enumerate(polygons):
        meets = ((low <= high[number] + _NEAR) & (high >= low[number] - _NEAR)).all(axis=1)
        others = [(polygons[k], k < number) for k in np.flatnonzero(meets).tolist() if k != number]
        for start, end in zip(polygon, np.roll(polygon, -1, axis=0)):
            edge = end - start
            shortest = _SEAM / lengths(edge)
            kept += [
                (*(start + a * edge), *(start + b * edge)) for a, b in _outside(start, edge, others) if b - a > shortest
            ]
    return np.array(kept).reshape(-1, 4)


def _outside(start: Array, edge: Array, others: list[tuple[Array, bool]]) -> list[tuple[float, float]]:
    """Which parts of an edge, from 0 to 1, lie in none of the polygons; each with whether it owns a common edge."""
    parts = [(0.0, 1.0)]
    for polygon, owner in others:
        low, high = _inside(start, edge, polygon, owner)
        if low < high:
            parts = [p for a, b in parts for p in ((a, min(b, low)), (max(a, high), b)) if p[0] < p[1]]
    return parts


def _inside(start: Array, edge: Array, polygon: Array, owner: bool) -> tuple[float, float]:
    """From where to where an edge lies inside of a convex polygon, from 0 to 1; nowhere when the first is greater."""
    low, high = 0.0, 1.0
    for corner, following in zip(polygon, np.roll(polygon, -1, axis=0)):
        side = (following - corner) / lengths(following - corner)
        along = products(side, edge) / lengths(edge)
        grown = 0.0
        if abs(along) > _PARALLEL:  # back to back neither is outside; face on face one of them is
            grown = _SEAM if along < 0.0 or owner else -_SEAM
        depth = side[0] * (start - corner)[1] - side[1] * (start - corner)[0] + grown
        change = side[0] * edge[1] - side[1] * edge[0]
        if change == 0.0:
            if depth <= 0.0:
                return 1.0, 0.0
        elif change > 0.0:
            low = max(low, -depth / change)
        else:
            high = min(high, -depth / change)
    return low, high
