# SPDX-License-Identifier: BSD-3-Clause
"""The record of arming and of what the landing detector knows."""

from __future__ import annotations

from ..core.records import Record


class Arming(Record):
    """Whether the motors are armed, and what the landing and crash detectors know."""

    armed: int
    armed_us: int  # when last armed
    auto_armed: int  # throttle raised or take-off commanded since arming
    landed: int
    landed_maybe: int
    landed_ticks: int
    idle_us: int  # armed on the ground with throttle down, for DISARM_DELAY
    crash_ticks: int
    prearm_ok: int  # SYS_STATUS health bit MAV_SYS_STATUS_PREARM_CHECK
