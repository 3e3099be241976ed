# SPDX-License-Identifier: BSD-3-Clause
"""Magnetometers: the geomagnetic field at home in the body frame, white noise, hard and soft iron."""

from __future__ import annotations

from ....core.algebra import dot, rotate_inverse
from ....core.border import Sensors
from ....core.kernels import law
from ....core.rng import Rng, normal_vector
from ....core.vectors import Quat, Vec3
from ....vehicles.properties.body import Sensors as SensorProperties
from ..records import Iron, Physics


@law
def measure_field(q: Quat, field: Vec3, airframe: SensorProperties, rng: Rng) -> Vec3:
    """Field [gauss] that a sensor at attitude ``q`` shows, body frame; ``field``: NED."""
    scale = airframe.noise_scale
    noise = scale * airframe.mag_noise
    return rotate_inverse(q, field) + scale * airframe.mag_offset + noise * normal_vector(rng)


@law
def shown(field: Vec3, iron: Iron) -> Vec3:
    """What a compass shows of a field [gauss], body frame."""
    if iron.is_soft:
        field = Vec3(dot(iron.x, field), dot(iron.y, field), dot(iron.z, field))
    return (1.0 + iron.gain_error) * field - iron.hard


@law
def sample(p: Physics, sensors: Sensors, rng: Rng, time_us: int) -> None:
    """Write mag, mag2 and mag3 [gauss], body frame. The compasses differ by what iron does to them, and by faults."""
    s = p.sensors
    field, irons, silent = measure_field(p.body.q, p.origin.field, p.airframe, rng), s.irons, s.compass_silent
    if s.is_disturbed:
        field += p.battery.current * s.compass_by_current + s.compass_noise * normal_vector(rng)
    if silent & 1 == 0:
        sensors.mag = shown(field, irons[0])
        sensors.mag_count += 1
        sensors.mag_us[0] = time_us
    if silent & 2 == 0:
        sensors.mag2 = shown(field, irons[1])
        sensors.mag_us[1] = time_us
    if silent & 4 == 0:
        sensors.mag3 = shown(field, irons[2])
        sensors.mag_us[2] = time_us
