# SPDX-License-Identifier: BSD-3-Clause
"""Where other vehicles are, for FOLLOW: GLOBAL_POSITION_INT and FOLLOW_TARGET of another system id.

A lead that sends FOLLOW_TARGET is followed by that alone.
"""

from __future__ import annotations

import math

from ...autopilot.followed_vehicle import Report, is_lead, take
from ...core.algebra import ZERO, rotate, yaw_of
from ...core.kernels import law
from ...core.mavlink import MavFrame
from ...core.records import Floats
from ...core.scalars import finite
from ...core.vectors import Vec3
from ...vehicle.record import Vehicle
from ..locations import local_position
from ..telemetry.motion import GlobalPositionInt
from ..wire.message import Message
from .setpoint_messages import rotation

HEADINGS = 36_000
"""Headings of GLOBAL_POSITION_INT are 0 .. 36000 [centidegrees]; more: unknown."""
HAS_POSITION, HAS_VELOCITY, HAS_ACCELERATION, HAS_ATTITUDE = 1, 2, 4, 8
"""est_capabilities; attitude stands for body rates, too."""


class FollowTarget(Message, name="FOLLOW_TARGET"):
    """degE7, m above sea level; NED [m/s], [m/s^2]; body to NED; body rates [rad/s]."""

    lat: int
    lon: int
    alt: float
    vel: Floats
    acc: Floats
    attitude_q: Floats
    rates: Floats
    est_capabilities: int


@law
def take_position(m: GlobalPositionInt, v: Vehicle, sender: int, over_home: bool) -> None:
    """GLOBAL_POSITION_INT of another vehicle; ``over_home``: its height above home counts, not that above the sea."""
    ap = v.autopilot
    lead, p = ap.modes.follow, ap.params.FOLL
    if (m.lat == 0 and m.lon == 0) or lead.sends_more or not is_lead(lead, p, sender, v.time_us):
        return
    alt, frame = (m.relative_alt, MavFrame.GLOBAL_RELATIVE_ALT) if over_home else (m.alt, MavFrame.GLOBAL)
    local = local_position(ap, m.lat, m.lon, alt * 1e-3, frame)
    if local.is_known:
        vel = m.vel * 0.01
        take(
            lead,
            p,
            sender,
            Report(local.pos, vel, ZERO, m.hdg <= HEADINGS, math.radians(m.hdg * 0.01), 0.0),
            v.time_us,
        )


@law
def follow_target(m: FollowTarget, v: Vehicle, sender: int) -> None:
    """FOLLOW_TARGET: what else it reports counts as its est_capabilities say."""
    ap = v.autopilot
    lead, p, has = ap.modes.follow, ap.params.FOLL, m.est_capabilities
    if (m.lat == 0 and m.lon == 0) or (has & HAS_POSITION) == 0 or not is_lead(lead, p, sender, v.time_us):
        return
    local = local_position(ap, m.lat, m.lon, m.alt, MavFrame.GLOBAL)
    vel = vector(m.vel) if (has & HAS_VELOCITY) != 0 else ZERO
    acc = vector(m.acc) if (has & HAS_ACCELERATION) != 0 else ZERO
    body = rotation(m.attitude_q)
    has_heading = (has & HAS_ATTITUDE) != 0 and body.is_given
    turn = rotate(body.q, vector(m.rates)).z if has_heading else 0.0
    if not local.is_known or not finite(vel.x + vel.y + vel.z + acc.x + acc.y + acc.z + turn):
        return
    take(lead, p, sender, Report(local.pos, vel, acc, has_heading, yaw_of(body.q), turn), v.time_us)
    lead.sends_more = True


@law
def vector(numbers: Floats) -> Vec3:
    """Three numbers of a message."""
    return Vec3(float(numbers[0]), float(numbers[1]), float(numbers[2]))
