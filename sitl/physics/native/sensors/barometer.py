# SPDX-License-Identifier: BSD-3-Clause
"""Barometer: static pressure of the standard atmosphere, white noise, slow drift; air temperature."""

from __future__ import annotations

from ....core.kernels import law
from ....core.rng import normal
from ..atmosphere import pressure, temperature


@law
def sample(p, sensors, rng):
    """Write abs_pressure [hPa] and temperature [degC]."""
    a, s, d = p.airframe, p.sensors, p.derived
    altitude = float(p.place.alt) - float(p.body.pos[2])
    s.baro_drift = float(d.baro_drift_decay) * float(s.baro_drift) + float(d.baro_drift_step) * normal(rng)
    error = float(a.baro_drift) * float(s.baro_drift) + float(a.baro_noise) * normal(rng)
    sensors.abs_pressure = 0.01 * (pressure(altitude) + float(a.noise_scale) * error)
    sensors.temperature = temperature(altitude) - 273.15
    sensors.baro_count += 1
