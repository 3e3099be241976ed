# SPDX-License-Identifier: BSD-3-Clause
"""Bits of LOG_BITMASK, where copter and rover agree (https://ardupilot.org/copter/docs/parameters.html#log-bitmask)."""

from __future__ import annotations

ATTITUDE_FAST, ATTITUDE, GPS, PERFORMANCE, CONTROL, NAVIGATION = (1 << k for k in range(6))
IMU, COMMANDS, BATTERY = 1 << 7, 1 << 8, 1 << 9

FLOW = 1 << 14
COPTER_RC_IN, COPTER_RC_OUT, COPTER_PID, COPTER_COMPASS, COPTER_MOTORS = 1 << 6, 1 << 10, 1 << 12, 1 << 13, 1 << 17
ROVER_RANGEFINDER, ROVER_COMPASS, ROVER_STEERING, ROVER_RC = 1 << 10, 1 << 11, 1 << 13, 1 << 14

MEDIUM = 10.0
"""Rate of most messages [Hz], of the attitude with ATTITUDE, too."""
FAST = 50.0
"""Rate of the attitude with ATTITUDE_FAST; ArduPilot's is that of its loop, 400 Hz."""
IMU_RATE = 25.0
"""Rate of the inertial samples [Hz], of the rover's attitude with ATTITUDE_FAST, too (ArduPilot: 50 Hz)."""
