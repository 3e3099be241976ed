# SPDX-License-Identifier: BSD-3-Clause
"""Where a ray meets one solid, or the floor.

Laws of a few lines, without a branch, so that the processor can run them on several rays at once.

A ray is a point and a unit vector in NED [m]. Ranges are 0 for a ray that starts inside and inf for one that misses.
Faces are half open: a ray that runs within a face's plane meets the solid on one side of it and not on the other.
"""

from __future__ import annotations

import math

from ..core.kernels import law

INF = math.inf
TINY = 1e-300
"""Stands for a component that is less: what is reached along it is then very far away, with the right sign."""


@law
def crossing(low, high, velocity):
    """When a point is between two planes that lie ``low`` and ``high`` ahead of it: (enters, leaves)."""
    pace = 1.0 / (velocity if abs(velocity) > TINY else TINY)
    first, second = low * pace, high * pace
    return (first if first < second else second, second if first < second else first)


@law
def first_of(enter, leave, enter2, leave2):
    """Range of a ray that is in one set from ``enter`` to ``leave``, in another from ``enter2``: the first in both."""
    enter = enter if enter > enter2 else enter2
    leave = leave if leave < leave2 else leave2
    enter = enter if enter > 0.0 else 0.0
    return enter if leave >= enter else INF


@law
def to_box(x, y, half_length, half_width, top, bottom, vx, vy, vd):
    """Range to a box.

    Args:
        x, y: where the ray starts, from the box's middle along its own axes [m].
        half_length, half_width: of the box [m].
        top, bottom: down, from where the ray starts [m].
        vx, vy, vd: the ray's direction along the box's own axes, and down.
    """
    enter, leave = crossing(-half_length - x, half_length - x, vx)
    enter2, leave2 = crossing(-half_width - y, half_width - y, vy)
    enter = enter if enter > enter2 else enter2
    leave = leave if leave < leave2 else leave2
    enter2, leave2 = crossing(top, bottom, vd)
    return first_of(enter, leave, enter2, leave2)


@law
def to_cylinder(x, y, radius, top, bottom, vx, vy, vd):
    """Range to a vertical cylinder; arguments as for a box."""
    a = vx * vx + vy * vy
    a = a if a > TINY else TINY
    b = x * vx + y * vy
    inside = b * b - a * (x * x + y * y - radius * radius)
    root = math.sqrt(inside if inside > 0.0 else 0.0)
    enter, leave = (-b - root) / a, (root - b) / a
    enter2, leave2 = crossing(top, bottom, vd)
    return first_of(enter if inside >= 0.0 else INF, leave, enter2, leave2)


@law
def to_floor(floor, vd):
    """Range to the floor, which lies ``floor`` [m] below where the ray starts: 0 from below it."""
    reached = floor / (vd if vd > TINY else 1.0) if vd > TINY else INF
    return reached if floor >= 0.0 else 0.0
