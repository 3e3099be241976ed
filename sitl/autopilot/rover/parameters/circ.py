# SPDX-License-Identifier: BSD-3-Clause
"""CIRCLE, and circles in missions."""

from __future__ import annotations

from ...params.parameter import INT8, Parameter

PARAMETERS = (
    Parameter("CIRC_RADIUS", 20.0, 0.0, 1000.0, "m", "Distance from the centre"),
    Parameter("CIRC_SPEED", 0.0, 0.0, 30.0, "m/s", "Speed around the circle; 0: WP_SPEED"),
    Parameter("CIRC_DIR", 0, 0, 1, "", "0 clockwise, 1 counter-clockwise", INT8),
)
