# SPDX-License-Identifier: BSD-3-Clause
"""Numbers of nature and of the simulation that many modules share."""

from __future__ import annotations

GRAVITY = 9.80665
"""Standard gravity [m/s^2]."""

TICK_US = 2500
"""One tick of physics and autopilot [us]."""
TICK_S = 0.0025
"""The same [s]."""
TICK_HZ = 400
"""Ticks a second [Hz]."""

NEVER = 1 << 62
"""A time that does not come [us]."""
