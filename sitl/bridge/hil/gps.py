# SPDX-License-Identifier: BSD-3-Clause
"""HIL_GPS: the receiver's fix [degE7, mm, cm/s, HDOP and VDOP * 100].

A fix has the time at which the reader got it: the same time again is the same fix, with another state of the receiver
(switched off: fix type 0).
"""

from __future__ import annotations

import math
from typing import Any

from ...core.record_reader import RecordReader
from ..dialect import message
from ..telemetry.builder import DEG, int16, uint16
from .protocol import LATEST_US, RefusedError

KIND = message("HIL_GPS")
S = "sensors.gps_"
_MOST_FIX = 8
"""Greatest GPS_FIX_TYPE."""


class GpsWriter:
    """From a record to payloads."""

    marks = (S + "count", S + "fix")
    """Fields whose change means that there is something new."""

    def __init__(self, reader: RecordReader) -> None:
        names = ("count", "time_us", "fix", "lat", "lon", "alt", "eph", "epv", "vel", "satellites")
        self._read = reader.fields(*(S + name for name in names))

    def payloads(self) -> list[bytes]:
        """The last fix; nothing before the first."""
        count, t, fix, lat, lon, alt, eph, epv, vn, ve, vd, satellites = self._read()
        if count == 0:
            return []
        course = uint16(math.atan2(ve, vn) * DEG * 100.0 % 36000.0)
        speeds = uint16(math.hypot(vn, ve)), int16(vn), int16(ve), int16(vd), course
        return [KIND.pack(t, lat, lon, alt, uint16(eph), uint16(epv), *speeds, fix & 0xFF, satellites & 0xFF, 0, 0)]


class GpsReader:
    """From payloads into a record."""

    def __init__(self, v: Any) -> None:
        self._sensors = v.sensors

    @staticmethod
    def read(payload: bytes) -> tuple[Any, ...]:
        """The fields, checked.

        Raises:
            RefusedError: a place that is not on the globe, or an absurd time or fix.
        """
        values: tuple[Any, ...] = KIND.unpack_from(payload.ljust(KIND.size, b"\0"))
        t, lat, lon, fix = values[0], values[1], values[2], values[11]
        if not (abs(lat) <= 900_000_000 and abs(lon) <= 1_800_000_000):
            raise RefusedError(f"{KIND.name}: latitude {lat}, longitude {lon} degE7 is not on the globe")
        if t >= LATEST_US or fix > _MOST_FIX:
            raise RefusedError(f"{KIND.name}: time_usec {t}, fix_type {fix}")
        return values

    def write(self, values: tuple[Any, ...]) -> None:
        """Put checked fields into the record."""
        t, lat, lon, alt, eph, epv, _, vn, ve, vd, _, fix, satellites, _, _ = values
        s = self._sensors
        if t != s.gps_time_us:
            s.gps_count += 1
            s.gps_time_us = t
        s.gps_fix, s.gps_lat, s.gps_lon, s.gps_alt = fix, lat, lon, alt
        s.gps_eph, s.gps_epv, s.gps_satellites = eph, epv, satellites
        s.gps_vel = (vn, ve, vd)
