# SPDX-License-Identifier: BSD-3-Clause
"""What is measured every tick or at a rate of its own: HIL_SENSOR, BATTERY_STATUS, WHEEL_DISTANCE.

HIL_SENSOR: IMU, magnetometer and barometer, one a tick; it also carries the clock.

The record's float32 values go over the wire as they are. ``fields_updated`` says which samples are new.

BATTERY_STATUS: voltage [mV] and current [10 mA] at the power module.

One cell stands for the whole battery up to 65.534 V; more is spread over several.
"""

from __future__ import annotations

import math
import struct
from collections.abc import Callable
from typing import Any

import numpy as np

from ...core.constants import TICK_US
from ...core.elementary import pow
from ...core.kernels import law
from ...core.record_reader import RecordReader, locate
from ..dialect import message
from .protocol import BARO_UPDATED, IMU_UPDATED, LATEST_US, MAG_UPDATED, RefusedError, culprit, within

SENSOR_KIND = message("HIL_SENSOR")
SENSOR_S = "sensors."
COUNTS = 56
"""Of the samples of magnetometer and barometer: bytes behind ``sensors.time_us``."""
_SENSOR_LIMITS = (*(5e3,) * 3, *(500.0,) * 3, *(100.0,) * 3, 2e3, 2e3, 1e5, 300.0)
"""Sizes beyond which a sensor's value is absurd [m/s^2, rad/s, gauss, hPa, hPa, m, degC]."""
DITHER_MAG, DITHER_BARO = 1e-5, 1e-3
"""What every second sample shows more [gauss], [hPa]: little of the earth's field, a centimetre."""

Sent = tuple[int, int, float]
"""Samples of magnetometer and barometer that were reported last, and the height by the latter [m]."""
Values = tuple[Any, ...]
"""Fields in wire order."""


@law
def pressure_altitude(pressure: float) -> float:
    """Height [m] in the standard atmosphere of a static pressure [hPa]."""
    return float(44330.77 * (1.0 - pow(max(pressure, 0.0) / 1013.25, 0.1902632)))


class SensorWriter:
    """From a record to payloads."""

    def __init__(self, reader: RecordReader) -> None:
        names = ("time_us", "acc", "gyro", "mag", "abs_pressure", "temperature", "mag_count", "baro_count")
        self._read = reader.fields(*(SENSOR_S + name for name in names))
        self.sent: Sent = (0, 0, 0.0)
        self.is_dithered = False
        """PX4 holds a sensor that shows the same 100 times for failed: one without noise then changes by a little."""

    def payload(self, is_all: bool = False) -> bytes:
        """The samples of this tick; ``is_all``: all count as new."""
        t, ax, ay, az, gx, gy, gz, mx, my, mz, pressure, temperature, mag, baro = self._read()
        updated = IMU_UPDATED
        mag_before, baro_before, altitude = self.sent
        if self.is_dithered:
            mx += DITHER_MAG * (mag & 1)
            pressure += DITHER_BARO * (baro & 1)
        if mag != mag_before or is_all:
            updated |= MAG_UPDATED
        if baro != baro_before or is_all:
            altitude = pressure_altitude(pressure)
            updated |= BARO_UPDATED
        self.sent = mag, baro, altitude
        return SENSOR_KIND.pack(t, ax, ay, az, gx, gy, gz, mx, my, mz, pressure, 0.0, altitude, temperature, updated, 0)


class SensorReader:
    """From payloads into a record, clock and tick counter with them."""

    def __init__(self, fleet: np.ndarray[Any, Any], index: int) -> None:
        dtype, start = fleet.dtype, index * fleet.dtype.itemsize
        clock, first = locate(dtype, "time_us")[0], locate(dtype, SENSOR_S + "time_us")[0]
        if locate(dtype, "tick")[0] != clock + 8 or locate(dtype, SENSOR_S + "mag_count")[0] != first + COUNTS:
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
        values: Values = SENSOR_KIND.unpack_from(payload.ljust(SENSOR_KIND.size, b"\0"))
        if not within(values[1:14], _SENSOR_LIMITS):
            raise culprit(SENSOR_KIND.name, SENSOR_KIND.fields[1:14], values[1:14], _SENSOR_LIMITS)
        if values[0] >= LATEST_US:
            raise RefusedError(f"{SENSOR_KIND.name}.time_usec = {values[0]}")
        return values


BATTERY_KIND = message("BATTERY_STATUS")
VOLTS, AMPERES = "sensors.battery_voltage", "sensors.battery_current"
CELLS, MORE_CELLS = 10, 4
_UNKNOWN, _MOST, _UNKNOWN_TEMPERATURE = 65535, 65534, 32767
_FIRST = BATTERY_KIND.fields.index("voltages")


def spread(millivolts: int) -> list[int]:
    """Cells whose sum is the voltage; those that are not needed are unknown."""
    whole, rest = divmod(min(max(millivolts, 0), CELLS * _MOST), _MOST)
    cells = [_MOST] * whole + ([rest] if rest or not whole else [])
    return cells + [_UNKNOWN] * (CELLS - len(cells))


class BatteryWriter:
    """From a record to payloads."""

    marks = (VOLTS, AMPERES)

    def __init__(self, reader: RecordReader) -> None:
        self._read = reader.fields(VOLTS, AMPERES)

    def payloads(self) -> list[bytes]:
        """The last sample."""
        volts, amperes = self._read()
        cells = spread(math.floor(1000.0 * volts + 0.5))
        current = min(max(math.floor(100.0 * amperes + 0.5), 0), 32767)
        return [
            BATTERY_KIND.pack(
                -1, -1, _UNKNOWN_TEMPERATURE, *cells, current, 0, 0, 0, -1, 0, 0, *(0,) * MORE_CELLS, 0, 0
            )
        ]


class BatteryReader:
    """From payloads into a record."""

    def __init__(self, v: Any) -> None:
        self._sensors = v.sensors

    @staticmethod
    def read(payload: bytes) -> tuple[int, int]:
        """Voltage [mV], current [10 mA] (0 when it is not measured).

        Raises:
            RefusedError: no cell has a voltage.
        """
        values = BATTERY_KIND.unpack_from(payload.ljust(BATTERY_KIND.size, b"\0"))
        cells = [cell for cell in values[_FIRST : _FIRST + CELLS] if cell != _UNKNOWN]
        if not cells:
            raise RefusedError(f"{BATTERY_KIND.name} has no voltage")
        more = BATTERY_KIND.fields.index("voltages_ext") + CELLS - 1
        return sum(cells) + sum(values[more : more + MORE_CELLS]), max(values[_FIRST + CELLS], 0)

    def write(self, values: tuple[int, int]) -> None:
        """Put a sample into the record, by the same products as ``physics.native.sensors.power``."""
        self._sensors.battery_voltage = 0.001 * values[0]
        self._sensors.battery_current = 0.01 * values[1]


WHEELS_KIND = message("WHEEL_DISTANCE")
WHEELS_S = "sensors.wheel_"
WHEELS, SLOTS = 2, 16
_WHEELS_LIMITS = (1e9,) * WHEELS
_NAMES = ("distance[0]", "distance[1]")


class WheelWriter:
    """From a record to payloads."""

    marks = (WHEELS_S + "count",)

    def __init__(self, reader: RecordReader) -> None:
        self._read = reader.fields("time_us", WHEELS_S + "count", WHEELS_S + "distance")

    def payloads(self) -> list[bytes]:
        """The last sample, at the present time; nothing without encoders."""
        t, count, left, right = self._read()
        return [WHEELS_KIND.pack(t, left, right, *(0.0,) * (SLOTS - WHEELS), WHEELS)] if count else []


class WheelReader:
    """From payloads into a record."""

    def __init__(self, v: Any) -> None:
        self._sensors = v.sensors

    @staticmethod
    def read(payload: bytes) -> tuple[float, float]:
        """What both wheels, left and right, have rolled [m].

        Raises:
            RefusedError: not finite or absurd, or not of two wheels.
        """
        values = WHEELS_KIND.unpack_from(payload.ljust(WHEELS_KIND.size, b"\0"))
        if not within(values[1:3], _WHEELS_LIMITS):
            raise culprit(WHEELS_KIND.name, _NAMES, values[1:3], _WHEELS_LIMITS)
        if values[-1] < WHEELS or values[0] >= LATEST_US:
            raise RefusedError(f"{WHEELS_KIND.name}: count {values[-1]}, time_usec {values[0]}")
        return values[1], values[2]

    def write(self, values: tuple[float, float]) -> None:
        """Put a sample [m], left and right, into the record."""
        s = self._sensors
        s.wheel_distance = values
        s.wheel_count += 1
