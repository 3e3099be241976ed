# SPDX-License-Identifier: BSD-3-Clause
"""A beacon on the ground, and the sensor of the vehicle that sees it (SIM_PLD_*)."""

from __future__ import annotations

from ..autopilot.events import emit
from ..autopilot.landing_target.measurement import take
from ..autopilot.landing_target.orientation import axis
from ..autopilot.landing_target.state import BODY, LANDING_TARGET_DID, REPORTED_BEACON, SAID_NO_BEACON
from ..autopilot.params.simulation import LandingBeacon
from ..core.algebra import dot, norm, rotate_inverse, with_down
from ..core.geodesy import offset_ne
from ..core.kernels import law
from ..core.vectors import Vec3
from ..physics.native.records import Origin
from .record import Vehicle

BY_MESSAGE, WITHOUT_DISTANCE, WITH_DISTANCE = 1, 2, 4
"""PLND_TYPE."""
CYLINDER, CONE = 0, 1
"""SIM_PLD_TYPE."""
LEAST = 0.01
"""The sensor sees it from so far in front of it on [m]."""


@law
def position_of(p: LandingBeacon, origin: Origin) -> Vec3:
    """The beacon, NED from where the vehicle was powered on [m]."""
    return with_down(offset_ne(origin.lat, origin.lon, p.LAT * 1e7, p.LON * 1e7), -p.HEIGHT)


@law
def is_seen(p: LandingBeacon, there: Vec3) -> bool:
    """Whether it is seen from ``there``, NED from it [m]."""
    shines = axis(int(p.ORIENT))
    along = dot(there, shines)
    if along < LEAST:
        return False
    if p.TYPE != CYLINDER and p.TYPE != CONE:
        return norm(there) <= p.DIST_LMT
    aside = norm(there - along * shines)
    widest = p.DIST_LMT * along / p.ALT_LMT if p.TYPE == CONE and p.ALT_LMT > 0.0 else p.DIST_LMT
    return along <= p.ALT_LMT and aside <= widest


@law
def look(v: Vehicle) -> None:
    """One tick of a vehicle with PLND_ENABLED."""
    ap, p = v.autopilot, v.autopilot.params.SIM.PLD
    t, kind = ap.landing_target, int(ap.params.PLND.TYPE)
    if kind == BY_MESSAGE:
        t.sees = True
        return
    if p.ENABLE == 0.0 or (kind != WITHOUT_DISTANCE and kind != WITH_DISTANCE):
        return
    if p.LAT == 0.0 and p.LON == 0.0 and p.HEIGHT == 0.0:
        if (t.reported & REPORTED_BEACON) == 0:
            emit(ap.events, v.time_us, LANDING_TARGET_DID, float(SAID_NO_BEACON), 0.0)
        t.reported |= REPORTED_BEACON
        return
    if v.time_us - t.line_us < 1e6 / max(p.RATE, 1.0):
        return
    there = v.physics.body.pos - position_of(p, v.physics.origin)
    t.sees = is_seen(p, there)
    if t.sees:
        has_distance = kind == WITH_DISTANCE and (int(p.OPTIONS) & 1) != 0
        line = rotate_inverse(v.physics.body.q, -1.0 * there)
        take(t, line, BODY, norm(there) if has_distance else 0.0, v.time_us)
