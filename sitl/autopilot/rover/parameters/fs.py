# SPDX-License-Identifier: BSD-3-Clause
"""Failsafes."""

from __future__ import annotations

from ...params.parameter import INT8, INT16, INT32, Parameter

PARAMETERS = (
    Parameter(
        "FS_ACTION",
        2,
        0,
        6,
        "",
        "Radio or GCS lost: 0 nothing, 1 RTL, 2 HOLD, 3 SMART_RTL or RTL, 4 SMART_RTL or HOLD, 5 disarms, 6 LOITER",
        INT8,
    ),
    Parameter("FS_TIMEOUT", 1.5, 0.0, 100.0, "s", "The loss must last so long before FS_ACTION"),
    Parameter(
        "FS_THR_ENABLE", 1, 0, 2, "", "Radio: 0 not watched, 1 FS_ACTION when lost, 2 the same but AUTO goes on", INT8
    ),
    Parameter("FS_THR_VALUE", 910, 800, 2200, "us", "Throttle pulse below which the radio is lost", INT16),
    Parameter(
        "FS_GCS_ENABLE",
        0,
        0,
        2,
        "",
        "Ground station: 0 not watched, 1 FS_ACTION when lost, 2 the same but AUTO goes on",
        INT8,
    ),
    Parameter("FS_GCS_TIMEOUT", 5.0, 2.0, 120.0, "s", "Silence of the ground station that counts as lost"),
    Parameter("FS_CRASH_CHECK", 0, 0, 2, "", "Crash or block: 0 not watched, 1 HOLD, 2 HOLD and disarm", INT8),
    Parameter(
        "FS_EKF_ACTION", 1, 0, 2, "", "Bad estimate in a mode that needs a position: 0 nothing, 1 HOLD, 2 report", INT8
    ),
    Parameter(
        "FS_EKF_THRESH", 0.8, 0.0, 2.0, "", "Test ratio of the estimator that counts as bad; 0 switches the check off"
    ),
    Parameter("FS_OPTIONS", 0, 0, 1, "", "1: radio and GCS failsafes act in HOLD, too", INT32),
)
