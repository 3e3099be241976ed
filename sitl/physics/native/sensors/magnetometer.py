# SPDX-License-Identifier: BSD-3-Clause
"""Magnetometer: the geomagnetic field at home in the body frame, hard-iron offset and white noise."""

from __future__ import annotations

from ....core.algebra import rotate_inverse
from ....core.border import Sensors
from ....core.kernels import law
from ....core.rng import Rng, normal_vector
from ....core.vectors import Quat, Vec3
from ....vehicles.figures.body import Sensors as SensorFigures
from ..records import Physics


@law
def measure_field(q: Quat, field: Vec3, figures: SensorFigures, rng: Rng) -> Vec3:
    """Field [gauss] that a sensor at attitude ``q`` shows, body frame; ``field``: NED."""
    scale = figures.noise_scale
    noise = scale * figures.mag_noise
    return rotate_inverse(q, field) + scale * figures.mag_offset + noise * normal_vector(rng)


@law
def sample(p: Physics, sensors: Sensors, rng: Rng) -> None:
    """Write mag, mag2 and mag3 [gauss], body frame. The compasses differ by their offsets alone."""
    field = measure_field(p.body.q, p.place.field, p.airframe, rng)
    sensors.mag = field
    sensors.mag2 = field - p.sensors.mag2_offset
    sensors.mag3 = field - p.sensors.mag3_offset
    sensors.mag_count += 1
