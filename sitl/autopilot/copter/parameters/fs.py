# SPDX-License-Identifier: BSD-3-Clause
"""Failsafes."""

from __future__ import annotations

from ...params.parameter import INT8, INT16, INT32, Parameter

PARAMETERS = (
    Parameter(
        "FS_GCS_ENABLE",
        0,
        0,
        7,
        "",
        "Ground station lost: 0 nothing, 1 RTL, 3 4 return or land, 5 LAND, 7 BRAKE or LAND",
        INT8,
    ),
    Parameter("FS_GCS_TIMEOUT", 5.0, 2.0, 120.0, "s", "Silence of the ground station that counts as lost"),
    Parameter(
        "FS_THR_ENABLE",
        1,
        0,
        7,
        "",
        "Radio lost: 0 nothing, 1 RTL, 3 LAND, 4 5 return or land, 7 BRAKE or LAND",
        INT8,
    ),
    Parameter("FS_THR_VALUE", 975, 900, 1100, "us", "Throttle pulse below which the radio is lost", INT16),
    Parameter("FS_EKF_ACTION", 1, 0, 3, "", "Bad estimate: 0 report, 1 LAND, 2 ALT_HOLD, 3 LAND from any mode", INT8),
    Parameter(
        "FS_EKF_THRESH",
        0.8,
        0.0,
        2.0,
        "",
        "Test ratio of the estimator that counts as bad; 0 switches the check off",
    ),
    Parameter("FS_EKF_FILT", 5.0, 0.0, 10.0, "Hz", "Low-pass of the test ratios"),
    Parameter("FS_CRASH_CHECK", 1, 0, 1, "", "Disarm after a crash", INT8),
    Parameter(
        "FS_OPTIONS",
        16,
        0,
        127,
        "",
        "Goes on: 1 AUTO, 4 GUIDED without radio; 2 AUTO, 16 pilot modes without GCS; 8 LAND",
        INT32,
    ),
)
