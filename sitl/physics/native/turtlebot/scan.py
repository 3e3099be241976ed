# SPDX-License-Identifier: BSD-3-Clause
"""What a Turtlebot's lidar reads."""

from __future__ import annotations

import math

from ....core.kernels import law
from ....core.rng import normal
from ....worlds.planar import publish_readings
from ....worlds.raycast import scan_rays


@law
def scan(v, solids, grid, cells, rays, directions, ranges, readings):
    """Read the lidar into ``readings``, float32 as the original's messages.

    Args:
        v: one record.
        solids, grid, cells: of a world's ``Geometry``.
        rays: unit vectors on the body, FRD, shape (3, rays).
        directions, ranges: room to work in, shapes (3, rays), (rays,).
        readings: shape (readings,) [m], from right to left; inf: nothing within the range.
    """
    b, f = v.body, v.figures
    c, s = math.cos(float(b.heading)), math.sin(float(b.heading))
    ahead, height = float(f.lidar_ahead), float(f.lidar_height)
    for k in range(ranges.shape[0]):
        x, y = rays[0, k], rays[1, k]
        directions[0, k], directions[1, k], directions[2, k] = c * x - s * y, s * x + c * y, 0.0
    n, e, d = float(b.north) + c * ahead, float(b.east) + s * ahead, float(b.down) - height
    scan_rays(solids, grid, cells, n, e, d, directions, ranges)
    longest, noise = float(f.range_max), float(f.range_noise)
    publish_readings(ranges, longest, readings)
    if noise > 0.0:
        for k in range(readings.shape[0]):
            error = noise * normal(v.rng)
            reading = float(readings[k])
            if reading < longest:
                readings[k] = min(max(reading + error, 0.0), longest)
