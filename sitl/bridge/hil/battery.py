# SPDX-License-Identifier: BSD-3-Clause
"""BATTERY_STATUS: voltage [mV] and current [10 mA] at the power module.

One cell stands for the whole battery up to 65.534 V; more is spread over several.
"""

from __future__ import annotations

import math
from typing import Any

from ...core.record_reader import RecordReader
from ..dialect import message
from .numbers import RefusedError

KIND = message("BATTERY_STATUS")
VOLTS, AMPERES = "sensors.battery_voltage", "sensors.battery_current"
CELLS, MORE_CELLS = 10, 4
_UNKNOWN, _MOST, _UNKNOWN_TEMPERATURE = 65535, 65534, 32767
_FIRST = KIND.fields.index("voltages")


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
        return [KIND.pack(-1, -1, _UNKNOWN_TEMPERATURE, *cells, current, 0, 0, 0, -1, 0, 0, *(0,) * MORE_CELLS, 0, 0)]


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
        values = KIND.unpack_from(payload.ljust(KIND.size, b"\0"))
        cells = [cell for cell in values[_FIRST : _FIRST + CELLS] if cell != _UNKNOWN]
        if not cells:
            raise RefusedError(f"{KIND.name} has no voltage")
        more = KIND.fields.index("voltages_ext") + CELLS - 1
        return sum(cells) + sum(values[more : more + MORE_CELLS]), max(values[_FIRST + CELLS], 0)

    def write(self, values: tuple[int, int]) -> None:
        """Put a sample into the record, by the same products as ``physics.native.sensors.power``."""
        self._sensors.battery_voltage = 0.001 * values[0]
        self._sensors.battery_current = 0.01 * values[1]
