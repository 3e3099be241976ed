# SPDX-License-Identifier: BSD-3-Clause
"""The truth as the shell shows it (SIMSTATE, comparisons): what no autopilot may read."""

from __future__ import annotations

from typing import Any, NamedTuple

from ...core.geodesy import add_offset
from ...core.rotations import quat_to_euler


class Truth(NamedTuple):
    """Where a simulated vehicle really is."""

    time_us: int
    lat: float
    """[deg]"""
    lon: float
    """[deg]"""
    alt: float
    """Above mean sea level [m]."""
    pos: tuple[float, float, float]
    """NED from the home ground point [m]."""
    vel: tuple[float, float, float]
    """NED [m/s]."""
    euler: tuple[float, float, float]
    """Roll, pitch, yaw [rad]."""
    rates: tuple[float, float, float]
    """Body rates [rad/s]."""
    specific_force: tuple[float, float, float]
    """What a perfect accelerometer shows, body frame [m/s^2]."""
    on_ground: bool


def _three(values: Any) -> tuple[float, float, float]:
    return (float(values[0]), float(values[1]), float(values[2]))


def read(v: Any) -> Truth:
    """The truth of a vehicle (a view of its record) at its present time."""
    p = v.physics
    b = p.body
    lat, lon = add_offset(float(p.place.lat), float(p.place.lon), float(b.pos[0]), float(b.pos[1]))
    w, x, y, z = (float(c) for c in b.q)
    return Truth(
        int(v.time_us),
        lat * 1e-7,
        lon * 1e-7,
        float(p.place.alt) - float(b.pos[2]),
        _three(b.pos),
        _three(b.vel),
        quat_to_euler(w, x, y, z),
        _three(b.rates),
        _three(b.specific_force),
        not hasattr(p, "ground") or int(p.ground.state) != 0,  # a rover never leaves it
    )
