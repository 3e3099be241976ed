# SPDX-License-Identifier: BSD-3-Clause
"""Parameters of the rover's failsafes."""

from __future__ import annotations

from ...params import fence_parameters, system
from ...params.parameter import BITS32, INT8, INT16, INT32, param


class Battery(system.Battery):
    """BATT_: with what an empty battery does."""

    FS_LOW_ACT: float = param(
        0,
        0,
        6,
        "",
        "0 nothing, 1 RTL, 2 HOLD, 3 SMART_RTL or RTL, 4 SMART_RTL or HOLD, 5 disarms, 6 LOITER or HOLD",
        INT8,
    )
    FS_CRT_ACT: float = param(0, 0, 6, "", "When critical: as BATT_FS_LOW_ACT", INT8)


class Failsafes(system.Failsafes):
    """FS_: failsafes."""

    ACTION: float = param(
        2,
        0,
        6,
        "",
        "Radio or GCS lost: 0 nothing, 1 RTL, 2 HOLD, 3 SMART_RTL or RTL, 4 SMART_RTL or HOLD, 5 disarms, 6 LOITER",
        INT8,
    )
    TIMEOUT: float = param(1.5, 0.0, 100.0, "s", "The loss must last so long before FS_ACTION")
    THR_ENABLE: float = param(
        1, 0, 2, "", "Radio: 0 not watched, 1 FS_ACTION when lost, 2 the same but AUTO goes on", INT8
    )
    THR_VALUE: float = param(910, 800, 2200, "us", "Throttle pulse below which the radio is lost", INT16)
    GCS_ENABLE: float = param(
        0, 0, 127, "", "Ground station: 0 not watched, 2 FS_ACTION when lost but AUTO goes on, others FS_ACTION", INT8
    )
    GCS_TIMEOUT: float = param(5.0, 2.0, 120.0, "s", "Silence of the ground station that counts as lost")
    CRASH_CHECK: float = param(0, 0, 2, "", "Crash or block: 0 not watched, 1 HOLD, 2 HOLD and disarm", INT8)
    EKF_ACTION: float = param(
        1, 0, 2, "", "Bad estimate in a mode that needs a position: 0 nothing, 1 HOLD, 2 report", INT8
    )
    EKF_THRESH: float = param(
        0.8, 0.0, 2.0, "", "Test ratio of the estimator that counts as bad; 0 switches the check off"
    )
    OPTIONS: float = param(0, *BITS32, "", "1: radio and GCS failsafes act in HOLD, too", INT32)


class Fence(fence_parameters.Fence):
    """FENCE_: what follows a breach."""

    TYPE: float = param(6, 0, 15, "", "Bits: 2 circle around home, 4 areas", INT8)
    ACTION: float = param(
        1,
        -128,
        127,
        "",
        "Breached: 0 nothing, 1 RTL or HOLD, 2 HOLD, 3 SMART_RTL, RTL, HOLD, 4 SMART_RTL or HOLD, 5 disarms, 6 LOITER",
        INT8,
    )
