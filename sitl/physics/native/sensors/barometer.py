# SPDX-License-Identifier: BSD-3-Clause
"""Barometer: static pressure of the standard atmosphere, white noise, slow drift; air temperature."""

from __future__ import annotations

from ....core.border import Sensors
from ....core.kernels import law
from ....core.rng import Rng, normal
from ..atmosphere import pressure, temperature
from ..records import Physics


@law
def sample(p: Physics, sensors: Sensors, rng: Rng) -> None:
    """Write abs_pressure [hPa] and temperature [degC]."""
    a, s, d = p.airframe, p.sensors, p.derived
    altitude = p.place.alt - p.body.pos.z
    s.baro_drift = d.baro_drift_decay * s.baro_drift + d.baro_drift_step * normal(rng)
    error = a.baro_drift * s.baro_drift + a.baro_noise * normal(rng)
    sensors.abs_pressure = 0.01 * (pressure(altitude) + a.noise_scale * error)
    sensors.temperature = temperature(altitude) - 273.15
    sensors.baro_count += 1
