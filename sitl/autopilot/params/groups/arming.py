# SPDX-License-Identifier: BSD-3-Clause
"""Arming: which checks, how long armed on the ground."""

from __future__ import annotations

from ..parameter import INT8, INT32, Parameter

PARAMETERS = (
    Parameter("ARMING_RUDDER", 2, 0, 2, "", "Yaw stick: 0 nothing, 1 arms, 2 arms and disarms", INT8),
    Parameter(
        "ARMING_CHECK",
        1,
        0,
        2097150,
        "",
        "Checks before arming: 1 all, else 2 barometer, 4 compass, 8 GPS, 16 IMU, 64 RC, 256 battery",
        INT32,
    ),
)
