# SPDX-License-Identifier: BSD-3-Clause
"""What a rover's contacts with solids mean; the rules are those of native physics (``native.obstacles``)."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

from ...core.vectors import Vec3
from ..native.obstacles import report_hit

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
    o, motion = v.physics.obstacles, v.physics.motion
    fastest, is_touching = 0.0, False
    ox, oy, oz = spin
    for row in rows:
        force = row[_FORCE]
        if force <= 0.0:
            continue
        is_touching = True
        nx, ny, nz = row[_NORMAL]
        x, y, z = (at - mid for at, mid in zip(row[_PLACE], centre))
        vx, vy, vz = velocity[0] + oy * z - oz * y, velocity[1] + oz * x - ox * z, velocity[2] + ox * y - oy * x
        fastest = max(fastest, -(nx * vx + ny * vy + nz * vz))
        motion.contact += Vec3(gain * force * nx, -(gain * force * ny), -(gain * force * nz))
    o.touching = is_touching
    report_hit(o, fastest, v.time_us)
