# SPDX-License-Identifier: BSD-3-Clause
"""The shortest path around the areas of the fence (OA_TYPE 2): A* from corner to corner, as far as they see each other
(shell side).

A path keeps a margin from all edges; where it begins or ends nearer to them, it keeps that distance there.
"""

from __future__ import annotations

import heapq
import math
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from ...core import elementary_arrays as arrays
from ...core.elementary import cos
from ...core.sums import lengths
from ...core.vectors import Vec2
from ..fence.shapes import is_inclusion
from ..fence.state import CIRCLE_IN, CIRCLE_OUT, FenceState

Points = NDArray[np.float64]
"""Shape (count, 2): north, east [m]."""

AROUND_CORNER = 8
"""Positions around a corner that a path may turn at,"""
AROUND_CIRCLE = 16
"""and around a circle."""
SLACK = 0.01
"""A path may come so much nearer than its margin [m]."""


class Circle(NamedTuple):
    """A round area."""

    centre: Points
    radius: float
    stays_in: bool


class Map:
    """The areas of a fence.

    Args:
        fence: in the vehicle's record.
        margin: that paths keep from edges [m].
    """

    def __init__(self, fence: FenceState, margin: float) -> None:
        self.margin = margin
        self._polygons: list[tuple[Points, bool]] = []
        self._circles: list[Circle] = []
        for s in range(fence.shapes):
            k, count = int(fence.first[s]), int(fence.count[s])
            corners = np.column_stack((fence.north[k : k + count], fence.east[k : k + count])).astype(np.float64)
            if fence.kind[s] in (CIRCLE_IN, CIRCLE_OUT):
                self._circles.append(Circle(corners[0], float(fence.radius[s]), is_inclusion(fence, s)))
            else:
                self._polygons.append((corners, is_inclusion(fence, s)))
        none = np.empty((0, 2))
        self._a = np.concatenate([none, *(corners for corners, _ in self._polygons)])
        self._b = np.concatenate([none, *(np.roll(corners, -1, axis=0) for corners, _ in self._polygons)])

    def clearance(self, points: Points) -> NDArray[np.float64]:
        """How far positions are from the edges of all areas [m]; below 0: a position is where none may be."""
        clearance = np.full(len(points), math.inf)
        if len(self._a):
            clearance = np.min(_distance(points[:, None], self._a, self._b), axis=1)
        for corners, stays_in in self._polygons:
            clearance[_inside(points, corners) != stays_in] = -1.0
        for circle in self._circles:
            away = arrays.hypot(*(points - circle.centre).T)
            clearance = np.minimum(clearance, circle.radius - away if circle.stays_in else away - circle.radius)
        return clearance

    def sees(self, start: Points, ends: Points, margins: NDArray[np.float64]) -> NDArray[np.bool_]:
        """To which of the positions ``ends`` a straight path leads from ``start``, each with its margin [m]."""
        free = np.ones(len(ends), bool)
        if len(self._a):
            near = np.min(_distance(self._a, start, ends[:, None]), axis=1)  # of corners to the path
            free &= (near >= margins - SLACK) & ~np.any(_cross(start, ends[:, None], self._a, self._b), axis=1)
        for circle in self._circles:
            if circle.stays_in:
                continue  # who is within it at both ends is so on the way
            near = _distance(circle.centre, start, ends)
            free &= near >= circle.radius + margins - SLACK
        return free

    def turning_points(self) -> Points:
        """Positions that paths may turn at."""
        rings = [self._ring(np.asarray(corner), self.margin, AROUND_CORNER) for corner in self._a]
        rings += [self._ring(c.centre, c.radius + self.margin, AROUND_CIRCLE) for c in self._circles if not c.stays_in]
        positions = np.concatenate([np.empty((0, 2)), *rings])
        return positions[self.clearance(positions) >= self.margin] if len(positions) else positions

    @staticmethod
    def _ring(centre: Points, radius: float, count: int) -> Points:
        """Positions around a circle whose connecting lines stay out of it."""
        angle = 2.0 * math.pi * np.arange(count) / count
        out = (radius + SLACK) / cos(math.pi / count)
        found: Points = centre + out * np.column_stack((arrays.cos(angle), arrays.sin(angle)))
        return found


def a_star(fence: FenceState, start: Vec2, end: Vec2, margin: float) -> list[Vec2] | None:
    """Positions where the shortest path from ``start`` to ``end`` [m, NE] turns, and its end; None:
    there is no path."""
    area = Map(fence, margin)
    ends = np.array([start, end])
    clearance = area.clearance(ends)
    if clearance[0] < 0.0 or clearance[1] < 0.0:
        return None
    positions = np.concatenate((ends, area.turning_points()))
    clearances = np.minimum(np.concatenate((clearance, np.full(len(positions) - 2, margin))), margin)
    left = arrays.hypot(*(positions - positions[1]).T)
    length = np.full(len(positions), math.inf)
    before = np.zeros(len(positions), int)
    done = np.zeros(len(positions), bool)
    length[0] = 0.0
    queue = [(float(left[0]), 0)]
    while queue:
        _, k = heapq.heappop(queue)
        if k == 1:
            return _trail(positions, before)
        if done[k]:
            continue
        done[k] = True
        step = length[k] + arrays.hypot(*(positions - positions[k]).T)
        open_ = np.flatnonzero(~done & (step < length))
        open_ = open_[area.sees(positions[k], positions[open_], np.minimum(clearances[k], clearances[open_]))]
        length[open_], before[open_] = step[open_], k
        for j in open_:
            heapq.heappush(queue, (float(step[j] + left[j]), int(j)))
    return None


def _trail(positions: Points, before: NDArray[np.int_]) -> list[Vec2]:
    trail, k = list[Vec2](), 1
    while k != 0:
        trail.append(Vec2(float(positions[k, 0]), float(positions[k, 1])))
        k = int(before[k])
    return trail[::-1]


def _distance(points: Points, a: Points, b: Points) -> NDArray[np.float64]:
    """Of points to the lines from ``a`` to ``b``."""
    delta = b - a
    square = np.sum(delta * delta, axis=-1)
    share = np.clip(np.sum((points - a) * delta, axis=-1) / np.where(square > 0.0, square, 1.0), 0.0, 1.0)
    away: NDArray[np.float64] = lengths(points - a - delta * share[..., None])
    return away


def _side(a: Points, b: Points, points: Points) -> NDArray[np.float64]:
    delta, to = b - a, points - a
    side: NDArray[np.float64] = delta[..., 0] * to[..., 1] - delta[..., 1] * to[..., 0]
    return side


def _cross(a: Points, b: Points, c: Points, d: Points) -> NDArray[np.bool_]:
    """Whether the lines from ``a`` to ``b`` and from ``c`` to ``d`` cross."""
    crossed: NDArray[np.bool_] = (_side(a, b, c) * _side(a, b, d) < 0.0) & (_side(c, d, a) * _side(c, d, b) < 0.0)
    return crossed


def _inside(points: Points, corners: Points) -> NDArray[np.bool_]:
    """Whether points are within a polygon."""
    x, y = points[:, :1], points[:, 1:]
    a, b = corners, np.roll(corners, -1, axis=0)
    spans = (a[:, 0] > x) != (b[:, 0] > x)
    rise = np.where(b[:, 0] == a[:, 0], 1.0, b[:, 0] - a[:, 0])
    odd: NDArray[np.bool_] = np.sum(spans & (y < a[:, 1] + (b[:, 1] - a[:, 1]) * (x - a[:, 0]) / rise), axis=1) % 2 == 1
    return odd
