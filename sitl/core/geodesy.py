# SPDX-License-Identifier: BSD-3-Clause
"""Latitude and longitude to metres and back, on the flat earth around a point that ArduPilot uses.

Longitude is scaled by the cosine of the mean latitude of the two points; 1e-7 degree of latitude is
0.011131884502145034 m (ArduPilot's LOCATION_SCALING_FACTOR, a radius of 6378100 m; WGS-84's is 6378137 m).
"""

from __future__ import annotations

import math
from typing import NamedTuple

from .elementary import cos
from .kernels import law
from .scalars import sign
from .vectors import Vec2

METRES_PER_DEGE7 = 0.011131884502145034
_POLE = 900000000.0
_RAD_PER_DEGE7 = math.pi / 180.0 * 1e-7


class Location(NamedTuple):
    """A point on the globe."""

    lat: float  # [degE7]
    lon: float  # [degE7]


@law
def longitude_scale(lat_e7: float) -> float:
    """Cosine of a latitude [degE7], at least 0.01."""
    return max(cos(lat_e7 * _RAD_PER_DEGE7), 0.01)


@law
def wrap_longitude(lon_e7: float) -> float:
    """Longitude [degE7] wrapped to +-180 degrees."""
    if lon_e7 > 1800000000:
        return lon_e7 - 3600000000
    if lon_e7 < -1800000000:
        return lon_e7 + 3600000000
    return lon_e7


@law
def offset_ne(lat0_e7: float, lon0_e7: float, lat_e7: float, lon_e7: float) -> Vec2:
    """North and east [m] from point 0 to the other, both [degE7] as int or float."""
    dlat = lat_e7 - lat0_e7
    dlon = wrap_longitude(lon_e7 - lon0_e7)
    return Vec2(dlat * METRES_PER_DEGE7, dlon * METRES_PER_DEGE7 * longitude_scale(0.5 * (lat0_e7 + lat_e7)))


@law
def add_offset(lat0_e7: float, lon0_e7: float, north: float, east: float) -> Location:
    """The point (north, east) [m] away from point 0; beyond a pole it is as far on this side, as ArduPilot has it."""
    lat = lat0_e7 + north / METRES_PER_DEGE7
    lon = lon0_e7 + east / (METRES_PER_DEGE7 * longitude_scale(0.5 * (lat0_e7 + lat)))
    if abs(lat) > _POLE:
        lat = (2.0 * _POLE - abs(lat)) * sign(lat)
    return Location(lat, wrap_longitude(lon))


def location_e7(lat0_e7: float, lon0_e7: float, north: float, east: float) -> tuple[int, int]:
    """``add_offset`` in whole degE7 (shell side)."""
    location = add_offset(lat0_e7, lon0_e7, north, east)
    return round(location.lat), round(location.lon)
