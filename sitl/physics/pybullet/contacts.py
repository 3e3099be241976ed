# SPDX-License-Identifier: BSD-3-Clause
"""What a copter's contacts mean: standing or in the air, hard touches, runs into solids.

The rules are those of native physics (``native.obstacles``, ``native.copter.ground``): a contact with a solid that is
faster than HIT_SPEED counts unless it follows the last one within HIT_PAUSE_US; a touch of the floor out of the air
that is faster than the airframe's ``hit_speed`` counts.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import Any

from ...core.vectors import Vec3
from ..native.copter.ground import upright
from ..native.obstacles import report_hit
from ..native.records import GROUND_AIRBORNE, GROUND_LYING, GROUND_STANDING
from .worlds import Surfaces

CLEAR = 0.01
"""A copter is in the air again when it touches nothing this high over the floor [m]."""
_OTHER, _LINK, _CONTACTS_NORMAL, _CONTACTS_FORCE = 2, 3, 7, 9
"""Columns of pybullet's contacts: the other body, the link of this one, from the other to this, how hard [N]."""
BODY = -1
"""The link with the rigid outline."""

Row = Sequence[Any]


def contacts_report(v: Any, surfaces: Surfaces, rows: Sequence[Row], before: Sequence[float]) -> bool:
    """Write what the contacts of a step are into ``physics.ground`` and ``physics.obstacles``.

    Args:
        v: the vehicle.
        surfaces: of its world.
        rows: pybullet's contacts of it.
        before: its velocity before the step, NED [m/s].

    Returns:
        Whether the rigid outline was pushed.
    """
    p = v.physics
    into, on_floor, in_solid, is_hard = 0.0, False, False, False
    for row in rows:
        if row[_CONTACTS_FORCE] <= 0.0:
            continue
        is_hard = is_hard or row[_LINK] == BODY
        if row[_OTHER] == surfaces.floor:
            on_floor = True
        else:
            in_solid = True
            x, y, z = row[_CONTACTS_NORMAL]
            into = max(into, y * before[1] + z * before[2] - x * before[0])
    o = p.obstacles
    if in_solid or o.touching:
        o.touching = in_solid
    report_hit(o, into, v.time_us)
    if on_floor:
        touch(v, before[2])
    elif p.ground.state != GROUND_AIRBORNE and p.body.pos.z < -CLEAR:
        p.ground.state = GROUND_AIRBORNE
    return is_hard


def touch(v: Any, speed: float) -> None:
    """On the floor after a step that began with ``speed`` [m/s] downward."""
    g, a, q = v.physics.ground, v.physics.airframe, v.physics.body.q
    if g.state == GROUND_AIRBORNE and speed > a.hit_speed:
        g.hit_count += 1
        g.hit_speed = speed
        g.hit_time_us = v.time_us
    g.state = GROUND_STANDING if upright(q) >= math.cos(float(a.tip_angle)) else GROUND_LYING


_POSITION, _HITS_NORMAL, _HITS_FORCE = 5, 7, 9
"""Columns of pybullet's contacts: where on this body, from the other body to this one, how hard [N]."""

Vector = tuple[float, float, float]


def hits_report(
    v: Any, rows: Sequence[Sequence[Any]], centre: Vector, velocity: Vector, spin: Vector, gain: float
) -> None:
    """Write what the contacts of a step are into ``physics.obstacles`` and ``physics.motion.contact``.

    Args:
        v: the vehicle.
        rows: pybullet's contacts of its outline.
        centre, velocity, spin: of its chassis before the step, in Bullet's frame [m, m/s, rad/s].
        gain: change of velocity by force in a step [m/s/N].
    """
    o, motion = v.physics.obstacles, v.physics.motion
    fastest, is_touching = 0.0, False
    ox, oy, oz = spin
    for row in rows:
        force = row[_HITS_FORCE]
        if force <= 0.0:
            continue
        is_touching = True
        nx, ny, nz = row[_HITS_NORMAL]
        x, y, z = (at - mid for at, mid in zip(row[_POSITION], centre))
        vx, vy, vz = velocity[0] + oy * z - oz * y, velocity[1] + oz * x - ox * z, velocity[2] + ox * y - oy * x
        fastest = max(fastest, -(nx * vx + ny * vy + nz * vz))
        motion.contact += Vec3(gain * force * nx, -(gain * force * ny), -(gain * force * nz))
    o.touching = is_touching
    report_hit(o, fastest, v.time_us)
