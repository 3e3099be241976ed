# SPDX-License-Identifier: BSD-3-Clause
"""How high the ground is below the vehicle, by the grid of heights or by a range-finder, and when neither says so."""

from __future__ import annotations

import math
from typing import NamedTuple

from ...core.kernels import law
from ...core.vectors import Vec2, Vec3
from ..events import Event, Events, emit_and_return
from .state import Terrain

MISSING_US = 5_000_000
"""A height that is needed and missing for so long is a failsafe."""
PAUSE_US = 200_000
"""One that was not missing for so long is not missing any more."""

TERRAIN_LEFT = Event(71)  # it has left the square of the grid whose heights it knows


class Ground(NamedTuple):
    """The ground below."""

    is_known: bool
    d: float  # down from the origin [m]


@law
def height_in_square(t: Terrain, position: Vec2) -> float:
    """Height [m above sea level] at a position NE [m] in the square or a little beside it, by those of its corners."""
    u, w = (position.x - t.north) / t.spacing, (position.y - t.east) / t.spacing
    south = t.corners[0] + w * (t.corners[1] - t.corners[0])
    north = t.corners[2] + w * (t.corners[3] - t.corners[2])
    return south + u * (north - south)


@law
def is_inside(t: Terrain, position: Vec2) -> bool:
    """Whether a position NE [m] is in the square."""
    size = float(t.spacing)
    return 0.0 <= position.x - t.north <= size and 0.0 <= position.y - t.east <= size


@law
def watch_square(t: Terrain, pos: Vec3, events: Events, time_us: int) -> None:
    """Ten times a second: ask the shell for another square when the vehicle has left this one."""
    if t.has_square and not is_inside(t, Vec2(pos.x, pos.y)):
        t.has_square = False
        emit_and_return(events, time_us, TERRAIN_LEFT, 0.0, 0.0)


@law
def by_grid(t: Terrain, pos: Vec3, home_d: float) -> Ground:
    """The ground by the grid: home is on the ground. Where its height is not known it is that known last."""
    if t.is_known and t.was_known:
        t.difference = height_in_square(t, Vec2(pos.x, pos.y)) - t.home
    return Ground(t.was_known, home_d - t.difference)


@law
def by_range(reading: float, cos_lean: float, pos_d: float) -> Ground:
    """The ground by a range-finder that looks down; inf: it sees none."""
    return Ground(reading < math.inf, pos_d + reading * cos_lean if reading < math.inf else 0.0)


@law
def note_missing(t: Terrain, time_us: int) -> None:
    """A height is needed and not known."""
    if t.missed_us == 0 or time_us - t.missed_us > PAUSE_US:
        t.missing_us = time_us
    t.missed_us = time_us


@law
def lose_ground(t: Terrain, time_us: int) -> None:
    """A height that is needed at once is not known."""
    t.missing_us, t.missed_us = time_us - MISSING_US - 1, time_us


@law
def is_long_missing(t: Terrain, time_us: int) -> bool:
    """Ten times a second, once one is: whether a height has been missing for too long."""
    if time_us - t.missed_us > PAUSE_US:
        t.missed_us = 0
        return False
    return t.missed_us - t.missing_us > MISSING_US
