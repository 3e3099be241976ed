# SPDX-License-Identifier: BSD-3-Clause
"""Parameters of the pilot's transmitter."""

from __future__ import annotations

from .parameter import INT8, INT16, ParameterGroup, param


class RcChannel(ParameterGroup):
    """RCn_: calibration of a channel."""

    MIN: float = param(1100, 800, 2200, "us", "Least pulse of channel {n}", INT16)
    TRIM: float = param(1500, 800, 2200, "us", "Pulse of channel {n} at rest", INT16)
    MAX: float = param(1900, 800, 2200, "us", "Greatest pulse of channel {n}", INT16)
    REVERSED: float = param(0, 0, 1, "", "Channel {n} works the other way round", INT8)
    DZ: float = param(20, 0, 200, "us", "Dead zone of channel {n}", INT16)
    OPTION: float = param(0, 0, 32767, "", "Function of a switch on channel {n}; 0 none", INT16)


class RcMap(ParameterGroup):
    """RCMAP_: which stick is on which channel."""

    ROLL: float = param(1, 1, 16, "", "Channel of the roll stick", INT8)
    PITCH: float = param(2, 1, 16, "", "Channel of the pitch stick", INT8)
    THROTTLE: float = param(3, 1, 16, "", "Channel of the throttle stick", INT8)
    YAW: float = param(4, 1, 16, "", "Channel of the yaw stick", INT8)
