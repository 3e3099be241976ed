# SPDX-License-Identifier: BSD-3-Clause
"""The record of the failsafes."""

from __future__ import annotations

from ..core.records import Record


class Failsafe(Record):
    """What the failsafes watch and which of them are on."""

    gcs_us: int  # last heartbeat of the ground station; 0 none so far (written by the bridge)
    gcs: int  # failsafe is on
    radio: int
    radio_count: int  # consecutive frames with a throttle below FS_THR_VALUE
    battery: int  # 0 none, 1 low, 2 critical
    battery_low_us: int  # since when below the low limit; 0 not
    battery_critical_us: int
    ekf: int  # 1 the estimate is bad, 2 and the mode was ended for it
    ekf_count: int  # tenths of a second of bad variance
    ekf_vel: float  # filtered variances
    ekf_pos: float
    ekf_mag: float
