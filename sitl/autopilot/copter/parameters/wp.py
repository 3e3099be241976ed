# SPDX-License-Identifier: BSD-3-Clause
"""Waypoints: heading, height without navigation."""

from __future__ import annotations

from ...params.parameter import INT8, Parameter

PARAMETERS = (
    Parameter(
        "WP_YAW_BEHAVIOR",
        2,
        0,
        3,
        "",
        "Heading: 0 kept, 1 to the next waypoint, 2 the same but kept in RTL, 3 along the course",
        INT8,
    ),
    Parameter("WP_NAVALT_MIN", 0.0, 0.0, 5.0, "m", "No leaning below this height in take-off and landing"),
)
