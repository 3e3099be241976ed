# SPDX-License-Identifier: BSD-3-Clause
"""Lays the curve to a spline waypoint and works out how fast each part of it may be flown (shell)."""

from __future__ import annotations

import math
from typing import NamedTuple

from ....core.algebra import ZERO, dot, norm
from ....core.sums import separation
from ....core.vectors import Vec3
from .spline import along_axes, bend, direction, position, slope
from .state import SPLINE_PARTS, Spline

_LONGEST = 4.0
"""The slopes at both ends together are at most so many times the straight line between them (ArduPilot's)."""


class SplineLimits(NamedTuple):
    """Of the motion along a curve [m/s, m/s^2]."""

    speed_ne: float
    speed_up: float
    speed_down: float
    accel_ne: float
    accel_d: float


def lay(s: Spline, origin: Vec3, end: Vec3, leaving: Vec3, entering: Vec3) -> None:
    """The curve from ``origin`` to ``end`` (NED [m]) with these slopes at its two ends [m]; zero: from or to rest."""
    chord = separation(origin, end)
    slopes = norm(leaving) + norm(entering)
    scale = min(1.0, _LONGEST * chord / slopes) if slopes > 0.0 else 0.0
    leaving, entering = leaving * scale, entering * scale
    s.origin, s.end, s.slope = origin, end, leaving
    s.square = (end - origin) * 3.0 - leaving * 2.0 - entering
    s.cube = (origin - end) * 2.0 + leaving + entering
    s.u = 0.0


def set_limits(s: Spline, limits: SplineLimits, end_speed: float) -> None:
    """How fast each part may be flown so that bends and the end, at ``end_speed`` [m/s], are come to slowly enough."""
    marks = [k / SPLINE_PARTS for k in range(SPLINE_PARTS + 1)]
    allowed = [_speed_at(s, u, limits) for u in marks]
    s.end_speed = min(end_speed, allowed[-1])
    allowed[-1] = s.end_speed
    for k in range(SPLINE_PARTS - 1, -1, -1):
        unit = direction(s, marks[k])
        accel = along_axes(unit, limits.accel_ne, limits.accel_d, limits.accel_d)
        distance = separation(position(s, marks[k]), position(s, marks[k + 1]))
        allowed[k] = min(allowed[k], math.sqrt(allowed[k + 1] * allowed[k + 1] + 2.0 * accel * distance))
    s.allowed[:] = allowed


def _speed_at(s: Spline, u: float, limits: SplineLimits) -> float:
    """Speed [m/s] within the limits along the curve and of the acceleration across it."""
    unit = direction(s, u)
    if unit == ZERO:
        return limits.speed_ne
    speed = along_axes(unit, limits.speed_ne, limits.speed_up, limits.speed_down)
    along, curved = norm(slope(s, u)), bend(s, u)
    across = curved - unit * dot(curved, unit)
    if along > 0.0 and norm(across) > 1e-9:
        accel = along_axes(across / norm(across), limits.accel_ne, limits.accel_d, limits.accel_d)
        speed = min(speed, along * math.sqrt(accel / norm(across)))
    return speed
