# SPDX-License-Identifier: BSD-3-Clause
"""Magnetometer: the geomagnetic field at home in the body frame, hard-iron offset and white noise."""

from __future__ import annotations

from ....core.kernels import law
from ....core.rng import normal
from ....core.rotations import quat_rotate_inverse
from ....core.vectors import Vec3


@law
def sample(p, sensors, rng):
    """Write mag [gauss], body frame."""
    a, q, field = p.airframe, p.body.q, p.place.field
    x, y, z = quat_rotate_inverse(
        float(q[0]), float(q[1]), float(q[2]), float(q[3]), float(field[0]), float(field[1]), float(field[2])
    )
    scale = float(a.noise_scale)
    noise = scale * float(a.mag_noise)
    sensors.mag = Vec3(
        x + scale * a.mag_offset.x + noise * normal(rng),
        y + scale * a.mag_offset.y + noise * normal(rng),
        z + scale * a.mag_offset.z + noise * normal(rng),
    )
    sensors.mag_count += 1
