# SPDX-License-Identifier: BSD-3-Clause
"""Fences that velocities stop before, or slide along."""

from __future__ import annotations

import math
from typing import NamedTuple

from ...core.algebra import dot2, norm2, turned
from ...core.kernels import law
from ...core.vectors import Vec2
from ..fence import shapes
from ..fence.state import FenceState
from ..params.avoidance import ProximitySensor
from . import velocity
from .proximity import SECTOR, SECTORS, Proximity, begin_scan, note_reading
from .state import Avoidance
from .velocity import Braking, Wall

BREACH = 0.1
"""So far into a margin it backs out [m]."""
RANGE = 200.0
"""Of the simulated sensor that sees fences [m]."""


class Margin(NamedTuple):
    """The margin of a fence."""

    width: float  # [m]
    braking: Braking


@law
def back_out(avoid: Avoidance, towards: Vec2, breach: float, b: Braking) -> None:
    """The vehicle is ``breach`` [m] in the margin of an edge that lies ``towards``."""
    if breach > BREACH:
        velocity.back_out(avoid, towards, breach, b)


@law
def stay_within_circle(avoid: Avoidance, vel: Vec2, centre: Vec2, radius: float, m: Margin) -> Vec2:
    """``vel`` that stays within the margin of a circle [m], seen from the vehicle; nothing for who is outside."""
    out = norm2(centre)
    if out > radius:
        return vel
    back_out(avoid, -centre, out - (radius - m.width), m.braking)
    return velocity.within_circle(vel, centre, radius - m.width, m.braking)


@law
def stay_out_of_circle(avoid: Avoidance, vel: Vec2, centre: Vec2, radius: float, m: Margin) -> Vec2:
    """``vel`` that stays out of a circle and its margin [m], seen from the vehicle; nothing for who is inside."""
    out = norm2(centre)
    if out < radius:
        return vel
    back_out(avoid, centre, radius + m.width - out, m.braking)
    return velocity.outside_circle(vel, centre, radius + m.width, m.braking)


@law
def avoid_polygon(avoid: Avoidance, fence: FenceState, s: int, vel: Vec2, pos: Vec2, m: Margin) -> Vec2:
    """``vel`` that keeps the margin from the edges of polygon ``s``, of a vehicle at ``pos`` [m]."""
    for k in range(int(fence.count[s])):
        wall = Wall(shapes.corner_of(fence, s, k) - pos, shapes.corner_of(fence, s, k + 1) - pos)
        near = velocity.nearest(wall)
        back_out(avoid, near, m.width - norm2(near), m.braking)
        vel = velocity.before_wall(vel, wall, m.width, m.braking)
    return vel


@law
def avoid_area(avoid: Avoidance, fence: FenceState, s: int, vel: Vec2, pos: Vec2, m: Margin) -> Vec2:
    """``vel`` that keeps the margin from the edge of area ``s``; who is on its wrong side is left alone."""
    if shapes.is_circle(fence, s):
        centre, radius = shapes.centre(fence, s) - pos, float(fence.radius[s])
        if shapes.is_inclusion(fence, s):
            return stay_within_circle(avoid, vel, centre, radius, m)
        return stay_out_of_circle(avoid, vel, centre, radius, m)
    if shapes.is_in_polygon(fence, s, pos) != shapes.is_inclusion(fence, s):
        return vel
    return avoid_polygon(avoid, fence, s, vel, pos, m)


@law
def avoid_areas(avoid: Avoidance, fence: FenceState, vel: Vec2, pos: Vec2, m: Margin) -> Vec2:
    """``vel`` that keeps the margin from the edges of all areas."""
    if fence.is_placed:
        for s in range(fence.shapes):
            vel = avoid_area(avoid, fence, s, vel, pos, m)
    return vel


@law
def share_before_circle(path: Vec2, centre: Vec2, radius: float) -> float:
    """The part of a path that leads to a circle's edge; above 1: it does not lead there."""
    size, along = dot2(path, path), dot2(path, centre)
    square = along * along - size * (dot2(centre, centre) - radius * radius)
    if square < 0.0 or size <= 0.0:
        return 2.0
    first = (along - math.sqrt(square)) / size
    share = first if first >= 0.0 else (along + math.sqrt(square)) / size
    return share if share >= 0.0 else 2.0


@law
def share_before_area(fence: FenceState, s: int, path: Vec2, pos: Vec2) -> float:
    """The part of a path from ``pos`` that leads to the edge of area ``s``; above 1: it does not lead there."""
    if shapes.is_circle(fence, s):
        return share_before_circle(path, shapes.centre(fence, s) - pos, float(fence.radius[s]))
    share = 2.0
    for k in range(int(fence.count[s])):
        wall = Wall(shapes.corner_of(fence, s, k) - pos, shapes.corner_of(fence, s, k + 1) - pos)
        share = min(share, velocity.share_before(path, wall))
    return share


@law
def look(seen: Proximity, fence: FenceState, pos: Vec2, yaw: float, p: ProximitySensor) -> None:
    """What a sensor would read that sees the edges of areas as walls, as that of ArduPilot's simulator does."""
    begin_scan(seen, 0.0, RANGE, p)
    for k in range(SECTORS):
        path = turned(Vec2(RANGE, 0.0), yaw + k * SECTOR)
        share = 2.0
        for s in range(fence.shapes):
            share = min(share, share_before_area(fence, s, path, pos))
        note_reading(seen, k * SECTOR, share * RANGE, p)
