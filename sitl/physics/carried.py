# SPDX-License-Identifier: BSD-3-Clause
"""The truth at the precision of HIL_STATE_QUATERNION (https://mavlink.io/en/messages/common.html#HIL_STATE_QUATERNION).

Everything that MAVLink tells of the truth is made of this, so that it is the same whether the physics runs in the
autopilot's process or behind a link.
"""

from __future__ import annotations

import math
import struct
from typing import Any, NamedTuple

from ..core.geodesy import add_offset

MILLIG = 9.80665e-3
"""[m/s^2]"""
_SINGLES = struct.Struct("<7f")


class Carried(NamedTuple):
    """Fields of HIL_STATE_QUATERNION but its time and air speeds, in its units."""

    attitude: tuple[float, float, float, float]
    """Body to NED, w x y z; float32 values."""
    rates: tuple[float, float, float]
    """Body [rad/s]; float32 values."""
    lat: int
    """[degE7]"""
    lon: int
    """[degE7]"""
    alt: int
    """Above mean sea level [mm]."""
    velocity: tuple[int, int, int]
    """NED [cm/s]."""
    acceleration: tuple[int, int, int]
    """What a perfect accelerometer shows, body [mG]."""


def _whole(value: float, low: int, high: int) -> int:
    return min(max(math.floor(value + 0.5), low), high) if math.isfinite(value) else 0


def carried(v: Any) -> Carried:
    """The truth of a vehicle (a view of its record) as the message carries it."""
    p = v.physics
    b, place = p.body, p.place
    pos, vel, force = b.pos, b.vel, b.specific_force
    singles = _SINGLES.unpack(_SINGLES.pack(*b.q, *b.rates))
    lat, lon = add_offset(place.lat, place.lon, pos.x, pos.y)
    vn, ve, vd = (_whole(100.0 * c, -32768, 32767) for c in vel)
    ax, ay, az = (_whole(c / MILLIG, -32768, 32767) for c in force)
    return Carried(
        singles[:4],
        singles[4:],
        _whole(lat, -(1 << 31), (1 << 31) - 1),
        _whole(lon, -(1 << 31), (1 << 31) - 1),
        _whole(1000.0 * (place.alt - pos.z), -(1 << 31), (1 << 31) - 1),
        (vn, ve, vd),
        (ax, ay, az),
    )
