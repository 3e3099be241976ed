# SPDX-License-Identifier: BSD-3-Clause
"""Places on the globe to NED metres from the estimator's origin."""

from __future__ import annotations

import math

from ..core.geodesy import offset_ne
from ..core.record_reader import RecordReader
from .autopilot_api import Vector
from .services.command import FRAMES_AMSL

_ORIGIN, _HOME = "autopilot.estimate.origin_", "autopilot.home."


class Places:
    """Reads origin and home from the record whenever it is asked."""

    def __init__(self, reader: RecordReader) -> None:
        self._origin = reader.fields(*(_ORIGIN + x for x in ("set", "lat", "lon", "alt")))
        self._heights = reader.fields(_HOME + "is_set", _HOME + "alt", _ORIGIN + "alt")

    def home_alt(self) -> float:
        """Altitude [m above sea level] that relative heights count from: of home, else of the origin."""
        is_set, alt, origin_alt = self._heights()
        return float(alt if is_set else origin_alt)

    def ned(self, lat: int, lon: int, z: float, frame: int) -> Vector | None:
        """NED [m] of a place [degE7, m in a MAV_FRAME]; None before there is an origin or off the globe.

        Terrain frames count from home: the ground is flat.
        """
        is_set, lat0, lon0, _ = self._origin()
        if not is_set or not (abs(lat) <= 900_000_000 and abs(lon) <= 1_800_000_000 and math.isfinite(z)):
            return None
        n, e = offset_ne(lat0, lon0, lat, lon)
        return self.over_origin(n, e, z if frame in FRAMES_AMSL else self.home_alt() + z)

    def over_origin(self, north: float, east: float, alt: float) -> Vector | None:
        """NED [m] of a point at ``alt`` [m above sea level]; None before there is an origin."""
        is_set, _, _, origin_alt = self._origin()
        return (north, east, origin_alt - alt) if is_set else None
