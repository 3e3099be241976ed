# SPDX-License-Identifier: BSD-3-Clause
"""Battery monitor: voltage, current, charge used and left (BATT_MONITOR, BATT_CAPACITY)."""

from __future__ import annotations

from ..core.kernels import law
from ..core.scalars import constrain
from .params.system import Battery
from .state import BatteryState, Sensors

PERIOD_S = 0.1
"""Called ten times a second."""


VOLTAGE, VOLTAGE_AND_CURRENT = 3, 4
"""BATT_MONITOR: those that exist."""


def power_on(battery: BatteryState, params: Battery) -> None:
    """BATT_MONITOR chooses the monitor now, and until the next power-on."""
    kind = int(params.MONITOR)
    battery.driver = kind if kind in (VOLTAGE, VOLTAGE_AND_CURRENT) else 0
    battery.remaining_pct = -1.0
    battery.healthy = True


@law
def is_healthy(driver: int, params: Battery) -> bool:
    """Whether the monitor is the one that BATT_MONITOR asks for, and can measure; without one nothing is wrong."""
    return int(params.MONITOR) == driver and (driver == 0 or params.VOLT_PIN >= 0.0)


@law
def monitor(battery: BatteryState, sensors: Sensors, params: Battery, time_us: int) -> None:
    """Read the sensor and count the charge; without a monitor everything is unknown (remaining -1).

    A monitor that is not healthy keeps what it measured last.
    """
    battery.healthy = is_healthy(battery.driver, params)
    if not battery.healthy and battery.driver != 0:
        return
    battery.healthy_us = time_us
    measures_current = battery.driver >= VOLTAGE_AND_CURRENT
    battery.voltage = sensors.battery_voltage if battery.driver >= VOLTAGE else 0.0
    battery.current = sensors.battery_current if measures_current else 0.0
    if measures_current:
        hours = PERIOD_S / 3600.0
        battery.consumed_mah += battery.current * hours * 1000.0
        battery.consumed_wh += battery.current * battery.voltage * hours
    if measures_current and params.CAPACITY > 0.0:
        left = params.CAPACITY - battery.consumed_mah
        battery.remaining_pct = constrain(100.0 * left / params.CAPACITY, 0.0, 100.0)
    else:
        battery.remaining_pct = -1.0


def set_left(battery: BatteryState, params: Battery, percent: float) -> bool:
    """MAV_CMD_BATTERY_RESET: so much of BATT_CAPACITY is left [%]; False without a monitor of the current."""
    if params.MONITOR < 4.0 or params.CAPACITY <= 0.0:
        return False
    battery.consumed_mah = params.CAPACITY * (1.0 - percent / 100.0)
    battery.consumed_wh = battery.consumed_mah * battery.voltage / 1000.0
    battery.remaining_pct = percent
    return True
