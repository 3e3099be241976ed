# SPDX-License-Identifier: BSD-3-Clause
"""Speed controllers that tell how fast their motors turn (SIM_ESC_TELEM, SIM_ESC_ARM_RPM, SIM_VIB_MOT_MAX)."""

from __future__ import annotations

import math

from ....core.border import Sensors
from ....core.kernels import law
from ....vehicles.properties.multicopter import THRUST_MOMENTUM, Properties
from .state import Rotors

PERIOD_TICKS = 20
"""20 samples a second."""
_RPM = 60.0 / (2.0 * math.pi)  # of 1 rad/s


@law
def sample(rotors: Rotors, sensors: Sensors, airframe: Properties, armed: bool, time_us: int) -> None:
    """Write the speeds of all rotors; nothing without telemetry.

    The momentum model has no speeds: there a rotor turns ``rotors.rpm_max`` at full command. Controllers of armed
    motors report ``rotors.rpm_armed`` at least.
    """
    if not rotors.telemetry:
        return
    factor = rotors.rpm_max if airframe.thrust_model == THRUST_MOMENTUM else _RPM
    for k in range(airframe.rotor_count):
        rpm = factor * rotors.speed[k]
        sensors.esc_rpm[k] = max(rpm, rotors.rpm_armed) if armed else rpm
    sensors.esc_motors = airframe.rotor_count
    sensors.esc_time_us = time_us
    sensors.esc_count += 1
