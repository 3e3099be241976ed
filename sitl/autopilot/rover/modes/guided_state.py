# SPDX-License-Identifier: BSD-3-Clause
"""What GUIDED is doing (``modes.guided.submode``), and the answers of its set-point laws."""

from __future__ import annotations

STOP = 0
POSITION = 1
HEADING_AND_SPEED = 2
TURN_RATE_AND_SPEED = 3
STEERING_AND_THROTTLE = 4

OK = 0
NOT_FINITE = 1  # NaN, infinite or so large that arithmetic with it would be
NOT_IN_GUIDED = 2
OUT_OF_RANGE = 3

LARGEST = 1e7
"""Metres, metres a second, radians beyond this are refused."""
