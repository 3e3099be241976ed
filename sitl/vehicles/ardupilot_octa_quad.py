# SPDX-License-Identifier: BSD-3-Clause
"""ArduPilot's SITL octocopter of four pairs (``ardupilot_quad`` tells of its model)."""

from __future__ import annotations

from .ardupilot_quad import multicopter
from .copter_airframe import CCW, CW

AIRFRAME = multicopter(
    "ardupilot_octa_quad",
    "SITL octocopter of four pairs, X frame",
    ((45, CCW), (-45, CW), (-135, CCW), (135, CW), (-45, CCW), (45, CW), (135, CCW), (-135, CW)),
    4,
    1,
)
