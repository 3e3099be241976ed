# SPDX-License-Identifier: BSD-3-Clause
"""The truth at the precision of HIL_STATE_QUATERNION (https://mavlink.io/en/messages/common.html#HIL_STATE_QUATERNION).

Everything that MAVLink reports of the truth is made of this, so that it is the same whether the physics runs in the
autopilot's process or behind a link.
"""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np

from ..core.geodesy import add_offset
from ..core.kernels import law
from ..core.scalars import finite
from .native.records import Physics, Vehicle

MILLIG = 9.80665e-3
"""[m/s^2]"""


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


@law
def _single(value: float) -> float:
    """A number at float32 precision."""
    return float(np.float32(value))


@law
def _whole(value: float, low: int, high: int) -> int:
    """Rounded and limited; 0 for what is not finite."""
    if not finite(value):
        return 0
    if value >= high:
        return high
    return math.floor(value + 0.5) if value > low else low


@law
def _short(value: float) -> int:
    return _whole(value, -32768, 32767)


@law
def _long(value: float) -> int:
    return _whole(value, -2147483648, 2147483647)


@law
def carried(v: Vehicle[Physics]) -> Carried:
    """The truth of a vehicle as the message carries it."""
    b, origin = v.physics.body, v.physics.origin
    q, rates, pos, vel, force = b.q, b.rates, b.pos, b.vel, b.specific_force
    at = add_offset(origin.lat, origin.lon, pos.x, pos.y)
    return Carried(
        (_single(q.w), _single(q.x), _single(q.y), _single(q.z)),
        (_single(rates.x), _single(rates.y), _single(rates.z)),
        _long(at.lat),
        _long(at.lon),
        _long(1000.0 * (origin.alt - pos.z)),
        (_short(100.0 * vel.x), _short(100.0 * vel.y), _short(100.0 * vel.z)),
        (_short(force.x / MILLIG), _short(force.y / MILLIG), _short(force.z / MILLIG)),
    )
