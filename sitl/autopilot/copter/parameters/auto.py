# SPDX-License-Identifier: BSD-3-Clause
"""AUTO."""

from __future__ import annotations

from ...params.parameter import INT32, Parameter

PARAMETERS = (
    Parameter(
        "AUTO_OPTIONS",
        0,
        0,
        255,
        "",
        "Bits: 1 may be armed in AUTO, 2 takes off without a raised throttle, 128 pilot may not yaw",
        INT32,
    ),
)
