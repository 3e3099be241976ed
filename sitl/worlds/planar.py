# SPDX-License-Identifier: BSD-3-Clause
"""Rays of a planar laser scanner, and the readings that it publishes from them.

The rule is Gazebo's (ray sensor with a horizontal resolution below 1, as the paper's robots had): more rays are cast
than readings published; reading i lies at ray i * (rays - 1) / (readings - 1), between two rays, and is their weighted
mean. A ray that meets nothing within the range counts as the range.

Where a ray meets one solid, or the floor.

Laws of a few lines, without a branch, so that the processor can run them on several rays at once.

A ray is a point and a unit vector in NED [m]. Ranges are 0 for a ray that starts inside and inf for one that misses.
Faces are half open: a ray that runs within a face's plane meets the solid on one side of it and not on the other.
"""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np

from ..core.array_kernels import Kernel, Line
from ..core.elementary import cos, sin
from ..core.kernels import law
from ..core.vectors import Vec2, Vec3
from .geometry import Floats

INF = math.inf
TINY = 1e-300
"""Stands for a component that is less: what is reached along it is then very far away, with the right sign."""


class Span(NamedTuple):
    """From where to where along a ray something is [m]."""

    enter: float
    leave: float


@law
def crossing(low: float, high: float, velocity: float) -> Span:
    """When a point is between two planes that lie ``low`` and ``high`` [m] ahead of it."""
    pace = 1.0 / (velocity if abs(velocity) > TINY else TINY)
    first, second = low * pace, high * pace
    return Span(first if first < second else second, second if first < second else first)


@law
def first_of(a: Span, b: Span) -> float:
    """Range [m] of a ray that is in one set along a span, in another along the other: the first in both."""
    enter = a.enter if a.enter > b.enter else b.enter
    leave = a.leave if a.leave < b.leave else b.leave
    enter = enter if enter > 0.0 else 0.0
    return enter if leave >= enter else INF


@law
def over_rectangle(start: Vec2, half: Vec2, direction: Vec3) -> Span:
    """Where a ray is over or under a rectangle; arguments as for a box."""
    length = crossing(-half.x - start.x, half.x - start.x, direction.x)
    width = crossing(-half.y - start.y, half.y - start.y, direction.y)
    enter = length.enter if length.enter > width.enter else width.enter
    return Span(enter, length.leave if length.leave < width.leave else width.leave)


@law
def to_box(start: Vec2, half: Vec2, heights: Span, direction: Vec3) -> float:
    """Range to a box.

    Args:
        start: where the ray starts, from the box's middle along its own axes [m].
        half: half lengths along those [m].
        heights: top and bottom, down from where the ray starts [m].
        direction: the ray's, along the box's own axes, and down.
    """
    return first_of(over_rectangle(start, half, direction), crossing(heights.enter, heights.leave, direction.z))


@law
def to_cylinder(start: Vec2, radius: float, heights: Span, direction: Vec3) -> float:
    """Range [m] to a vertical cylinder; arguments as for a box."""
    x, y, vx, vy = start.x, start.y, direction.x, direction.y
    a = vx * vx + vy * vy
    a = a if a > TINY else TINY
    b = x * vx + y * vy
    inside = b * b - a * (x * x + y * y - radius * radius)
    root = math.sqrt(inside if inside > 0.0 else 0.0)
    enter, leave = (-b - root) / a, (root - b) / a
    upright = crossing(heights.enter, heights.leave, direction.z)
    return first_of(Span(enter if inside >= 0.0 else INF, leave), upright)


@law
def to_floor(floor: float, down: float) -> float:
    """Range to the floor, which lies ``floor`` [m] below where the ray starts: 0 from below it; ``down``: component of
    its direction."""
    reached = floor / (down if down > TINY else 1.0) if down > TINY else INF
    return reached if floor >= 0.0 else 0.0


def angles(count: int, field_of_view: float) -> Floats:
    """Angles [rad], counter-clockwise from straight ahead, evenly from right to left, both ends; shape (count,)."""
    if count == 1:
        return np.zeros(1)
    return np.linspace(-0.5 * field_of_view, 0.5 * field_of_view, count)


def rays(count: int, field_of_view: float) -> Floats:
    """Unit vectors on the body (FRD: three rows, forward, right, down) at those angles; shape (3, count)."""
    at = [float(a) for a in angles(count, field_of_view)]
    return np.array([[cos(a) for a in at], [-sin(a) for a in at], [0.0] * count])


@law
def publish_readings(ranges: Line, longest: float, out: Line) -> None:
    """The published readings [m] of the ranges [m] that were cast, into ``out``; see ``publish``."""
    cast, published = ranges.shape[0], out.shape[0]
    for i in range(published):
        index = i * (cast - 1) / (published - 1) if published > 1 else 0.0
        first = min(int(index), max(cast - 2, 0))
        a = min(ranges[first], longest)
        b = min(ranges[min(first + 1, cast - 1)], longest)
        reading = a + (index - first) * (b - a)
        out[i] = INF if reading >= longest else reading


_publish = Kernel(publish_readings)


def publish(ranges: Floats, longest: float, out: Floats) -> Floats:
    """The published readings [m] of the ranges that were cast, into ``out``, which is returned.

    Args:
        ranges: what the rays met [m], inf for nothing.
        longest: range of the sensor [m]; a reading of that or more is inf.
        out: as many readings as are published.
    """
    _publish(ranges, longest, out)
    return out
