# SPDX-License-Identifier: BSD-3-Clause
"""Power module: battery voltage and current."""

from __future__ import annotations

from ....core.kernels import law


@law
def sample(p, sensors):
    """Write battery_voltage [V] and battery_current [A]; called every 0.1 s, as ArduPilot's battery monitor reads."""
    sensors.battery_voltage = float(p.battery.voltage)
    sensors.battery_current = float(p.battery.current)
