# SPDX-License-Identifier: BSD-3-Clause
"""Velocities that stop before walls and slide along them, and that back out of margins.

The vehicle is at the origin of the plane: walls are positions relative to it, north and east [m]. It brakes as a
position controller does that stops at the margin: with a gain, or without one evenly.
"""

from __future__ import annotations

import math
from typing import NamedTuple

from ...core.algebra import ZERO2, cross2, dot2, limit_length, norm2
from ...core.kernels import law
from ...core.vectors import Vec2
from ..control.shaping import inverse_sqrt_controller, sqrt_controller
from .state import Avoidance

ACCEL_MAX = 1.0
"""Braking before fences and obstacles is planned with no more [m/s^2] (ArduPilot's)."""
BACK_SHARE = 0.4
"""Backing out is planned with this part of it."""
LOOK_AHEAD = 0.02
"""A stop looks so much further than the margin [m]."""
FORGETS_US = 200_000
"""After so long without a limit the acceleration counts from the velocity that is asked for."""


class Braking(NamedTuple):
    """How the vehicle may brake."""

    gain: float  # of its position controller [1/s]; 0: brakes evenly
    accel: float  # [m/s^2]
    dt: float  # from one call to the next [s]
    stops: bool  # AVOID_BEHAVE: stops before walls instead of sliding along them


class Wall(NamedTuple):
    """A straight line between two positions."""

    a: Vec2
    b: Vec2


@law
def braking(gain: float, accel: float, dt: float, behave: float) -> Braking:
    """A braking of no more than ``ACCEL_MAX``; ``behave``: AVOID_BEHAVE."""
    return Braking(gain, min(accel, ACCEL_MAX), dt, behave == 1.0)


@law
def speed_before(distance: float, b: Braking) -> float:
    """Greatest speed [m/s] from which the vehicle stops within a distance [m]."""
    return sqrt_controller(distance, b.gain, b.accel, b.dt) if distance > 0.0 else 0.0


@law
def slowed(vel: Vec2, towards: Vec2, distance: float, b: Braking) -> Vec2:
    """``vel`` of which the part along the unit vector ``towards`` stops within ``distance`` [m]."""
    return vel - towards * max(dot2(vel, towards) - speed_before(distance, b), 0.0)


@law
def shortened(vel: Vec2, distance: float, b: Braking) -> Vec2:
    """``vel`` that stops within ``distance`` [m] without another direction."""
    return limit_length(vel, speed_before(distance, b))


@law
def reach(vel: Vec2, margin: float, b: Braking) -> Vec2:
    """Where a vehicle that brakes from ``vel`` stops, and a margin [m] further."""
    speed = norm2(vel)
    if speed <= 0.0:
        return ZERO2
    return vel * ((LOOK_AHEAD + margin + inverse_sqrt_controller(speed, b.gain, b.accel)) / speed)


@law
def nearest(wall: Wall) -> Vec2:
    """The position of a wall that is nearest to the vehicle."""
    edge = wall.b - wall.a
    length = dot2(edge, edge)
    if length <= 0.0:
        return wall.a
    return wall.a + edge * min(max(-dot2(wall.a, edge) / length, 0.0), 1.0)


@law
def share_before(path: Vec2, wall: Wall) -> float:
    """The part 0 .. 1 of a path that leads to a wall; above 1: it does not lead there."""
    along = wall.b - wall.a
    across = cross2(path, along)
    if across == 0.0:
        return 2.0
    met = cross2(wall.a, along) / across
    at = cross2(wall.a, path) / across
    return met if met >= 0.0 and 0.0 <= at <= 1.0 else 2.0


@law
def before_wall(vel: Vec2, wall: Wall, margin: float, b: Braking) -> Vec2:
    """``vel`` that stops a margin [m] before a wall, or slides along it."""
    if b.stops:
        path = reach(vel, margin, b)
        share = share_before(path, wall)
        return vel if share > 1.0 else shortened(vel, share * norm2(path) - margin, b)
    near = nearest(wall)
    distance = norm2(near)
    return slowed(vel, near / distance, distance - margin, b) if distance > 0.0 else vel


@law
def within_circle(vel: Vec2, centre: Vec2, radius: float, b: Braking) -> Vec2:
    """``vel`` of a vehicle that stays within ``radius`` [m] of ``centre``, or does not go further out."""
    position = -centre
    out, speed = norm2(position), norm2(vel)
    if speed <= 0.0:
        return vel
    if not b.stops:
        end = position + reach(vel, -LOOK_AHEAD, b)
        beyond = norm2(end)
        if beyond <= radius:
            return vel
        towards = end * (radius / beyond) - position
        left = norm2(towards)
        return towards * (min(speed, speed_before(left, b)) / left) if left > 0.0 else ZERO2
    path = reach(vel, 0.0, b)
    if out >= radius:
        return ZERO2 if norm2(position + path) >= out else vel
    # position + share * path is on the circle
    size, along = dot2(path, path), dot2(position, path)
    share = (-along + math.sqrt(along * along + size * (radius * radius - out * out))) / size
    return vel if share > 1.0 else shortened(vel, share * norm2(path), b)


@law
def outside_circle(vel: Vec2, centre: Vec2, radius: float, b: Braking) -> Vec2:
    """``vel`` of a vehicle that stays ``radius`` [m] away from ``centre``."""
    out = norm2(centre)
    if out <= 0.0:
        return vel
    if not b.stops:
        return slowed(vel, centre / out, out - radius, b)
    path = reach(vel, 0.0, b)
    size, along = dot2(path, path), dot2(centre, path)
    square = along * along - size * (out * out - radius * radius)
    if along <= 0.0 or square <= 0.0:
        return vel
    share = max((along - math.sqrt(square)) / size, 0.0)
    return vel if share > 1.0 else shortened(vel, share * norm2(path), b)


@law
def begin(avoid: Avoidance) -> None:
    """No margin asks for anything yet."""
    avoid.back_max = avoid.back_min = ZERO2


@law
def back_out(avoid: Avoidance, towards: Vec2, breach: float, b: Braking) -> None:
    """The vehicle is ``breach`` [m] in the margin of something that lies ``towards``."""
    size = norm2(towards)
    if breach <= 0.0 or size <= 0.0:
        return
    slow = Braking(b.gain, b.accel * BACK_SHARE, b.dt, b.stops)
    away = towards * (-speed_before(breach, slow) / size)
    avoid.back_max = Vec2(max(avoid.back_max.x, away.x), max(avoid.back_max.y, away.y))
    avoid.back_min = Vec2(min(avoid.back_min.x, away.x), min(avoid.back_min.y, away.y))


@law
def at_least(wanted: float, back: float) -> float:
    """``wanted``, or ``back`` where that is faster in its own direction."""
    if back > 0.0:
        return max(wanted, back)
    return min(wanted, back) if back < 0.0 else wanted


@law
def with_backing(avoid: Avoidance, vel: Vec2, speed_max: float) -> Vec2:
    """``vel``, and out of the margins at no more than ``speed_max`` [m/s]; who leaves them faster may do so."""
    if speed_max <= 0.0:
        return vel
    back = limit_length(avoid.back_max + avoid.back_min, speed_max)
    return Vec2(at_least(vel.x, back.x), at_least(vel.y, back.y))


@law
def changed_slowly(avoid: Avoidance, asked: Vec2, vel: Vec2, time_us: int, accel_max: float, dt: float) -> Vec2:
    """The velocity in place of ``asked``: ``vel``, as far as a change of ``accel_max`` [m/s^2] allows (0: any)."""
    if vel.x == asked.x and vel.y == asked.y:
        return vel
    if accel_max > 0.0:
        before = avoid.vel if time_us - avoid.limited_us <= FORGETS_US else asked
        vel = before + limit_length(vel - before, accel_max * dt)
    avoid.vel = vel
    avoid.limited_us = time_us
    return vel


@law
def climb_below(climb: float, clearance: float, back_max: float, b: Braking) -> float:
    """A climb rate [m/s] that stops within ``clearance`` [m]; above it (below 0) it sinks, at most ``back_max``."""
    if clearance > 0.0:
        return min(climb, speed_before(clearance, b))
    return min(climb, -min(speed_before(-clearance, b), back_max))
