# SPDX-License-Identifier: BSD-3-Clause
"""Power module: battery voltage and current."""

from __future__ import annotations

import math

from ....core.border import Sensors
from ....core.kernels import law
from ..records import BatteryState


@law
def sample(battery: BatteryState, sensors: Sensors) -> None:
    """Write battery_voltage [V] and battery_current [A] in steps of 1 mV and 10 mA, as BATTERY_STATUS carries them;
    called every 0.1 s, as ArduPilot's battery monitor reads.
    """
    sensors.battery_voltage = 0.001 * math.floor(1000.0 * battery.voltage + 0.5)
    sensors.battery_current = 0.01 * math.floor(100.0 * battery.current + 0.5)
