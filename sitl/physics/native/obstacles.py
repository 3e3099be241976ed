# SPDX-License-Identifier: BSD-3-Clause
"""Contact with the solids of a world.

A vehicle's record lists the solids near it, so that it stays one record of a fixed size: a copy of it is the whole
state. When the vehicle leaves the position for which the list is good, ``wanted`` asks for a new one before the next
tick (``list_solids``).

The vehicle's outline is a row of upright discs along its body between two heights. It does not enter a solid: it is
pushed out along the solid's normal and loses the velocity into it, without bounce. Sides have no friction; on top of a
solid it comes to rest.
"""

from __future__ import annotations

import math

from ...core.algebra import dot, rotate_inverse
from ...core.array_kernels import Table
from ...core.constants import GRAVITY, TICK_S
from ...core.elementary import exp, hypot
from ...core.kernels import law
from ...core.vectors import Vec2, Vec3
from ...vehicles.properties.body import Outline
from ...worlds.contact import Contact, Volume, gather, nearest_of
from ...worlds.geometry import BOTTOM, SOLID_COLUMNS, TOP
from .records import OBSTACLES_MAX, Body, Obstacles

REACH = 30.0
"""Solids farther away than this are not listed [m]."""
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
_RELEASE = 1.0 - exp(-TICK_S / 0.02)
"""Share of an impact that shows in a tick: body and bumper give way for some 0.02 s, as a copter's legs do. All of it
in one tick would be beyond what an accelerometer can show."""


@law
def list_solids(o: Obstacles, body: Body, solids: Table, floor: float) -> None:
    """List the solids near a body.

    Args:
        o: the list.
        body: of the vehicle.
        solids: of the world, shape (n, SOLID_COLUMNS), down from z = 0 of its frame.
        floor: height of the floor in the world's frame [m]; the list's rows count from the floor.
    """
    position, rows = Vec2(body.pos.x, body.pos.y), o.rows
    listed = gather(solids, position, REACH, rows)
    for k in range(listed.rows):
        rows[k, TOP] += floor
        rows[k, BOTTOM] += floor
    for k in range(listed.rows, OBSTACLES_MAX):
        for column in range(SOLID_COLUMNS):
            rows[k, column] = 0.0
    o.count, o.north, o.east, o.complete = listed.rows, position.x, position.y, listed.complete
    o.clear = 0.0
    o.wanted = False


@law
def disc(body: Body, outline: Outline, k: int) -> Volume:
    """Where disc ``k`` of the outline is."""
    along, q, pos = outline.contact_along[k], body.q, body.pos
    n = pos.x + along * (1.0 - 2.0 * (q.y * q.y + q.z * q.z))
    e = pos.y + along * 2.0 * (q.x * q.y + q.w * q.z)
    d = pos.z + along * 2.0 * (q.x * q.z - q.w * q.y)
    return Volume(Vec2(n, e), d - outline.contact_top, d + outline.contact_bottom, outline.contact_radius)


@law
def nearest(body: Body, obstacles: Obstacles, outline: Outline, k: int) -> Contact:
    """The listed solid nearest to disc ``k`` of the outline."""
    return nearest_of(obstacles.rows, obstacles.count, disc(body, outline, k))


@law
def separate(body: Body, distance: float, normal: Vec3) -> float:
    """Push the body out of a solid, ``distance`` [m] below 0 away along its normal (NED), and take away its velocity
    into it; returns that [m/s].
    """
    body.pos -= distance * normal
    into = -dot(body.vel, normal)
    if into <= 0.0:
        return 0.0
    body.vel += into * normal
    if normal.z < _UPWARD:
        stand(body, into)
    return into


@law
def stand(body: Body, into: float) -> None:
    """On top of a solid: Coulomb friction, which goes with the velocity ``into`` it that was taken away [m/s], and feet
    that end a rotation.
    """
    vel = body.vel
    speed, grip = math.sqrt(vel.x * vel.x + vel.y * vel.y), _FRICTION * into
    left = 0.0
    if speed > grip:
        left = 1.0 - grip / speed
    body.vel = Vec3(left * vel.x, left * vel.y, vel.z)
    stop_turning(body)


@law
def stop_turning(body: Body) -> None:
    """What feet do to a rotation in a tick."""
    body.rates *= 1.0 - _RELEASE


@law
def half_length(outline: Outline) -> float:
    """How far the middles of the outline's discs are from the origin at most [m]."""
    longest = 0.0
    for k in range(outline.contact_discs):
        longest = max(longest, abs(outline.contact_along[k]))
    return longest


@law
def is_clear(o: Obstacles, body: Body, half: float) -> bool:
    """Whether a vehicle of a half length [m] cannot have reached a solid since distances were last worked out; called
    every tick."""
    rates = body.rates_mean
    o.turned += TICK_S * (abs(rates.x) + abs(rates.y) + abs(rates.z))
    left, moved = o.clear - o.turned * half, body.pos - o.looked
    return left > 0.0 and dot(moved, moved) < left * left


@law
def push_out(o: Obstacles, body: Body, outline: Outline) -> float:
    """Push the body out of the solids that it is in, and note what is near; returns the greatest speed into one [m/s],
    below 0 when it was not pushed.
    """
    o.touching = False
    speed, clear = -1.0, math.inf
    for k in range(outline.contact_discs):
        for _ in range(2):  # a corner has two sides
            contact = nearest(body, o, outline, k)
            clear = min(clear, contact.distance)
            if contact.distance < _TOUCH:
                o.touching = True
            if contact.distance >= 0.0:
                break
            speed = max(speed, separate(body, contact.distance, contact.normal))
    o.clear = clear
    o.turned = 0.0
    o.looked = body.pos
    return speed


@law
def collide(o: Obstacles, body: Body, outline: Outline, time_us: int) -> bool:
    """After the body has moved in a world: keep it out of solids. Returns whether it was pushed."""
    half = half_length(outline)
    if is_clear(o, body, half):
        return False
    before = body.vel
    speed = push_out(o, body, outline)
    ask(o, body, half, outline.contact_radius)
    if speed < 0.0:
        return False
    report_hit(o, speed, time_us)
    o.impulse += body.vel - before
    return True


@law
def report_hit(o: Obstacles, speed: float, time_us: int) -> None:
    """Count a contact at ``speed`` [m/s] into a solid, unless it is slow or belongs to the last one."""
    if speed > HIT_SPEED and (o.hit_count == 0 or time_us - o.hit_time_us > HIT_PAUSE_US):
        o.hit_count += 1
        o.hit_speed = speed
        o.hit_time_us = time_us


@law
def ask(o: Obstacles, body: Body, half: float, radius: float) -> None:
    """Ask for a new list when the vehicle, of this half length and radius [m], comes to the end of the old one."""
    away = hypot(body.pos.x - o.north, body.pos.y - o.east)
    left = o.complete - away - half - radius - _AHEAD
    if left <= 0.0:
        o.wanted = True
        o.clear = 0.0
    else:
        o.clear = min(o.clear, left)


@law
def settle(o: Obstacles) -> None:
    """At rest on hard ground: the accelerometer shows its support from the first tick on, although each tick's share of
    it is spread like an impact."""
    o.impulse = Vec3(o.impulse.x, o.impulse.y, -GRAVITY * TICK_S * (1.0 - _RELEASE) / _RELEASE)


@law
def show(o: Obstacles, body: Body) -> None:
    """Let acceleration and specific force of this tick show what is left of impacts."""
    impulse = o.impulse
    if impulse.x == 0.0 and impulse.y == 0.0 and impulse.z == 0.0:
        return
    share = _RELEASE
    if dot(impulse, impulse) < 1e-12:
        share = 1.0
    shown = share * impulse
    o.impulse = impulse - shown
    acc = shown / TICK_S
    body.acc_ned += acc
    body.specific_force += rotate_inverse(body.q, acc)
