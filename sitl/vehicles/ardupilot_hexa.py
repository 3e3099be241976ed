# SPDX-License-Identifier: BSD-3-Clause
"""ArduPilot's SITL hexacopter (``ardupilot_quad`` tells of its model)."""

from __future__ import annotations

from .ardupilot_quad import multicopter
from .copter_airframe import CCW, CW

AIRFRAME = multicopter(
    "ardupilot_hexa",
    "SITL hexacopter, plus frame",
    ((0, CW), (180, CCW), (-120, CW), (60, CCW), (-60, CCW), (120, CW)),
    2,
    0,
)
