# SPDX-License-Identifier: BSD-3-Clause
"""What an empty battery does."""

from __future__ import annotations

from ...params.parameter import INT8, Parameter

PARAMETERS = (
    Parameter(
        "BATT_FS_LOW_ACT",
        0,
        0,
        7,
        "",
        "When low: 0 nothing, 1 LAND, 2 RTL, 3 4 return or land, 5 stops the motors, 7 BRAKE or LAND",
        INT8,
    ),
    Parameter("BATT_FS_CRT_ACT", 0, 0, 7, "", "When critical: as BATT_FS_LOW_ACT", INT8),
)
