# SPDX-License-Identifier: BSD-3-Clause
"""RTL."""

from __future__ import annotations

from ...params.parameter import INT16, INT32, Parameter

PARAMETERS = (
    Parameter("RTL_ALT", 1500, 0, 300000, "cm", "Height of the way home, above home", INT32),
    Parameter("RTL_ALT_FINAL", 0, 0, 32767, "cm", "Height over home where it stays; 0 lands", INT16),
    Parameter("RTL_CLIMB_MIN", 0, 0, 3000, "cm", "Least climb before the way home", INT16),
    Parameter(
        "RTL_CONE_SLOPE",
        3.0,
        0.0,
        10.0,
        "",
        "Near home it climbs no higher than distance times this; below 0.5 off",
    ),
    Parameter("RTL_SPEED", 0, 0, 2000, "cm/s", "Speed of the way home; 0 as WPNAV_SPEED", INT16),
    Parameter("RTL_LOIT_TIME", 5000, 0, 60000, "ms", "Wait over home", INT32),
)
