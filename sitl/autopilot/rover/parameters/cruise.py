# SPDX-License-Identifier: BSD-3-Clause
"""The throttle that a speed needs, and how fast the vehicle can be."""

from __future__ import annotations

from ...params.parameter import INT8, Parameter

PARAMETERS = (
    Parameter("CRUISE_SPEED", 2.0, 0.0, 100.0, "m/s", "Speed that the vehicle has at CRUISE_THROTTLE"),
    Parameter("CRUISE_THROTTLE", 50, 0, 100, "%", "Throttle that gives CRUISE_SPEED", INT8),
    Parameter("SPEED_MAX", 0.0, 0.0, 30.0, "m/s", "Speed at full throttle; 0: extrapolated from CRUISE_SPEED"),
)
