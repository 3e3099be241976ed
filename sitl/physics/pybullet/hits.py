# SPDX-License-Identifier: BSD-3-Clause
"""What a rover's contacts with solids mean; the rules are those of native physics (``native.obstacles``)."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

from ..native.obstacles import HIT_PAUSE_US, HIT_SPEED

_PLACE, _NORMAL, _FORCE = 5, 7, 9
"""Columns of pybullet's contacts: where on this body, from the other body to this one, how hard [N]."""

Vector = tuple[float, float, float]


def report(v: Any, rows: Sequence[Sequence[Any]], centre: Vector, velocity: Vector, spin: Vector, gain: float) -> None:
    """Write what the contacts of a step are into ``physics.obstacles`` and ``physics.motion.contact``.

    Args:
        v: the vehicle.
        rows: pybullet's contacts of its outline.
        centre, velocity, spin: of its chassis before the step, in Bullet's frame [m, m/s, rad/s].
        gain: change of velocity by force in a step [m/s/N].
    """
    o, contact = v.physics.obstacles, v.physics.motion.contact
    fastest, is_touching = 0.0, 0
    ox, oy, oz = spin
    for row in rows:
        force = row[_FORCE]
        if force <= 0.0:
            continue
        is_touching = 1
        nx, ny, nz = row[_NORMAL]
        x, y, z = (at - mid for at, mid in zip(row[_PLACE], centre))
        vx, vy, vz = velocity[0] + oy * z - oz * y, velocity[1] + oz * x - ox * z, velocity[2] + ox * y - oy * x
        fastest = max(fastest, -(nx * vx + ny * vy + nz * vz))
        contact[0] += gain * force * nx
        contact[1] -= gain * force * ny
        contact[2] -= gain * force * nz
    o.touching = is_touching
    if fastest > HIT_SPEED and (o.hit_count == 0 or v.time_us - o.hit_time_us > HIT_PAUSE_US):
        o.hit_count += 1
        o.hit_speed = fastest
        o.hit_time_us = v.time_us
