# SPDX-License-Identifier: BSD-3-Clause
"""Figures of a battery and of what draws on it besides the motors."""

from __future__ import annotations

from .figure import Figure

BATTERY = (
    Figure("battery_voltage_full", "V", "open circuit, full", 1.0, 1000.0),
    Figure("battery_capacity", "Ah", "0: an ideal source of battery_voltage_full", default=0.0),
    Figure("battery_resistance", "ohm", "inner resistance", default=0.0),
    Figure("avionics_current", "A", "drawn by everything but the motors", default=0.0),
)
