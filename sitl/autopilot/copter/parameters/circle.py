# SPDX-License-Identifier: BSD-3-Clause
"""Circles."""

from ...params.parameter import Parameter

PARAMETERS = (
    Parameter("CIRCLE_RADIUS", 1000.0, 0.0, 200000.0, "cm", "Radius when a mission gives none"),
    Parameter("CIRCLE_RATE", 20.0, -90.0, 90.0, "deg/s", "Greatest turn rate around the circle"),
)
