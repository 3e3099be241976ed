# SPDX-License-Identifier: BSD-3-Clause
"""Locations on the globe to NED metres from the estimator's origin."""

from __future__ import annotations

from collections.abc import Callable
from typing import NamedTuple

from ..autopilot.state import Autopilot, Estimate
from ..core.algebra import ZERO
from ..core.geodesy import offset_ne
from ..core.kernels import law
from ..core.mavlink import MavFrame
from ..core.scalars import finite
from ..core.vectors import Vec3
from .autopilot_api import Vector

FRAMES_AMSL = (MavFrame.GLOBAL, MavFrame.GLOBAL_INT)
FRAMES_RELATIVE = (MavFrame.GLOBAL_RELATIVE_ALT, MavFrame.GLOBAL_RELATIVE_ALT_INT)
FRAMES_TERRAIN = (MavFrame.GLOBAL_TERRAIN_ALT, MavFrame.GLOBAL_TERRAIN_ALT_INT)
GLOBAL_FRAMES = FRAMES_AMSL + FRAMES_RELATIVE + FRAMES_TERRAIN
"""MAV_FRAME numbers with latitude and longitude."""

LAT_MAX, LON_MAX = 900_000_000, 1_800_000_000
"""[degE7]"""


class LocalPosition(NamedTuple):
    """A location on the globe, as the autopilot sees it."""

    is_known: bool  # False before there is an origin, and for what is not on the globe
    pos: Vec3  # NED from the origin [m]


@law
def home_alt(ap: Autopilot) -> float:
    """Altitude [m above sea level] that relative heights count from: of home, else of the origin."""
    return ap.home.alt if ap.home.is_set else ap.estimate.origin_alt


@law
def local_position(ap: Autopilot, lat: int, lon: int, z: float, frame: int) -> LocalPosition:
    """NED of a location [degE7, m in a MAV_FRAME]; terrain frames as where the ground is flat."""
    estimate = ap.estimate
    if not (estimate.origin_set and abs(lat) <= LAT_MAX and abs(lon) <= LON_MAX and finite(z)):
        return LocalPosition(False, ZERO)
    ne = offset_ne(estimate.origin_lat, estimate.origin_lon, lat, lon)
    alt = z if frame in FRAMES_AMSL else home_alt(ap) + z
    return over_origin(estimate, ne.x, ne.y, alt)


@law
def over_origin(estimate: Estimate, north: float, east: float, alt: float) -> LocalPosition:
    """NED of a point at ``alt`` [m above sea level], ``north`` and ``east`` [m] of the origin."""
    return LocalPosition(estimate.origin_set, Vec3(north, east, estimate.origin_alt - alt))


class Locations:
    """The same for services: reads origin and home from the record whenever it is asked."""

    def __init__(self, autopilot: Autopilot, ground: Callable[[int, int], float | None]) -> None:
        """``ground``: how much higher it is at a latitude and longitude [degE7] than at home [m]; None: not known."""
        self._autopilot, self._ground = autopilot, ground

    def home_alt(self) -> float:
        """Altitude [m above sea level] that relative heights count from: of home, else of the origin."""
        return home_alt(self._autopilot)

    def ned(self, lat: int, lon: int, z: float, frame: int) -> Vector | None:
        """NED [m] of a location [degE7, m in a MAV_FRAME]; None before there is an origin, off the globe, and above
        ground whose height is not known."""
        rise = self._ground(lat, lon) if frame in FRAMES_TERRAIN else 0.0
        return None if rise is None else _vector(local_position(self._autopilot, lat, lon, z + rise, frame))

    def alt(self, lat: int, lon: int, z: float, frame: int) -> float | None:
        """Altitude [m above sea level] of a location [degE7, m in a MAV_FRAME]; None above ground whose height is not
        known."""
        if frame in FRAMES_AMSL:
            return z
        rise = self._ground(lat, lon) if frame in FRAMES_TERRAIN else 0.0
        return None if rise is None else self.home_alt() + rise + z

    def over_origin(self, north: float, east: float, alt: float) -> Vector | None:
        """NED [m] of a point at ``alt`` [m above sea level]; None before there is an origin."""
        return _vector(over_origin(self._autopilot.estimate, north, east, alt))


def _vector(position: LocalPosition) -> Vector | None:
    pos = position.pos
    return (pos.x, pos.y, pos.z) if position.is_known else None
