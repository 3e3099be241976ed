# SPDX-License-Identifier: BSD-3-Clause
"""ArduPilot's SITL quad (``ardupilot_quad`` tells of its model)."""

from __future__ import annotations

from .ardupilot_quad import multicopter
from .copter_airframe import CCW, CW

AIRFRAME = multicopter("ardupilot_x", "SITL quad, X frame", ((45, CCW), (-135, CCW), (-45, CW), (135, CW)), 1, 1)
