# SPDX-License-Identifier: BSD-3-Clause
"""HIL_SENSOR: IMU, magnetometer and barometer, one a tick; it also carries the clock.

The record's float32 values go over the wire as they are. ``fields_updated`` says which samples are new.
"""

from __future__ import annotations

import struct
from collections.abc import Callable
from typing import Any

import numpy as np

from ...core.constants import TICK_US
from ...core.record_reader import RecordReader, locate
from ..dialect import message
from .numbers import (
    BARO_UPDATED,
    IMU_UPDATED,
    LATEST_US,
    MAG_UPDATED,
    RefusedError,
    culprit,
    within,
)

KIND = message("HIL_SENSOR")
S = "sensors."
COUNTS = 56
"""Of the samples of magnetometer and barometer: bytes behind ``sensors.time_us``."""
_LIMITS = (*(5e3,) * 3, *(500.0,) * 3, *(100.0,) * 3, 2e3, 2e3, 1e5, 300.0)
"""Sizes beyond which a sensor's value is absurd [m/s^2, rad/s, gauss, hPa, hPa, m, degC]."""

Values = tuple[Any, ...]
"""Fields in wire order."""


def pressure_altitude(pressure: float) -> float:
    """Height [m] in the standard atmosphere of a static pressure [hPa]."""
    return float(44330.77 * (1.0 - (max(pressure, 0.0) / 1013.25) ** 0.1902632))


class SensorWriter:
    """From a record to payloads."""

    def __init__(self, reader: RecordReader) -> None:
        names = ("time_us", "acc", "gyro", "mag", "abs_pressure", "temperature", "mag_count", "baro_count")
        self._read = reader.fields(*(S + name for name in names))
        self._mag = self._baro = 0
        self._altitude = 0.0

    def payload(self, is_all: bool = False) -> bytes:
        """The samples of this tick; ``is_all``: all count as new."""
        t, ax, ay, az, gx, gy, gz, mx, my, mz, pressure, temperature, mag, baro = self._read()
        updated = IMU_UPDATED
        if mag != self._mag or is_all:
            self._mag = mag
            updated |= MAG_UPDATED
        if baro != self._baro or is_all:
            self._baro = baro
            self._altitude = pressure_altitude(pressure)
            updated |= BARO_UPDATED
        return KIND.pack(t, ax, ay, az, gx, gy, gz, mx, my, mz, pressure, 0.0, self._altitude, temperature, updated, 0)


class SensorReader:
    """From payloads into a record, clock and tick counter with them."""

    def __init__(self, fleet: np.ndarray[Any, Any], index: int) -> None:
        dtype, start = fleet.dtype, index * fleet.dtype.itemsize
        clock, first = locate(dtype, "time_us")[0], locate(dtype, S + "time_us")[0]
        if locate(dtype, "tick")[0] != clock + 8 or locate(dtype, S + "mag_count")[0] != first + COUNTS:
            raise TypeError("HIL_SENSOR is written in one piece: the record's fields have been moved")
        memory = fleet.view("u1").data
        clock, first = start + clock, start + first
        write_clock, write = struct.Struct("<qq").pack_into, struct.Struct("<q11f4xqq").pack_into
        counts = struct.Struct("<qq").unpack_from

        def store(values: Values, is_all: bool) -> None:
            t, *body, _, _, temperature, updated, _ = values
            mag, baro = counts(memory, first + COUNTS)
            if updated & MAG_UPDATED or is_all:
                mag += 1
            if updated & BARO_UPDATED or is_all:
                baro += 1
            write_clock(memory, clock, t, t // TICK_US)
            write(memory, first, t, *body, temperature, mag, baro)

        self.write: Callable[[Values, bool], None] = store
        """Put checked values into the record; the flag says that all samples are new to the reader."""

    @staticmethod
    def read(payload: bytes) -> Values:
        """The fields, checked.

        Raises:
            RefusedError: one of them is not finite or absurd.
        """
        values: Values = KIND.unpack_from(payload.ljust(KIND.size, b"\0"))
        if not within(values[1:14], _LIMITS):
            raise culprit(KIND.name, KIND.fields[1:14], values[1:14], _LIMITS)
        if values[0] >= LATEST_US:
            raise RefusedError(f"{KIND.name}.time_usec = {values[0]}")
        return values
