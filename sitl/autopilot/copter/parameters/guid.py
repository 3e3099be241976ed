# SPDX-License-Identifier: BSD-3-Clause
"""GUIDED."""

from __future__ import annotations

from ...params.parameter import INT32, Parameter

PARAMETERS = (
    Parameter(
        "GUID_OPTIONS",
        0,
        0,
        1023,
        "",
        "1 armed by the transmitter, 4 ignores the yaw stick, 8 SET_ATTITUDE_TARGET has thrust",
        INT32,
    ),
    Parameter(
        "GUID_TIMEOUT",
        3.0,
        0.1,
        60.0,
        "s",
        "Velocity, acceleration and attitude set-points are good for so long",
    ),
)
