# SPDX-License-Identifier: BSD-3-Clause
"""Vehicles that share a world: what each shows to the others, what rays meet of them, and what collisions do.

All vehicles show themselves at the same time, once a ``SLICE_US``; in between the others know them by that and by the
way that they were going. So nothing depends on the order in which vehicles are advanced. Those that may reach another
one within a slice are ``is_near``: they are advanced tick by tick, and meet after each.

A vehicle's volume is its outline: upright discs. Two volumes do not enter each other: they are pushed apart, and lose
the velocity into each other without bounce, each by its share of the mass. The record of a kind of vehicle is read and
written elsewhere (``sitl.vehicle.traffic``): vehicles of several kinds can meet.
"""

from __future__ import annotations

import math
from typing import NamedTuple

from ...core.algebra import ZERO, dot
from ...core.array_kernels import Kernel, Line, Table
from ...core.kernels import law
from ...core.memory import record_at
from ...core.records import Floats, Record, array
from ...core.rng import Rng
from ...core.vectors import Vec2, Vec3
from ...vehicles.properties.body import OUTLINE_DISCS
from ...worlds.contact import Contact, Volume
from ...worlds.planar import Span, to_cylinder
from .records import Wind
from .wind import share_of_period, stir

SLICE_US = 20_000
"""Simulated time from one showing to the next [us]."""
_SLICE_S = 1e-6 * SLICE_US
_MARGIN = 0.25
"""What may come nearer than the present velocities say within a slice [m]: 500 m/s^2, both together."""
_TINY = 1e-9
"""[m]"""
_UPRIGHT = 0.9
"""Down component of the normal between two of which one stands on the other: at least this."""
_FRICTION = 0.8
"""Of rubber feet."""
NOBODY, NEAR, PUSHED = 0, 1, 2
"""What ``meet`` says of all vehicles: none is near another one, some are, some have been pushed."""


class Mover(Record):
    """What a vehicle shows."""

    pos: Vec3  # of the body's origin, NED from the world's origin on the floor [m]
    vel: Vec3  # NED [m/s]
    nose: Vec3  # where the body's x axis points, NED
    since_us: int  # the vehicle's own clock when it showed itself [us since boot]
    inverse_mass: float  # [1/kg]
    is_low: bool  # it is on the floor: nothing pushes it down
    discs: int  # of its outline; 0: it has no volume
    along: Floats = array(OUTLINE_DISCS)  # their middles, forward of the origin [m]
    top: float  # how far they reach above the origin [m]
    bottom: float  # and below [m]
    radius: float  # of each [m]
    half_length: float  # greatest distance of a middle from the origin [m]
    is_near: bool  # it may touch another one within a slice
    # what came of meeting others, for the vehicle to take over
    is_pushed: bool
    shift: Vec3  # NED [m]
    change: Vec3  # of its velocity, NED [m/s]
    hit_speed: float  # greatest into another one [m/s]
    rests: bool  # on another one


MOVER_SIZE = Mover.dtype.itemsize


class SharedWind(Record):
    """The wind that all feel: its settings and gusts."""

    wind: Wind
    rng: Rng


class Others(NamedTuple):
    """The others, as a vehicle that measures finds them."""

    movers: int
    """Address of the first ``Mover`` of all."""
    total: int
    """How many there are."""
    own: int
    """Number of the vehicle itself."""
    time_us: int
    """Its own clock [us since boot]."""


@law
def volume(m: Mover, k: int, pos: Vec3) -> Volume:
    """Disc ``k`` of a vehicle's outline, its origin being at ``pos``."""
    middle = pos + m.along[k] * m.nose
    return Volume(Vec2(middle.x, middle.y), middle.z - m.top, middle.z + m.bottom, m.radius)


@law
def meet_rays(others: Others, origin: Vec3, directions: Table, reach: float, ranges: Line) -> None:
    """Shorten ranges [m] to where rays meet other vehicles.

    Args:
        others: that may be met.
        origin: of the rays, NED from the world's origin on the floor [m].
        directions: unit vectors NED, shape (3, n).
        reach: of the rays [m].
        ranges: to what else the rays meet, inf for nothing, shape (n,).
    """
    elapsed = 1e-6 * (others.time_us - record_at(Mover, others.movers + others.own * MOVER_SIZE).since_us)
    elapsed = min(max(elapsed, 0.0), _SLICE_S)
    for number in range(others.total):
        m = record_at(Mover, others.movers + number * MOVER_SIZE)
        pos = m.pos + elapsed * m.vel
        away, far = pos - origin, reach + m.half_length + m.radius
        if number == others.own or away.x * away.x + away.y * away.y > far * far:
            continue
        for k in range(m.discs):
            v = volume(m, k, pos)
            offset = Vec2(origin.x - v.axis.x, origin.y - v.axis.y)
            heights = Span(v.top - origin.z, v.bottom - origin.z)
            for ray in range(ranges.shape[0]):
                direction = Vec3(directions[0, ray], directions[1, ray], directions[2, ray])
                met = to_cylinder(offset, v.radius, heights, direction)
                ranges[ray] = met if met < ranges[ray] else ranges[ray]


@law
def between(a: Volume, b: Volume) -> Contact:
    """How near two discs are; the normal points from ``b`` to ``a``."""
    dn, de = a.axis.x - b.axis.x, a.axis.y - b.axis.y
    apart = math.sqrt(dn * dn + de * de)
    away = Vec2(dn / apart, de / apart) if apart > _TINY else Vec2(1.0, 0.0)
    level = apart - a.radius - b.radius
    above, below = b.top - a.bottom, a.top - b.bottom  # gaps when ``a`` is above, below
    upright, down = max(above, below), -1.0 if above >= below else 1.0
    if level > 0.0 and upright > 0.0:
        distance = math.sqrt(level * level + upright * upright)
        share = level / distance
        return Contact(distance, Vec3(away.x * share, away.y * share, down * upright / distance), 0)
    if level >= upright:
        return Contact(level, Vec3(away.x, away.y, 0.0), 0)
    return Contact(upright, Vec3(0.0, 0.0, down), 0)


@law
def yields(m: Mover, down: float) -> float:
    """Inverse mass [1/kg] with which a vehicle gives way to a push with this component down: the floor holds it."""
    return 0.0 if m.is_low and down > _UPRIGHT else m.inverse_mass


@law
def push(m: Mover, shift: Vec3, change: Vec3) -> None:
    """Move a vehicle by ``shift`` [m], and change its velocity [m/s], NED."""
    m.pos += shift
    m.vel += change
    m.shift += shift
    m.change += change
    m.is_pushed = True


@law
def part(a: Mover, b: Mover, contact: Contact) -> None:
    """Push two overlapping vehicles apart, and take away their velocities into each other."""
    normal = contact.normal
    of_a, of_b = yields(a, normal.z), yields(b, -normal.z)
    if of_a + of_b == 0.0:
        return
    of_a, of_b = of_a / (of_a + of_b), of_b / (of_a + of_b)
    shift, between_them = -contact.distance * normal, a.vel - b.vel
    into = -dot(between_them, normal)
    change = max(into, 0.0) * normal
    if abs(normal.z) > _UPRIGHT:
        slip, grip = math.sqrt(between_them.x * between_them.x + between_them.y * between_them.y), _FRICTION * into
        if grip > 0.0 and slip > 0.0:
            held = min(grip / slip, 1.0)
            change = Vec3(-held * between_them.x, -held * between_them.y, change.z)
        if normal.z < 0.0:
            a.rests = True
        else:
            b.rests = True
    push(a, of_a * shift, of_a * change)
    push(b, -of_b * shift, -of_b * change)
    a.hit_speed = max(a.hit_speed, into)
    b.hit_speed = max(b.hit_speed, into)


@law
def may_touch(a: Mover, b: Mover) -> bool:
    """Whether two vehicles may touch each other within a slice."""
    apart, rel = a.pos - b.pos, a.vel - b.vel
    ahead = _MARGIN + _SLICE_S * math.sqrt(dot(rel, rel))
    level = a.half_length + a.radius + b.half_length + b.radius + ahead
    if apart.x * apart.x + apart.y * apart.y > level * level:
        return False
    slant = a.half_length * abs(a.nose.z) + b.half_length * abs(b.nose.z) + ahead
    return -a.bottom - b.top - slant < apart.z < a.top + b.bottom + slant


@law
def touch(a: Mover, b: Mover) -> bool:
    """Part two vehicles where they overlap; False: they do not."""
    pushed = False
    for k in range(a.discs):
        for n in range(b.discs):
            contact = between(volume(a, k, a.pos), volume(b, n, b.pos))
            if contact.distance < 0.0:
                part(a, b, contact)
                pushed = True
    return pushed


@law
def meet(movers: int, count: int, only_near: bool) -> int:
    """Let vehicles that have shown themselves meet; NOBODY, NEAR or PUSHED.

    Args:
        movers: address of the first ``Mover``.
        count: how many there are.
        only_near: those that are not ``is_near`` have not shown themselves, and meet nobody; else, all have, and it is
            found who is near.
    """
    result = NOBODY
    for i in range(count):
        m = record_at(Mover, movers + i * MOVER_SIZE)
        m.is_near = m.is_near and only_near
        m.is_pushed = m.rests = False
        m.shift = m.change = ZERO
        m.hit_speed = 0.0
    for i in range(count):
        a = record_at(Mover, movers + i * MOVER_SIZE)
        if a.discs == 0 or (only_near and not a.is_near):
            continue
        for j in range(i + 1, count):
            b = record_at(Mover, movers + j * MOVER_SIZE)
            if b.discs == 0 or (only_near and not b.is_near) or not may_touch(a, b):
                continue
            a.is_near = b.is_near = True
            result = max(result, PUSHED if touch(a, b) else NEAR)
    return result


@law
def stir_shared(address: int) -> None:
    """Step the gusts of the ``SharedWind`` at an address by the period of the wind."""
    shared = record_at(SharedWind, address)
    stir(shared.wind, shared.rng, share_of_period(shared.wind))


let_meet = Kernel(meet)
stir_wind = Kernel(stir_shared)
