# SPDX-License-Identifier: BSD-3-Clause
"""The truth as the shell shows it (SIMSTATE, comparisons): what no autopilot may read."""

from __future__ import annotations

from typing import Any, NamedTuple

from ...core.algebra import euler_of
from ...core.geodesy import add_offset
from ...core.vectors import Euler, Vec3
from .records import GROUND_AIRBORNE


class Truth(NamedTuple):
    """Where a simulated vehicle really is."""

    time_us: int
    lat: float
    """[deg]"""
    lon: float
    """[deg]"""
    alt: float
    """Above mean sea level [m]."""
    pos: Vec3
    """NED from the home ground point [m]."""
    vel: Vec3
    """NED [m/s]."""
    euler: Euler
    """[rad]"""
    rates: Vec3
    """Body rates [rad/s]."""
    specific_force: Vec3
    """What a perfect accelerometer shows, body frame [m/s^2]."""
    on_ground: bool


def read(v: Any) -> Truth:
    """The truth of a vehicle (a view of its record) at its present time."""
    p = v.physics
    b, origin = p.body, p.origin
    lat, lon = add_offset(origin.lat, origin.lon, b.pos.x, b.pos.y)
    on_ground = not hasattr(p, "ground") or p.ground.state != GROUND_AIRBORNE  # a rover never leaves it
    alt, euler = origin.alt - b.pos.z, euler_of(b.q)
    return Truth(v.time_us, lat * 1e-7, lon * 1e-7, alt, b.pos, b.vel, euler, b.rates, b.specific_force, on_ground)
