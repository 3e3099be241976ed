# SPDX-License-Identifier: BSD-3-Clause
"""What lidar and range-finder measure in a world that only the physics side has.

DISTANCE_SENSOR and OBSTACLE_DISTANCE, in whole centimetres, are for any autopilot. Ours takes the readings as they are:
DEBUG_FLOAT_ARRAY "LASER", the whole scan in parts of 58, and DEBUG_VECT "RANGE", whose x is the range-finder's [m].
"""

from __future__ import annotations

import math
from typing import Any

import numpy as np

from ...core.record_reader import RecordReader
from ...physics.native.ranging import show_lidar
from ..dialect import message
from ..telemetry.plain import build
from ..telemetry.ranging import FACING_DOWN, PART, SCAN_NAME, distance_sensor, obstacle_distance, scan
from ..wire.port import Port
from .protocol import LATEST_US, RefusedError

SCAN, VECTOR = message("DEBUG_FLOAT_ARRAY"), message("DEBUG_VECT")
DISTANCE, OBSTACLES = message("DISTANCE_SENSOR"), message("OBSTACLE_DISTANCE")
RANGE = "RANGE"
_HEAD = 20
"""Bytes before the numbers of a DEBUG_FLOAT_ARRAY."""
_SIZE = _HEAD + 4 * PART

Part = tuple[int, int, np.ndarray[Any, Any]]
"""Time of the scan [us], number of the part, its readings [m]."""


class ScanWriter:
    """The last scan of a lidar: (kind of message, payload)."""

    marks = ("sensors.lidar_count",)

    def __init__(self, v: Any) -> None:
        self._v = v
        self._port = Port()  # for the parts of the scan

    def messages(self) -> list[tuple[Any, bytes]]:
        """Nothing without a lidar or a world."""
        sectors = build(obstacle_distance, self._v, self._port)
        if not sectors:
            return []
        found = [(OBSTACLES, sectors), (SCAN, build(scan, self._v, self._port))]
        while self._port.part != 0:
            found.append((SCAN, build(scan, self._v, self._port)))
        return found


class RangeWriter:
    """The last reading of a range-finder."""

    marks = ("sensors.rangefinder_count",)

    def __init__(self, reader: RecordReader, v: Any) -> None:
        self._v = v
        self._port = Port()
        self._read = reader.fields("time_us", "sensors.rangefinder_range")

    def messages(self) -> list[tuple[Any, bytes]]:
        """Nothing without a range-finder or a world."""
        distance = build(distance_sensor, self._v, self._port)
        if not distance:
            return []
        t, reading = self._read()
        return [(DISTANCE, distance), (VECTOR, VECTOR.pack(t, reading, 0.0, 0.0, RANGE.encode()))]


class ScanReader:
    """From the parts of a scan into a record.

    Args:
        v: view of the record.
        samples: readings of a whole scan: of this airframe's lidar.
    """

    def __init__(self, v: Any, samples: int) -> None:
        self._sensors, self._samples, self._properties = v.sensors, samples, v.physics.airframe
        self._readings = np.empty(samples, np.float32)
        self._parts = -(-samples // PART)
        self._time_us, self._next = -1, 0

    def read(self, payload: bytes) -> Part | None:
        """A part of a scan, checked; None when the message is about something else.

        Raises:
            RefusedError: readings below 0 or not a number, or a scan of more or fewer readings than this lidar's.
        """
        payload = payload.ljust(_SIZE, b"\0")
        if payload[10:_HEAD].rstrip(b"\0") != SCAN_NAME:
            return None
        t, k = int.from_bytes(payload[:8], "little"), int.from_bytes(payload[8:10], "little")
        readings = np.frombuffer(payload, "<f4", PART, _HEAD)
        wanted = min(self._samples - k * PART, PART)
        if wanted <= 0 or not np.isnan(readings[wanted:]).all():
            raise RefusedError(f"{SCAN.name}: a scan of another lidar: this airframe's has {self._samples} readings")
        if not (readings[:wanted] >= 0.0).all() or t >= LATEST_US:
            raise RefusedError(f"{SCAN.name}: readings below 0 or not a number, or time_usec {t}")
        return t, k, readings[:wanted]

    def write(self, part: Part) -> None:
        """Take a part; the last one of a scan puts the scan into the record."""
        t, k, readings = part
        if k == 0:
            self._time_us, self._next = t, 0
        if t != self._time_us or k != self._next:
            return
        self._readings[k * PART : k * PART + len(readings)] = readings
        self._next += 1
        if self._next == self._parts:
            s = self._sensors
            s.lidar_ranges[: self._samples] = self._readings
            s.lidar_time_us = t
            s.lidar_count += 1
            show_lidar(s, self._properties)


class RangeReader:
    """From DEBUG_VECT "RANGE" into a record."""

    def __init__(self, v: Any) -> None:
        self._sensors = v.sensors

    @staticmethod
    def read(payload: bytes) -> float | None:
        """The reading [m], inf beyond the range; None when the message is about something else.

        Raises:
            RefusedError: below 0 or not a number.
        """
        fields = VECTOR.decode(payload)
        if fields.name != RANGE.encode():
            return None
        if not fields.x >= 0.0:
            raise RefusedError(f"{VECTOR.name} {RANGE}: x = {fields.x}")
        return float(fields.x)

    def write(self, reading: float) -> None:
        """Put the reading [m], which is that of the DISTANCE_SENSOR before it, into the record."""
        self._sensors.rangefinder_range[0] = reading


class DistanceReader:
    """From DISTANCE_SENSOR into a record, in whole centimetres."""

    def __init__(self, v: Any) -> None:
        self._sensors = v.sensors

    @staticmethod
    def read(payload: bytes) -> float | None:
        """The reading [m], inf beyond the range; None when it does not look down."""
        fields = DISTANCE.decode(payload)
        if fields.orientation != FACING_DOWN:
            return None
        return math.inf if fields.current_distance > fields.max_distance else 0.01 * fields.current_distance

    def write(self, reading: float) -> None:
        """Put a reading [m] into the record."""
        self._sensors.rangefinder_range[0] = reading
        self._sensors.rangefinder_count += 1
