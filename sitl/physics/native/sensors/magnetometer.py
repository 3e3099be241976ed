# SPDX-License-Identifier: BSD-3-Clause
"""Magnetometers: the geomagnetic field at home in the body frame, white noise, hard and soft iron."""

from __future__ import annotations

from ....core.algebra import dot, rotate_inverse
from ....core.border import Sensors
from ....core.kernels import law
from ....core.rng import Rng, normal_vector
from ....core.vectors import Quat, Vec3
from ....vehicles.figures.body import Sensors as SensorFigures
from ..records import Iron, Physics


@law
def measure_field(q: Quat, field: Vec3, figures: SensorFigures, rng: Rng) -> Vec3:
    """Field [gauss] that a sensor at attitude ``q`` shows, body frame; ``field``: NED."""
    scale = figures.noise_scale
    noise = scale * figures.mag_noise
    return rotate_inverse(q, field) + scale * figures.mag_offset + noise * normal_vector(rng)


@law
def shown(field: Vec3, iron: Iron) -> Vec3:
    """What a compass shows of a field [gauss], body frame."""
    if iron.is_soft:
        field = Vec3(dot(iron.x, field), dot(iron.y, field), dot(iron.z, field))
    return field - iron.hard


@law
def sample(p: Physics, sensors: Sensors, rng: Rng) -> None:
    """Write mag, mag2 and mag3 [gauss], body frame. The compasses differ by what iron does to them alone."""
    field, irons = measure_field(p.body.q, p.place.field, p.airframe, rng), p.sensors.irons
    sensors.mag = shown(field, irons[0])
    sensors.mag2 = shown(field, irons[1])
    sensors.mag3 = shown(field, irons[2])
    sensors.mag_count += 1
