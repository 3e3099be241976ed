# SPDX-License-Identifier: BSD-3-Clause
"""ArduPilot's SITL Y6 (``ardupilot_quad`` tells of its model)."""

from __future__ import annotations

from .ardupilot_quad import multicopter
from .copter_airframe import CCW, CW

AIRFRAME = multicopter(
    "ardupilot_y6",
    "SITL Y6: three pairs of rotors",
    ((60, CCW), (-60, CW), (-60, CCW), (180, CW), (60, CW), (180, CCW)),
    5,
    0,
)
