# SPDX-License-Identifier: BSD-3-Clause
"""gym-sitl: an autopilot in the loop, in simulated time."""

__version__ = "0.1.0"
