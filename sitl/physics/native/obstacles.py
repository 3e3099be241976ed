# SPDX-License-Identifier: BSD-3-Clause
"""Contact with the solids of a world.

A vehicle's record lists the solids near it, so that it stays one record of a fixed size: a copy of it is the whole
state, and a fleet needs nothing else. When the vehicle leaves the place for which the list is good, ``wanted`` asks
the shell for a new one (``sitl.worlds.contact.near``) before the next tick.

The vehicle's outline is a row of discs along its body between two heights. It does not enter a solid: it is pushed
out along the solid's normal and loses the velocity into it, without bounce and without friction.
"""

from __future__ import annotations

import math

from ...core.kernels import law
from ...core.records import record
from ...worlds.contact import nearest_of
from ...worlds.geometry import SOLID_FIGURES
from .tick import TICK_S

OBSTACLES_MAX = 24
"""Solids in the list."""
_AHEAD = 0.5
"""A new list is asked for this far before the old one ends [m]: more than any vehicle moves in a tick."""
_SURE = 1.001
"""The way of a tick is counted this much too long, against rounding."""

OBSTACLES_DTYPE = record(
    ("present", "i8"),  # there is a world with solids
    ("count", "i8"),  # rows of the list
    ("north", "f8"),  # where it was gathered, NED as body.pos [m]
    ("east", "f8"),
    ("complete", "f8"),  # every solid nearer to there is in the list [m]
    ("rows", "f8", (OBSTACLES_MAX, SOLID_FIGURES)),
    ("wanted", "i8"),  # the list no longer does
    ("clear", "f8"),  # the nearest solid is at least this far away [m]
    ("touching", "i8"),
    ("hit_count", "i8"),  # contacts so far
    ("hit_speed", "f8"),  # of the last one, into the solid [m/s]
    ("hit_time_us", "i8"),
)


@law
def nearest(p, k):
    """The listed solid nearest to disc ``k`` of the outline: (distance [m], normal north, east, down)."""
    a, b, o = p.airframe, p.body, p.obstacles
    along = float(a.contact_along[k])
    w, x, y, z = float(b.q[0]), float(b.q[1]), float(b.q[2]), float(b.q[3])
    n = float(b.pos[0]) + along * (1.0 - 2.0 * (y * y + z * z))
    e = float(b.pos[1]) + along * 2.0 * (x * y + w * z)
    d = float(b.pos[2]) + along * 2.0 * (x * z - w * y)
    top, bottom = d - float(a.contact_top), d + float(a.contact_bottom)
    distance, north, east, down, _ = nearest_of(o.rows, int(o.count), n, e, top, bottom, float(a.contact_radius))
    return (distance, north, east, down)


@law
def separate(p, distance, north, east, down):
    """Push the body out of a solid and take away its velocity into it; returns that [m/s]."""
    b = p.body
    b.pos[0] -= distance * north
    b.pos[1] -= distance * east
    b.pos[2] -= distance * down
    into = -(float(b.vel[0]) * north + float(b.vel[1]) * east + float(b.vel[2]) * down)
    if into <= 0.0:
        return 0.0
    b.vel[0] += into * north
    b.vel[1] += into * east
    b.vel[2] += into * down
    return into


@law
def collide(p, time_us):
    """After the body has moved: keep it out of solids. Returns the velocity that was taken away, NED [m/s]."""
    o, b = p.obstacles, p.body
    if o.present == 0:
        return (0.0, 0.0, 0.0)
    vn, ve, vd = float(b.vel[0]), float(b.vel[1]), float(b.vel[2])
    turn = 0.0
    for k in range(int(p.airframe.contact_discs)):
        turn = max(turn, abs(float(p.airframe.contact_along[k])))
    rates = abs(float(b.rates[0])) + abs(float(b.rates[1])) + abs(float(b.rates[2]))
    o.clear -= _SURE * TICK_S * (math.sqrt(vn * vn + ve * ve + vd * vd) + turn * rates)
    if o.clear > 0.0:
        return (0.0, 0.0, 0.0)
    was_touching, speed = o.touching, 0.0
    o.touching = 0
    clear = math.inf
    for k in range(int(p.airframe.contact_discs)):
        for _ in range(2):  # a corner has two sides
            distance, north, east, down = nearest(p, k)
            clear = min(clear, distance)
            if distance >= 0.0:
                break
            o.touching = 1
            speed = max(speed, separate(p, distance, north, east, down))
    o.clear = clear
    if o.touching != 0 and was_touching == 0:
        o.hit_count += 1
        o.hit_speed = speed
        o.hit_time_us = time_us
    ask(p, turn)
    return (float(b.vel[0]) - vn, float(b.vel[1]) - ve, float(b.vel[2]) - vd)


@law
def ask(p, turn):
    """Ask for a new list when the vehicle, ``turn`` [m] long to each side, comes to the end of the old one."""
    o, b = p.obstacles, p.body
    reach = math.hypot(float(b.pos[0]) - float(o.north), float(b.pos[1]) - float(o.east)) + turn
    left = float(o.complete) - reach - float(p.airframe.contact_radius) - _AHEAD
    if left <= 0.0:
        o.wanted = 1
        o.clear = 0.0
    else:
        o.clear = min(float(o.clear), left)
