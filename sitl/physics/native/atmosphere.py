# SPDX-License-Identifier: BSD-3-Clause
"""International Standard Atmosphere below 11 km (ISO 2533)."""

from __future__ import annotations

import math

from ...core.elementary import pow
from ...core.kernels import law
from .records import Air

SEA_LEVEL_PRESSURE = 101325.0
SEA_LEVEL_TEMPERATURE = 288.15
LAPSE_RATE = 0.0065
GAS_CONSTANT = 287.05287
EXPONENT = 9.80665 / (GAS_CONSTANT * LAPSE_RATE)
LOWEST, HIGHEST = -2000.0, 11000.0
"""Altitudes above mean sea level [m] between which the formulas hold: the standard's tables begin at -2 km, and the
temperature falls linearly to the tropopause at 11 km. At 44.3 km it would be 0 K, and there is no air to compute.
"""


@law
def temperature(altitude: float) -> float:
    """Air temperature [K] at an altitude above mean sea level [m]."""
    return SEA_LEVEL_TEMPERATURE - LAPSE_RATE * altitude


@law
def pressure(altitude: float) -> float:
    """Static pressure [Pa] at an altitude above mean sea level [m]."""
    return SEA_LEVEL_PRESSURE * pow(temperature(altitude) / SEA_LEVEL_TEMPERATURE, EXPONENT)


@law
def density(altitude: float) -> float:
    """Air density [kg/m^3] at an altitude above mean sea level [m]."""
    return pressure(altitude) / (GAS_CONSTANT * temperature(altitude))


@law
def set_air(air: Air, altitude: float) -> None:
    """Set the air to that at an altitude above mean sea level [m] (called as often as the barometer samples)."""
    air.density = density(altitude)
    air.density_root = math.sqrt(air.density)
