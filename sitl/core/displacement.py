# SPDX-License-Identifier: BSD-3-Clause
"""A vehicle is put elsewhere with all that it remembers: what happens to each position, direction and heading.

First everything turns about the vertical, then it is shifted. A velocity may be added: the past is then put where the
vehicle would have been had it moved so all the time.
"""

from __future__ import annotations

from typing import NamedTuple

from .algebra import direction, dot2, horizontal, multiply, norm2, quat_about_down, row_vector, set_row_vector
from .elementary import sincos
from .kernels import law
from .records import Floats
from .scalars import wrap_pi
from .vectors import Quat, Vec2, Vec3


class Displacement(NamedTuple):
    """Of all positions of one frame."""

    angle: float
    """From north towards east [rad]."""
    cosine: float
    """Of the angle."""
    sine: float
    turn: Quat
    """The same as a rotation."""
    shift: Vec3
    """Of positions, after the turn, NED [m]."""
    velocity: Vec3
    """Added after the turn, NED [m/s]."""


@law
def displacement(angle: float, shift: Vec3, velocity: Vec3) -> Displacement:
    """Of an angle [rad], a shift [m] and a velocity [m/s]."""
    sine, cosine = sincos(angle)
    return Displacement(angle, cosine, sine, quat_about_down(angle), shift, velocity)


@law
def on_the_ground(d: Displacement) -> Displacement:
    """The same for what stays on the ground: height and velocity are the vehicle's."""
    return Displacement(d.angle, d.cosine, d.sine, d.turn, Vec3(d.shift.x, d.shift.y, 0.0), Vec3(0.0, 0.0, 0.0))


@law
def turned(d: Displacement, v: Vec3) -> Vec3:
    """A direction, NED."""
    return Vec3(d.cosine * v.x - d.sine * v.y, d.sine * v.x + d.cosine * v.y, v.z)


@law
def turned_ne(d: Displacement, v: Vec2) -> Vec2:
    """A direction, NE."""
    return Vec2(d.cosine * v.x - d.sine * v.y, d.sine * v.x + d.cosine * v.y)


@law
def turned_attitude(d: Displacement, q: Quat) -> Quat:
    """An attitude, body to NED."""
    return multiply(d.turn, q)


@law
def turned_heading(d: Displacement, heading: float) -> float:
    """A heading [rad]; as it was where nothing turns."""
    return heading if d.angle == 0.0 else wrap_pi(heading + d.angle)


@law
def moved(d: Displacement, p: Vec3) -> Vec3:
    """A position, NED [m]."""
    return turned(d, p) + d.shift


@law
def moved_ne(d: Displacement, p: Vec2) -> Vec2:
    """A position, NE [m]."""
    return turned_ne(d, p) + horizontal(d.shift)


@law
def faster(d: Displacement, v: Vec3) -> Vec3:
    """The vehicle's velocity, NED [m/s]."""
    return turned(d, v) + d.velocity


@law
def faster_ne(d: Displacement, v: Vec2) -> Vec2:
    """The vehicle's velocity, NE [m/s]."""
    return turned_ne(d, v) + horizontal(d.velocity)


@law
def move_past(d: Displacement, positions: Floats, k: int, age: float) -> None:
    """Row ``k`` of positions where the vehicle was, ``age`` [s] ago."""
    set_row_vector(positions, k, moved(d, row_vector(positions, k)) - age * d.velocity)


@law
def speed_along(d: Displacement, heading: float) -> float:
    """What the added velocity is along a nose of this heading [rad] after the turn [m/s]."""
    return dot2(horizontal(d.velocity), direction(heading))


@law
def goes_anywhere(d: Displacement) -> bool:
    """Whether it moves anything."""
    return d.angle != 0.0 or norm2(horizontal(d.shift)) != 0.0 or d.shift.z != 0.0
