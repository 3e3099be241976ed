# SPDX-License-Identifier: BSD-3-Clause
"""Figures of what measures distances in a world: a planar lidar and a range-finder that looks down."""

from __future__ import annotations

import math

from .figure import Figure

LIDAR_SAMPLES = 360
"""Greatest number of published readings."""

RANGING = (
    Figure("lidar_rays", "", "rays cast; both ends of the field of view are rays", 0, 4096, 0, whole=True),
    Figure("lidar_samples", "", "readings published, of as many rays or more; 0 none", 0, LIDAR_SAMPLES, 0, whole=True),
    Figure("lidar_fov", "rad", "field of view, symmetric about straight ahead", 0.0, 2.0 * math.pi, 0.0),
    Figure("lidar_min", "m", "least reading", 0.0, 1e4, 0.0),
    Figure("lidar_max", "m", "range; what is farther reads as nothing", 0.0, 600.0, 0.0),
    Figure("lidar_rate", "Hz", "scans a second", 0.1, 400.0, 10.0),
    Figure("lidar_noise", "m", "standard deviation of a reading", 0.0, 10.0, 0.0),
    Figure("lidar_at", "m", "its place on the body: forward, right, down", -100.0, 100.0, (0.0, 0.0, 0.0), length=3),
    Figure("rangefinder_max", "m", "range of the one that looks down; 0 none", 0.0, 600.0, 0.0),
    Figure("rangefinder_min", "m", "least reading", 0.0, 1e4, 0.0),
    Figure("rangefinder_rate", "Hz", "readings a second", 0.1, 400.0, 10.0),
    Figure("rangefinder_noise", "m", "standard deviation of a reading", 0.0, 10.0, 0.0),
    Figure("rangefinder_at", "m", "its place on the body", -100.0, 100.0, (0.0, 0.0, 0.0), length=3),
)  # fmt: skip
