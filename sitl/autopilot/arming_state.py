# SPDX-License-Identifier: BSD-3-Clause
"""The record of arming and of what the landing detector knows."""

from __future__ import annotations

from ..core.records import record

ARMING_DTYPE = record(
    ("armed", "i8"),
    ("armed_us", "i8"),  # when last armed
    ("auto_armed", "i8"),  # throttle raised or take-off commanded since arming
    ("landed", "i8"),
    ("landed_maybe", "i8"),
    ("landed_ticks", "i8"),
    ("idle_us", "i8"),  # armed on the ground with throttle down, for DISARM_DELAY
    ("crash_ticks", "i8"),
    ("prearm_ok", "i8"),  # SYS_STATUS health bit MAV_SYS_STATUS_PREARM_CHECK
)
