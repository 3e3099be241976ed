# SPDX-License-Identifier: BSD-3-Clause
"""Obstacles: a sector in which something is seen is a wall across it, and joins up with its neighbours' walls."""

from __future__ import annotations

from typing import NamedTuple

from ...core.algebra import norm2, turned
from ...core.elementary import sincos
from ...core.kernels import law
from ...core.vectors import Vec2
from ..params.avoidance import Avoid
from . import velocity
from .proximity import SECTOR, SECTORS, Proximity, sees
from .state import Avoidance
from .velocity import Braking, Wall


class Push(NamedTuple):
    """Lean away from obstacles, as parts of the greatest one."""

    roll: float
    pitch: float


@law
def edge_distance(proximity: Proximity, sector: int, beside: int, time_us: int) -> float:
    """Distance [m] at the edge between a sector, which sees something, and the one beside it: the shorter one."""
    distance, other = proximity.distance[sector], beside % SECTORS
    return min(distance, proximity.distance[other]) if sees(proximity, other, time_us) else distance


@law
def wall_of(proximity: Proximity, sector: int, yaw: float, time_us: int) -> Wall:
    """The wall across a sector that sees something, of a vehicle whose nose is at ``yaw`` [rad]."""
    left, right = (
        edge_distance(proximity, sector, sector + SECTORS - 1, time_us),
        edge_distance(proximity, sector, sector + 1, time_us),
    )
    middle = yaw + sector * SECTOR
    a = turned(Vec2(left, 0.0), middle - 0.5 * SECTOR)
    return Wall(a, turned(Vec2(right, 0.0), middle + 0.5 * SECTOR))


@law
def avoid_obstacles(
    avoid: Avoidance, proximity: Proximity, vel: Vec2, yaw: float, time_us: int, p: Avoid, b: Braking
) -> Vec2:
    """``vel`` that keeps AVOID_MARGIN away from what is seen; margins that are breached ask for backing out."""
    for k in range(SECTORS):
        if sees(proximity, k, time_us):
            wall = wall_of(proximity, k, yaw, time_us)
            near = velocity.nearest(wall)
            breach = p.MARGIN - norm2(near)
            if breach > p.BACKUP_DZ:
                velocity.back_out(avoid, near, breach, b)
            vel = velocity.before_wall(vel, wall, p.MARGIN, b)
    return vel


@law
def push(proximity: Proximity, distance_max: float, time_us: int) -> Push:
    """Lean away from what is nearer than ``distance_max`` [m]: the nearer, the more."""
    right = left = back = forth = 0.0
    for k in range(SECTORS):
        if sees(proximity, k, time_us) and proximity.distance[k] < distance_max:
            share = 1.0 - proximity.distance[k] / distance_max
            sine, cosine = sincos(proximity.angle[k])
            roll, pitch = -sine * share, cosine * share
            right, left = max(right, roll), min(left, roll)
            back, forth = max(back, pitch), min(forth, pitch)
    return Push(right + left, back + forth)
