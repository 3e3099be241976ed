# SPDX-License-Identifier: BSD-3-Clause
"""Driving along paths."""

from __future__ import annotations

from ...params.parameter import INT16, Parameter

PARAMETERS = (
    Parameter("WP_SPEED", 2.0, 0.0, 100.0, "m/s", "Speed along legs"),
    Parameter("WP_RADIUS", 2.0, 0.0, 100.0, "m", "Distance at which a waypoint counts as reached"),
    Parameter("WP_PIVOT_ANGLE", 60, 0, 360, "deg", "Skid steering: turns on the spot from so much on; 0: never", INT16),
    Parameter("WP_PIVOT_RATE", 60, 0, 360, "deg/s", "Turn rate on the spot", INT16),
    Parameter("WP_PIVOT_DELAY", 0.0, 0.0, 60.0, "s", "Wait after a turn on the spot"),
    Parameter("WP_ACCEL", 0.0, 0.0, 100.0, "m/s/s", "Acceleration along legs; 0: ATC_ACCEL_MAX"),
    Parameter("WP_JERK", 0.0, 0.0, 100.0, "m/s/s/s", "Jerk along legs; 0: the same number as the acceleration"),
)
