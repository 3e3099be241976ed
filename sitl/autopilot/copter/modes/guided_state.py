# SPDX-License-Identifier: BSD-3-Clause
"""What GUIDED is doing (``modes.guided.submode``), and the answers of its set-point laws."""

from __future__ import annotations

TAKEOFF = 0
POSITION = 1
POS_VEL_ACCEL = 2
VELOCITY_ACCEL = 3
ACCEL = 4
ANGLE = 5

OK = 0
NOT_FINITE = 1  # NaN, infinite or so large that arithmetic with it would be
NOT_IN_GUIDED = 2
OUT_OF_RANGE = 3

LARGEST = 1e7
"""Metres, metres a second, radians beyond this are refused."""
