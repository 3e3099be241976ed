# SPDX-License-Identifier: BSD-3-Clause
"""What a Turtlebot's lidar reads."""

from __future__ import annotations

from typing import NamedTuple

from ....core.array_kernels import Line, NarrowLine, Table
from ....core.elementary import sincos
from ....core.kernels import law
from ....core.rng import Rng, normal
from ....core.vectors import Vec3
from ....vehicles.turtlebot import Properties
from ....worlds.geometry import Solids
from ....worlds.planar import publish_readings
from ....worlds.raycast import scan_rays
from .state import Body


class Beams(NamedTuple):
    """The rays of a lidar, and memory to work in."""

    rays: Table
    """Unit vectors on the body, FRD, shape (3, rays)."""
    directions: Table
    """Memory, shape (3, rays)."""
    ranges: Line
    """Memory, shape (rays,)."""


@law
def scan(b: Body, f: Properties, solids: Solids, beams: Beams, readings: NarrowLine) -> None:
    """Read the lidar of a body in a world into ``readings``, float32 as the original's messages.

    ``readings``: shape (readings,) [m], from right to left; inf: nothing within the range.
    """
    directions = beams.directions
    s, c = sincos(b.heading)
    for k in range(beams.ranges.shape[0]):
        x, y = beams.rays[0, k], beams.rays[1, k]
        directions[0, k], directions[1, k], directions[2, k] = c * x - s * y, s * x + c * y, 0.0
    origin = Vec3(b.north + c * f.lidar_ahead, b.east + s * f.lidar_ahead, b.down - f.lidar_height)
    scan_rays(solids, origin, directions, f.range_max, beams.ranges)
    publish_readings(beams.ranges, f.range_max, readings)


@law
def add_noise(readings: NarrowLine, f: Properties, rng: Rng) -> None:
    """Add the lidar's noise to what it reads [m]."""
    if f.range_noise > 0.0:
        for k in range(readings.shape[0]):
            error = f.range_noise * normal(rng)
            reading = float(readings[k])
            if reading < f.range_max:
                readings[k] = min(max(reading + error, 0.0), f.range_max)
