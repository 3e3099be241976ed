# SPDX-License-Identifier: BSD-3-Clause
"""Battery monitor: voltage, current, charge used and left (BATT_MONITOR, BATT_CAPACITY)."""

from __future__ import annotations

from ..core.kernels import law
from ..core.scalars import constrain

PERIOD_S = 0.1
"""Called ten times a second."""


@law
def update(v):
    """Read the sensor and count the charge; without a monitor everything is unknown (remaining -1)."""
    ap = v.autopilot
    battery = ap.battery
    p = ap.params
    if p.BATT.MONITOR < 3.0:
        battery.voltage = 0.0
        battery.current = 0.0
        battery.remaining_pct = -1.0
        return
    battery.voltage = float(v.sensors.battery_voltage)
    if p.BATT.MONITOR < 4.0:
        battery.current = 0.0
        battery.remaining_pct = -1.0
        return
    battery.current = float(v.sensors.battery_current)
    hours = PERIOD_S / 3600.0
    battery.consumed_mah += battery.current * hours * 1000.0
    battery.consumed_wh += battery.current * battery.voltage * hours
    if p.BATT.CAPACITY > 0.0:
        left = p.BATT.CAPACITY - battery.consumed_mah
        battery.remaining_pct = constrain(100.0 * left / p.BATT.CAPACITY, 0.0, 100.0)
    else:
        battery.remaining_pct = -1.0
