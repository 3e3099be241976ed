# SPDX-License-Identifier: BSD-3-Clause
"""Bits of LOG_BITMASK that all firmwares have (https://ardupilot.org/copter/docs/parameters.html#log-bitmask).

Those of one firmware are in its own list of messages.
"""

from __future__ import annotations

ATTITUDE_FAST, ATTITUDE, GPS, PERFORMANCE, CONTROL, NAVIGATION = (1 << k for k in range(6))
IMU, COMMANDS, BATTERY = 1 << 7, 1 << 8, 1 << 9

FLOW = 1 << 14

MEDIUM = 10.0
"""Rate of most messages [Hz], of the attitude with ATTITUDE, too."""
FAST = 50.0
"""Rate of the attitude with ATTITUDE_FAST; ArduPilot's is that of its loop, 400 Hz."""
IMU_RATE = 25.0
"""Rate of the inertial samples [Hz], of the rover's attitude with ATTITUDE_FAST, too (ArduPilot: 50 Hz)."""
