# SPDX-License-Identifier: BSD-3-Clause
"""The curve to a spline waypoint: a cubic Hermite spline, flown as fast as its bends let it.

https://ardupilot.org/copter/docs/spline-waypoints.html. ``spline_curve`` (shell) lays the curve and works out how fast
each part of it may be flown.
"""

from __future__ import annotations

import math

from ....core.algebra import ZERO, dot, norm
from ....core.elementary import hypot
from ....core.kernels import law
from ....core.scalars import constrain
from ....core.vectors import Vec3
from .state import SPLINE_PARTS, CopterNav, Spline

ACCEL_PART = 0.5
"""Part of the acceleration of legs for speeding up along a curve; as much is left for its bends (ArduPilot's)."""
_BRAKE = 1.2
"""Braking may take this much more than the acceleration for which speeds are planned, to keep to them in ticks."""
_NO_SLOPE = 1e-3
"""A slope below this [m] is that of an end at rest, where the curve's second derivative says the direction."""


@law
def position(s: Spline, u: float) -> Vec3:
    """Point of the curve at ``u`` (0 its origin, 1 its end), NED [m]."""
    return s.origin + (s.slope + (s.square + s.cube * u) * u) * u


@law
def slope(s: Spline, u: float) -> Vec3:
    """First derivative by ``u`` [m]."""
    return s.slope + (s.square * 2.0 + s.cube * (3.0 * u)) * u


@law
def bend(s: Spline, u: float) -> Vec3:
    """Second derivative by ``u`` [m]."""
    return s.square * 2.0 + s.cube * (6.0 * u)


@law
def direction(s: Spline, u: float) -> Vec3:
    """Unit vector along the curve, NED; zero for a curve of no length."""
    along = slope(s, u)
    length = norm(along)
    if length < _NO_SLOPE:
        along = bend(s, u) if u < 0.5 else -bend(s, u)
        length = norm(along)
        if length < _NO_SLOPE:
            return ZERO
    return along / length


@law
def along_axes(unit: Vec3, horizontal: float, up: float, down: float) -> float:
    """Greatest length of a vector along ``unit`` (NED) within a horizontal and two vertical limits."""
    ne = hypot(unit.x, unit.y)
    vertical = up if unit.z < 0.0 else down
    if ne < 1e-9:
        return vertical
    return horizontal / ne if abs(unit.z) < 1e-9 else min(horizontal / ne, vertical / abs(unit.z))


@law
def speed_allowed(s: Spline) -> float:
    """Speed that the curve allows where the target is [m/s]."""
    x = constrain(s.u, 0.0, 1.0) * SPLINE_PARTS
    k = min(int(x), SPLINE_PARTS - 1)
    return s.allowed[k] + (s.allowed[k + 1] - s.allowed[k]) * (x - k)


@law
def change_speed(s: Spline, accel: float, dt: float) -> None:
    """Speed of the target after ``dt`` [s]: as fast as the curve allows and its end can be come to by ``accel``."""
    left = s.end - position(s, s.u)
    wanted = min(speed_allowed(s), math.sqrt(s.end_speed * s.end_speed + 2.0 * accel * norm(left)))
    s.speed = constrain(wanted, s.speed - _BRAKE * accel * dt, s.speed + accel * dt)


@law
def step(s: Spline, dt: float) -> None:
    """Move the target along the curve for ``dt`` [s]."""
    length = norm(slope(s, s.u))
    if length >= _NO_SLOPE:
        s.u += s.speed * dt / length
    else:  # away from an end at rest the distance grows with the square of ``u``
        half = 0.5 * norm(bend(s, s.u))
        s.u = 1.0 if half < _NO_SLOPE else s.u + math.sqrt(s.speed * dt / half)
    s.u = min(s.u, 1.0)


@law
def move(nav: CopterNav, dt: float, accel_ne: float, accel_d: float) -> bool:
    """Move on by ``dt`` [s] and write ``nav.pos``, ``vel``, ``acc``; whether the end is reached.

    ``accel_ne``, ``accel_d``: limits of the acceleration along the curve [m/s^2].
    """
    s = nav.spline
    before = s.speed
    change_speed(s, along_axes(direction(s, s.u), accel_ne, accel_d, accel_d), dt)
    step(s, dt)
    unit = direction(s, s.u)
    nav.pos = position(s, s.u)
    nav.vel = unit * s.speed
    nav.acc = unit * ((s.speed - before) / dt) if dt > 0.0 else ZERO
    length = norm(slope(s, s.u))
    if length >= _NO_SLOPE:
        curved = bend(s, s.u)
        nav.acc += (curved - unit * dot(curved, unit)) * (s.speed * s.speed / (length * length))
    return s.u >= 1.0
