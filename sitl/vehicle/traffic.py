# SPDX-License-Identifier: BSD-3-Clause
"""What a vehicle shows to those that share its world, and what becomes of it when it meets one."""

from __future__ import annotations

from ..autopilot.events import emit
from ..autopilot.hits import HIT_OBSTACLE
from ..core.algebra import rotate
from ..core.kernels import law
from ..core.vectors import Vec3
from ..physics.native.obstacles import half_length, report_hit, stop_turning
from ..physics.native.traffic import Mover
from .record import Vehicle

_ON_FLOOR = -1e-6
"""Down coordinate from which on a vehicle is on the floor [m]."""
_FORWARD = Vec3(1.0, 0.0, 0.0)


@law
def show(v: Vehicle, m: Mover) -> None:
    """Write what a vehicle shows."""
    body, a = v.physics.body, v.physics.airframe
    m.pos, m.vel, m.nose = body.pos, body.vel, rotate(body.q, _FORWARD)
    m.since_us, m.inverse_mass, m.is_low = v.time_us, 1.0 / a.mass, body.pos.z > _ON_FLOOR
    m.discs = a.contact_discs if a.contact_radius > 0.0 else 0
    for k in range(a.contact_discs):
        m.along[k] = a.contact_along[k]
    m.top, m.bottom, m.radius, m.half_length = a.contact_top, a.contact_bottom, a.contact_radius, half_length(a)


@law
def take_push(v: Vehicle, m: Mover) -> None:
    """Take over what came of meeting others; HIT_OBSTACLE as of a solid."""
    body, o = v.physics.body, v.physics.obstacles
    body.pos += m.shift
    body.vel += m.change
    if m.rests:
        stop_turning(body)
    o.impulse += m.change
    o.touching, o.clear = True, 0.0
    count = o.hit_count
    report_hit(o, m.hit_speed, v.time_us)
    if o.hit_count != count:
        emit(v.autopilot.events, v.time_us, HIT_OBSTACLE, m.hit_speed, 0.0)
