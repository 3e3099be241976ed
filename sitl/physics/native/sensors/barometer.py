# SPDX-License-Identifier: BSD-3-Clause
"""Barometer: static pressure of the standard atmosphere, white noise, slow drift; air temperature."""

from __future__ import annotations

from ....core.algebra import rotate_inverse
from ....core.border import Sensors
from ....core.constants import TICK_S
from ....core.kernels import law
from ....core.rng import Rng, normal
from ....vehicles.properties.body import Sensors as SensorProperties
from ..atmosphere import pressure, temperature
from ..records import BARO_RING, BaroFault, Derived, Physics, SensorState

LOWEST, HIGHEST = -2000.0, 30000.0
"""Altitudes that a faulty barometer shows at most [m]."""
LEAST = 100.0
"""Pressure that it shows at least [Pa]."""


@law
def pressure_error(s: SensorState, a: SensorProperties, d: Derived, rng: Rng) -> float:
    """Drift and noise of a sample [Pa]."""
    s.baro_drift = d.baro_drift_decay * s.baro_drift + d.baro_drift_step * normal(rng)
    return a.noise_scale * (a.baro_drift * s.baro_drift + a.baro_noise * normal(rng))


@law
def wind_pressure(p: Physics, fault: BaroFault) -> float:
    """What the air that the body moves through adds [Pa]."""
    air = rotate_inverse(p.body.q, p.body.vel - p.wind.vel)
    front, back = fault.front, fault.back
    share = (
        (front.x if air.x > 0.0 else back.x) * air.x * air.x
        + (front.y if air.y > 0.0 else back.y) * air.y * air.y
        + (front.z if air.z > 0.0 else back.z) * air.z * air.z
    )
    return 0.5 * p.air.density * share


@law
def spoiled(p: Physics, fault: BaroFault, altitude: float, error: float, rng: Rng) -> float:
    """Pressure that a faulty barometer shows [Pa]; ``error``: of a healthy one [Pa]."""
    fault.drifted += fault.drift * p.derived.baro_period * TICK_S
    high = altitude + fault.height + fault.drifted + fault.noise * normal(rng)
    now = max(pressure(min(max(high, LOWEST), HIGHEST)) + error + wind_pressure(p, fault), LEAST)
    if fault.taken == 0:
        for k in range(BARO_RING):
            fault.ring[k] = now
        fault.taken = 1
    if not fault.frozen:
        fault.taken += 1
        fault.ring[fault.taken % BARO_RING] = now
    return float(fault.ring[(fault.taken - fault.delay) % BARO_RING])


@law
def shown(p: Physics, fault: BaroFault, altitude: float, error: float, rng: Rng) -> float:
    """Pressure that a barometer shows [Pa]."""
    return spoiled(p, fault, altitude, error, rng) if fault.is_on else pressure(altitude) + error


@law
def sample(p: Physics, sensors: Sensors, rng: Rng) -> None:
    """Write abs_pressure [hPa] and temperature [degC]. Two barometers differ by their faults alone."""
    s = p.sensors
    fault = s.baros[0]
    if s.baro_missing or (fault.off and not s.baros_differ):
        return
    altitude = p.origin.alt - p.body.pos.z
    error = pressure_error(s, p.airframe, p.derived, rng)
    if not fault.off:
        sensors.abs_pressure = 0.01 * shown(p, fault, altitude, error, rng)
        sensors.baro_count += 1
    if s.baros_differ and not s.baros[1].off:
        sensors.abs_pressure2 = 0.01 * shown(p, s.baros[1], altitude, error, rng)
        sensors.baro2_count += 1
    sensors.temperature = temperature(altitude) - 273.15
