# SPDX-License-Identifier: BSD-3-Clause
"""Barometer: static pressure of the standard atmosphere, white noise, slow drift; air temperature."""

from __future__ import annotations

from ....core.border import Sensors
from ....core.kernels import law
from ....core.rng import Rng, normal
from ....vehicles.figures.body import Sensors as SensorFigures
from ..atmosphere import pressure, temperature
from ..records import Derived, Physics, SensorState


@law
def pressure_error(s: SensorState, a: SensorFigures, d: Derived, rng: Rng) -> float:
    """Drift and noise of a sample [Pa]."""
    s.baro_drift = d.baro_drift_decay * s.baro_drift + d.baro_drift_step * normal(rng)
    return a.noise_scale * (a.baro_drift * s.baro_drift + a.baro_noise * normal(rng))


@law
def sample(p: Physics, sensors: Sensors, rng: Rng) -> None:
    """Write abs_pressure [hPa] and temperature [degC]."""
    if p.sensors.baro_missing:
        return
    altitude = p.place.alt - p.body.pos.z
    error = pressure_error(p.sensors, p.airframe, p.derived, rng)
    sensors.abs_pressure = 0.01 * (pressure(altitude) + error)
    sensors.temperature = temperature(altitude) - 273.15
    sensors.baro_count += 1
