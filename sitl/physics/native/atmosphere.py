# SPDX-License-Identifier: BSD-3-Clause
"""International Standard Atmosphere below 11 km (ISO 2533)."""

from __future__ import annotations

import math

from ...core.kernels import law

SEA_LEVEL_PRESSURE = 101325.0
SEA_LEVEL_TEMPERATURE = 288.15
LAPSE_RATE = 0.0065
GAS_CONSTANT = 287.05287
EXPONENT = 9.80665 / (GAS_CONSTANT * LAPSE_RATE)


@law
def temperature(altitude):
    """Air temperature [K] at an altitude above mean sea level [m]."""
    return SEA_LEVEL_TEMPERATURE - LAPSE_RATE * altitude


@law
def pressure(altitude):
    """Static pressure [Pa] at an altitude above mean sea level [m]."""
    return SEA_LEVEL_PRESSURE * math.pow(temperature(altitude) / SEA_LEVEL_TEMPERATURE, EXPONENT)


@law
def density(altitude):
    """Air density [kg/m^3] at an altitude above mean sea level [m]."""
    return pressure(altitude) / (GAS_CONSTANT * temperature(altitude))


@law
def update(p):
    """Air density at the vehicle (called as often as the barometer samples)."""
    p.air.density = density(float(p.place.alt) - float(p.body.pos[2]))
    p.air.density_root = math.sqrt(float(p.air.density))
