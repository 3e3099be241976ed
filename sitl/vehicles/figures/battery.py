# SPDX-License-Identifier: BSD-3-Clause
"""Figures of a battery and of what draws on it besides the motors."""

from __future__ import annotations

from ...core.records import Record
from .figure import figure


class Battery(Record):
    """The battery, and what draws on it besides the motors."""

    battery_voltage_full: float = figure("V", "open circuit, full", 1.0, 1000.0)
    battery_capacity: float = figure("Ah", "0: an ideal source of battery_voltage_full", default=0.0)
    battery_resistance: float = figure("ohm", "inner resistance", default=0.0)
    avionics_current: float = figure("A", "drawn by everything but the motors", default=0.0)
