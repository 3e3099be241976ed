# SPDX-License-Identifier: BSD-3-Clause
"""The record of the failsafes."""

from __future__ import annotations

from ..core.records import record

FAILSAFE_DTYPE = record(
    ("gcs_us", "i8"),  # last heartbeat of the ground station; 0 none so far (written by the bridge)
    ("gcs", "i8"),  # failsafe is on
    ("radio", "i8"),
    ("radio_count", "i8"),  # consecutive frames with a throttle below FS_THR_VALUE
    ("battery", "i8"),  # 0 none, 1 low, 2 critical
    ("battery_low_us", "i8"),  # since when below the low limit; 0 not
    ("battery_critical_us", "i8"),
    ("ekf", "i8"),  # 1 the estimate is bad, 2 and the mode was ended for it
    ("ekf_count", "i8"),  # tenths of a second of bad variance
    ("ekf_vel", "f8"),  # filtered variances
    ("ekf_pos", "f8"),
    ("ekf_mag", "f8"),
)
