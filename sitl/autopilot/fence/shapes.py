# SPDX-License-Identifier: BSD-3-Clause
"""The areas of the fence: which are there, on which side of them a point is, and how far from their edges.

Laws on the record; points are metres north and east of the estimator's origin. ``for s in range(fence.shapes)`` goes
over all areas, where ``fence.is_placed``.
"""

from __future__ import annotations

from ...core.algebra import dot2, norm2
from ...core.geodesy import add_offset, offset_ne
from ...core.kernels import law
from ...core.vectors import Vec2
from ..state import Estimate
from .state import CIRCLE_IN, CIRCLE_OUT, STAY_IN, FenceState


@law
def is_circle(fence: FenceState, s: int) -> bool:
    """Whether area ``s`` is a circle, else it is a polygon."""
    return fence.kind[s] == CIRCLE_IN or fence.kind[s] == CIRCLE_OUT


@law
def is_inclusion(fence: FenceState, s: int) -> bool:
    """Whether area ``s`` is to stay in, else it is to stay out of."""
    return fence.kind[s] == STAY_IN or fence.kind[s] == CIRCLE_IN


@law
def corner(fence: FenceState, k: int) -> Vec2:
    """Corner ``k`` of all [m]."""
    return Vec2(float(fence.north[k]), float(fence.east[k]))


@law
def centre(fence: FenceState, s: int) -> Vec2:
    """Centre of circle ``s`` [m]."""
    return corner(fence, int(fence.first[s]))


@law
def corner_of(fence: FenceState, s: int, k: int) -> Vec2:
    """Corner ``k`` of polygon ``s`` [m]; behind the last one comes the first again."""
    return corner(fence, int(fence.first[s]) + k % int(fence.count[s]))


@law
def is_in_polygon(fence: FenceState, s: int, point: Vec2) -> bool:
    """Whether a point is within polygon ``s``: whether a ray from it to the east meets an odd number of edges."""
    inside = False
    for k in range(int(fence.count[s])):
        a, b = corner_of(fence, s, k), corner_of(fence, s, k + 1)
        if (a.x > point.x) != (b.x > point.x):
            if point.y < a.y + (b.y - a.y) * ((point.x - a.x) / (b.x - a.x)):
                inside = not inside
    return inside


@law
def is_within(fence: FenceState, s: int, point: Vec2) -> bool:
    """Whether a point is within area ``s``."""
    if is_circle(fence, s):
        return norm2(point - centre(fence, s)) <= float(fence.radius[s])
    return is_in_polygon(fence, s, point)


@law
def nearest_on_segment(a: Vec2, b: Vec2, point: Vec2) -> Vec2:
    """The point of the line from ``a`` to ``b`` that is nearest to another one."""
    edge = b - a
    length = dot2(edge, edge)
    if length <= 0.0:
        return a
    return a + edge * min(max(dot2(point - a, edge) / length, 0.0), 1.0)


@law
def nearest_on_edge(fence: FenceState, s: int, point: Vec2) -> Vec2:
    """The point of the edge of area ``s`` that is nearest to another one; to a circle's centre, the northernmost."""
    if is_circle(fence, s):
        middle = centre(fence, s)
        away = point - middle
        distance = norm2(away)
        if distance <= 0.0:
            return middle + Vec2(float(fence.radius[s]), 0.0)
        return middle + away * (float(fence.radius[s]) / distance)
    nearest = corner_of(fence, s, 0)
    for k in range(int(fence.count[s])):
        found = nearest_on_segment(corner_of(fence, s, k), corner_of(fence, s, k + 1), point)
        if norm2(found - point) < norm2(nearest - point):
            nearest = found
    return nearest


@law
def distance_to_edge(fence: FenceState, s: int, point: Vec2) -> float:
    """Distance of a point to the edge of area ``s`` [m]."""
    return norm2(nearest_on_edge(fence, s, point) - point)


@law
def clearance(fence: FenceState, s: int, point: Vec2) -> float:
    """How far a point that area ``s`` allows is from its edge [m]; below zero: how far one that it does not is."""
    distance = distance_to_edge(fence, s, point)
    return distance if is_within(fence, s, point) == is_inclusion(fence, s) else -distance


@law
def use_origin(fence: FenceState, estimate: Estimate) -> None:
    """Let positions count from the estimator's origin, when it has one and it is another one than before."""
    fence.is_placed = estimate.origin_set
    lat, lon = estimate.origin_lat, estimate.origin_lon
    if not estimate.origin_set or (fence.reference_lat == lat and fence.reference_lon == lon):
        return
    for k in range(fence.corners):
        at = add_offset(fence.reference_lat, fence.reference_lon, float(fence.north[k]), float(fence.east[k]))
        now = offset_ne(lat, lon, at.lat, at.lon)
        fence.north[k], fence.east[k] = now.x, now.y
    fence.reference_lat, fence.reference_lon = lat, lon
