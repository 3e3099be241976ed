# SPDX-License-Identifier: BSD-3-Clause
"""Arming: which checks, how long armed on the ground."""

from __future__ import annotations

from ..parameter import INT32, INT8, Parameter

PARAMETERS = (
    Parameter("ARMING_RUDDER", 2, 0, 2, "", "Yaw stick: 0 nothing, 1 arms, 2 arms and disarms", INT8),
    Parameter("ARMING_CHECK", 1, 0, 2097150, "", "Bits of the checks before arming: 1 all, else 2 barometer, 4 compass, 8 GPS, 16 IMU, 32 parameters, 64 RC, 128 voltage, 256 battery", INT32),
)
