# SPDX-License-Identifier: BSD-3-Clause
"""ArduPilot's SITL hexacopter (``ardupilot_quad`` tells of its model)."""

from __future__ import annotations

from .ardupilot_quad import multicopter
from .copter_airframe import CCW, CW

AIRFRAME = multicopter(
    "ardupilot_hexa_x",
    "SITL hexacopter, X frame",
    ((90, CW), (-90, CCW), (-30, CW), (150, CCW), (30, CCW), (-150, CW)),
    2,
    1,
)
