# SPDX-License-Identifier: BSD-3-Clause
"""What an empty battery does."""

from __future__ import annotations

from ...params.parameter import INT8, Parameter

PARAMETERS = (
    Parameter(
        "BATT_FS_LOW_ACT",
        0,
        0,
        6,
        "",
        "0 nothing, 1 RTL, 2 HOLD, 3 SMART_RTL or RTL, 4 SMART_RTL or HOLD, 5 disarms, 6 LOITER or HOLD",
        INT8,
    ),
    Parameter("BATT_FS_CRT_ACT", 0, 0, 6, "", "When critical: as BATT_FS_LOW_ACT", INT8),
)
