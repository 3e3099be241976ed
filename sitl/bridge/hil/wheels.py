# SPDX-License-Identifier: BSD-3-Clause
"""WHEEL_DISTANCE: rolled by the left and right driven wheel [m], of a vehicle with encoders."""

from __future__ import annotations

from typing import Any

from ...core.record_reader import RecordReader
from ..dialect import message
from .numbers import LATEST_US, RefusedError, culprit, within

KIND = message("WHEEL_DISTANCE")
S = "sensors.wheel_"
WHEELS, PLACES = 2, 16
_LIMITS = (1e9,) * WHEELS
_NAMES = ("distance[0]", "distance[1]")


class WheelWriter:
    """From a record to payloads."""

    marks = (S + "count",)

    def __init__(self, reader: RecordReader) -> None:
        self._read = reader.fields("time_us", S + "count", S + "distance")

    def payloads(self) -> list[bytes]:
        """The last sample, at the present time; nothing without encoders."""
        t, count, left, right = self._read()
        return [KIND.pack(t, left, right, *(0.0,) * (PLACES - WHEELS), WHEELS)] if count else []


class WheelReader:
    """From payloads into a record."""

    def __init__(self, v: Any) -> None:
        self._sensors = v.sensors

    @staticmethod
    def read(payload: bytes) -> tuple[float, float]:
        """What both wheels have rolled.

        Raises:
            RefusedError: not finite or absurd, or not of two wheels.
        """
        values = KIND.unpack_from(payload.ljust(KIND.size, b"\0"))
        if not within(values[1:3], _LIMITS):
            raise culprit(KIND.name, _NAMES, values[1:3], _LIMITS)
        if values[-1] < WHEELS or values[0] >= LATEST_US:
            raise RefusedError(f"{KIND.name}: count {values[-1]}, time_usec {values[0]}")
        return values[1], values[2]

    def write(self, values: tuple[float, float]) -> None:
        """Put a sample into the record."""
        s = self._sensors
        s.wheel_distance = values
        s.wheel_count += 1
