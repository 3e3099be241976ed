# SPDX-License-Identifier: BSD-3-Clause
"""Figures of what measures distances in a world: a planar lidar and a range-finder that looks down."""

from __future__ import annotations

import math

from ...core.records import Record
from ...core.vectors import Vec3
from .figure import figure

LIDAR_SAMPLES = 360
"""Greatest number of published readings."""


class Ranging(Record):
    """Lidar and range-finder."""

    lidar_rays: int = figure("", "rays cast; both ends of the field of view are rays", 0, 4096, 0)
    lidar_samples: int = figure("", "readings published, of as many rays or more; 0 none", 0, LIDAR_SAMPLES, 0)
    lidar_fov: float = figure("rad", "field of view, symmetric about straight ahead", 0.0, 2.0 * math.pi, 0.0)
    lidar_min: float = figure("m", "least reading", 0.0, 10000.0, 0.0)
    lidar_max: float = figure("m", "range; what is farther reads as nothing", 0.0, 600.0, 0.0)
    lidar_rate: float = figure("Hz", "scans a second", 0.1, 400.0, 10.0)
    lidar_noise: float = figure("m", "standard deviation of a reading", 0.0, 10.0, 0.0)
    lidar_at: Vec3 = figure("m", "its place on the body: forward, right, down", -100.0, 100.0, (0.0, 0.0, 0.0))
    rangefinder_max: float = figure("m", "range of the one that looks down; 0 none", 0.0, 600.0, 0.0)
    rangefinder_min: float = figure("m", "least reading", 0.0, 10000.0, 0.0)
    rangefinder_rate: float = figure("Hz", "readings a second", 0.1, 400.0, 10.0)
    rangefinder_noise: float = figure("m", "standard deviation of a reading", 0.0, 10.0, 0.0)
    rangefinder_at: Vec3 = figure("m", "its place on the body", -100.0, 100.0, (0.0, 0.0, 0.0))
