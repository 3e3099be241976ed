# SPDX-License-Identifier: BSD-3-Clause
"""ArduPilot's SITL octocopter (``ardupilot_quad`` tells of its model)."""

from __future__ import annotations

from .ardupilot_quad import multicopter
from .copter_airframe import CCW, CW

AIRFRAME = multicopter(
    "ardupilot_octa",
    "SITL octocopter, plus frame",
    ((0, CW), (180, CW), (45, CCW), (135, CCW), (-45, CCW), (-135, CCW), (-90, CW), (90, CW)),
    3,
    0,
)
