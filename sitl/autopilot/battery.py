# SPDX-License-Identifier: BSD-3-Clause
"""Battery monitor: voltage, current, charge used and left (BATT_MONITOR, BATT_CAPACITY)."""

from __future__ import annotations

from ..core.kernels import law
from ..core.scalars import constrain
from .params.system import Battery
from .state import BatteryState, Sensors

PERIOD_S = 0.1
"""Called ten times a second."""


@law
def monitor(battery: BatteryState, sensors: Sensors, params: Battery) -> None:
    """Read the sensor and count the charge; without a monitor everything is unknown (remaining -1)."""
    measures_current = params.MONITOR >= 4.0
    battery.voltage = sensors.battery_voltage if params.MONITOR >= 3.0 else 0.0
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
