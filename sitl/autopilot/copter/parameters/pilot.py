# SPDX-License-Identifier: BSD-3-Clause
"""The pilot's sticks."""

from __future__ import annotations

from ...params.parameter import INT16, Parameter

PARAMETERS = (
    Parameter("PILOT_THR_FILT", 0.0, 0.0, 10.0, "Hz", "Low-pass of the throttle in STABILIZE; 0 none"),
    Parameter("PILOT_TKOFF_ALT", 0.0, 0.0, 1000.0, "cm", "Height of a take-off by stick"),
    Parameter(
        "PILOT_THR_BHV",
        0,
        0,
        7,
        "",
        "Bits: 1 throttle stick springs to the middle, 2 high throttle cancels LAND, 4 disarms on landing",
        INT16,
    ),
    Parameter("PILOT_SPEED_UP", 250, 10, 5000, "cm/s", "Climb rate at full stick", INT16),
    Parameter("PILOT_SPEED_DN", 0, 0, 5000, "cm/s", "Descent at full stick; 0 as PILOT_SPEED_UP", INT16),
    Parameter("PILOT_ACCEL_Z", 250, 10, 5000, "cm/s/s", "Vertical acceleration under the stick", INT16),
    Parameter("PILOT_Y_RATE", 202.5, 1.0, 360.0, "deg/s", "Turn rate at full stick"),
    Parameter("PILOT_Y_EXPO", 0.0, -0.5, 1.0, "", "Softness of the yaw stick around the middle"),
    Parameter("PILOT_Y_RATE_TC", 0.0, 0.0, 1.0, "s", "Time constant of the yaw stick"),
)
