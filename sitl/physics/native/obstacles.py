# SPDX-License-Identifier: BSD-3-Clause
"""Contact with the solids of a world.

A vehicle's record lists the solids near it, so that it stays one record of a fixed size: a copy of it is the whole
state, and a fleet needs nothing else. When the vehicle leaves the place for which the list is good, ``wanted`` asks
the shell for a new one (``sitl.worlds.contact.near``) before the next tick.

The vehicle's outline is a row of upright discs along its body between two heights. It does not enter a solid: it is
pushed out along the solid's normal and loses the velocity into it, without bounce. Sides have no friction; on top of a
solid it comes to rest.
"""

from __future__ import annotations

import math

from ...core.kernels import law
from ...core.records import Float32, Floats, Record, array
from ...core.rotations import quat_rotate_inverse
from ...worlds.contact import nearest_of
from ...worlds.geometry import SOLID_FIGURES
from .body import GRAVITY
from .tick import TICK_S

OBSTACLES_MAX = 24
"""Solids in the list."""
HIT_SPEED = 0.1
"""Slowest contact that is reported [m/s]."""
HIT_PAUSE_US = 250_000
"""Contacts that follow sooner belong to the last one."""
_TOUCH = 1e-6
"""A solid that is nearer than this is touched [m]."""
_UPWARD = -0.9
"""Down component of the normal of what can be stood on: less than this."""
_FRICTION = 0.8
"""Of rubber feet."""
_AHEAD = 0.5
"""A new list is asked for this far before the old one ends [m]: more than any vehicle moves in a tick."""
_RELEASE = 1.0 - math.exp(-TICK_S / 0.02)
"""Share of an impact that shows in a tick: body and bumper give way for some 0.02 s, as a copter's legs do. All of it
in one tick would be beyond what an accelerometer can show."""


class Obstacles(Record):
    """The solids near the vehicle, and contact with them."""

    present: int  # there is a world with solids
    count: int  # rows of the list
    north: float  # where it was gathered, NED as body.pos [m]
    east: float
    complete: float  # every solid nearer to there is in the list [m]
    rows: Floats = array(OBSTACLES_MAX, SOLID_FIGURES)
    wanted: int  # the list no longer does
    looked: Floats = array(3)  # where the vehicle was when distances were last worked out [m]
    clear: float  # the nearest solid was at least this far away then [m]
    turned: float  # angle that the body has turned by since [rad]
    touching: int
    hit_count: int  # contacts so far that were faster than HIT_SPEED
    hit_speed: Float32  # of the last one, into the solid [m/s]
    hit_time_us: int
    impulse: Floats = array(3)  # velocity taken away that the accelerometer still has to show, NED [m/s]


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
    if down < _UPWARD:
        stand(p, into)
    return into


@law
def stand(p, into):
    """On top of a solid: Coulomb friction, which goes with the velocity ``into`` it that was taken away [m/s], and feet
    that end a rotation.
    """
    b = p.body
    n, e = float(b.vel[0]), float(b.vel[1])
    speed, grip = math.sqrt(n * n + e * e), _FRICTION * into
    left = 0.0
    if speed > grip:
        left = 1.0 - grip / speed
    b.vel[0] = left * n
    b.vel[1] = left * e
    for j in range(3):
        b.rates[j] *= 1.0 - _RELEASE


@law
def half_length(p):
    """How far the middles of the outline's discs are from the origin at most [m]."""
    longest = 0.0
    for k in range(int(p.airframe.contact_discs)):
        longest = max(longest, abs(float(p.airframe.contact_along[k])))
    return longest


@law
def is_clear(p):
    """Whether the vehicle cannot have reached a solid since distances were last worked out."""
    o, b = p.obstacles, p.body
    turns = abs(float(b.rates_mean[0])) + abs(float(b.rates_mean[1])) + abs(float(b.rates_mean[2]))
    o.turned += TICK_S * turns
    left = float(o.clear) - float(o.turned) * half_length(p)
    n, e = float(b.pos[0]) - float(o.looked[0]), float(b.pos[1]) - float(o.looked[1])
    d = float(b.pos[2]) - float(o.looked[2])
    return left > 0.0 and n * n + e * e + d * d < left * left


@law
def collide(p, time_us):
    """After the body has moved in a world: keep it out of solids. Returns whether it was pushed."""
    o, b = p.obstacles, p.body
    if is_clear(p):
        return False
    vn, ve, vd = float(b.vel[0]), float(b.vel[1]), float(b.vel[2])
    o.touching = 0
    speed, clear, is_pushed = 0.0, math.inf, False
    for k in range(int(p.airframe.contact_discs)):
        for _ in range(2):  # a corner has two sides
            distance, north, east, down = nearest(p, k)
            clear = min(clear, distance)
            if distance < _TOUCH:
                o.touching = 1
            if distance >= 0.0:
                break
            is_pushed = True
            speed = max(speed, separate(p, distance, north, east, down))
    o.clear = clear
    o.turned = 0.0
    for j in range(3):
        o.looked[j] = b.pos[j]
    ask(p)
    if not is_pushed:
        return False
    if speed > HIT_SPEED and (o.hit_count == 0 or time_us - o.hit_time_us > HIT_PAUSE_US):
        o.hit_count += 1
        o.hit_speed = speed
        o.hit_time_us = time_us
    o.impulse[0] += float(b.vel[0]) - vn
    o.impulse[1] += float(b.vel[1]) - ve
    o.impulse[2] += float(b.vel[2]) - vd
    return True


@law
def ask(p):
    """Ask for a new list when the vehicle comes to the end of the old one."""
    o, b, a = p.obstacles, p.body, p.airframe
    away = math.hypot(float(b.pos[0]) - float(o.north), float(b.pos[1]) - float(o.east))
    left = float(o.complete) - away - half_length(p) - float(a.contact_radius) - _AHEAD
    if left <= 0.0:
        o.wanted = 1
        o.clear = 0.0
    else:
        o.clear = min(float(o.clear), left)


@law
def settle(p):
    """At rest on hard ground: the accelerometer shows its support from the first tick on, although each tick's share of
    it is spread like an impact."""
    p.obstacles.impulse[2] = -GRAVITY * TICK_S * (1.0 - _RELEASE) / _RELEASE


@law
def show(p):
    """Let acceleration and specific force of this tick show what is left of impacts."""
    o, b = p.obstacles, p.body
    n, e, d = float(o.impulse[0]), float(o.impulse[1]), float(o.impulse[2])
    if n == 0.0 and e == 0.0 and d == 0.0:
        return
    share = _RELEASE
    if n * n + e * e + d * d < 1e-12:
        share = 1.0
    n, e, d = share * n, share * e, share * d
    o.impulse[0] -= n
    o.impulse[1] -= e
    o.impulse[2] -= d
    n, e, d = n / TICK_S, e / TICK_S, d / TICK_S
    b.acc_ned[0] += n
    b.acc_ned[1] += e
    b.acc_ned[2] += d
    fx, fy, fz = quat_rotate_inverse(float(b.q[0]), float(b.q[1]), float(b.q[2]), float(b.q[3]), n, e, d)
    b.specific_force[0] += fx
    b.specific_force[1] += fy
    b.specific_force[2] += fz
