# SPDX-License-Identifier: BSD-3-Clause
"""What the airframes of copters and rovers take over from a log alike."""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping

from ..autopilot.params.table import Table
from .estimate import Estimate
from .log_streams import FlightLog

NOISES = (
    "gyro_noise_density",
    "acc_noise_density",
    "baro_noise",
    "mag_noise",
    "gps_noise_horizontal",
    "gps_noise_vertical",
    "gps_velocity_noise_vertical",
)
"""Properties of logs that are properties of airframes."""
_CELL = 4.2
"""Voltage of a full cell."""
_OVERCHARGE = 0.02
"""Part of a cell by which a full battery may seem to have one more: chargers and voltmeters err."""


def battery(log: FlightLog, voltage: Estimate, resistance: Estimate, has_current: bool) -> dict[str, float]:
    """A battery that sags, where the log's did; its capacity is BATT_CAPACITY.

    Args:
        log: of the vehicle.
        voltage: at which it has so many cells.
        resistance: inner.
        has_current: whether the current is known.
    """
    if not voltage.is_observed:
        return {}
    found = {"battery_voltage_full": _CELL * math.ceil(voltage.value / _CELL - _OVERCHARGE)}
    capacity = 1e-3 * log.parameter("BATT_CAPACITY", default=0.0)
    if resistance.is_observed and has_current and capacity > 0.0:
        found |= {"battery_resistance": resistance.value, "battery_capacity": capacity}
    return found


def kept(parameters: Mapping[str, float], beginnings: tuple[str, ...], table: Table) -> dict[str, float]:
    """Parameters with these beginnings that our firmware has, takes and heeds, and that are not its defaults."""
    known = {name: value for name, value in parameters.items() if name.startswith(beginnings)}
    known = {name: value for name, value in known.items() if name in table and table[name].has_effect}
    return {name: v for name, v in known.items() if v != table[name].default and table[name].refusal(v) is None}


Found = Callable[[str], Estimate]
"""A property of a log by its name."""
