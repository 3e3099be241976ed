# SPDX-License-Identifier: BSD-3-Clause
"""Parameters of the copter's failsafes."""

from __future__ import annotations

from ...params import fence_parameters, simulation, system
from ...params.parameter import BITS32, INT8, INT16, INT32, param


class Battery(system.Battery):
    """BATT_: with what an empty battery does."""

    FS_LOW_ACT: float = param(
        0,
        -128,
        127,
        "",
        "Low: 1 LAND, 2 RTL, 3 SMART_RTL or RTL, 4 SMART_RTL or LAND, 5 stops motors, 6 AUTO_RTL or RTL, 7 BRAKE",
        INT8,
    )
    FS_CRT_ACT: float = param(0, -128, 127, "", "When critical: as BATT_FS_LOW_ACT", INT8)


class Failsafes(system.Failsafes):
    """FS_: failsafes."""

    GCS_ENABLE: float = param(
        0,
        -128,
        127,
        "",
        "GCS lost: 0 nothing, 1 RTL, 3 SMART_RTL or RTL, 4 SMART_RTL or LAND, 5 LAND, 6 AUTO_RTL or RTL, 7 BRAKE",
        INT8,
    )
    GCS_TIMEOUT: float = param(5.0, 2.0, 120.0, "s", "Silence of the ground station that counts as lost")
    THR_ENABLE: float = param(
        1,
        -128,
        127,
        "",
        "Radio lost: 0 nothing, 1 RTL, 3 LAND, 4 SMART_RTL or RTL, 5 SMART_RTL or LAND, 6 AUTO_RTL or RTL, 7 BRAKE",
        INT8,
    )
    THR_VALUE: float = param(975, 900, 1100, "us", "Throttle pulse below which the radio is lost", INT16)
    EKF_ACTION: float = param(1, 0, 3, "", "Bad estimate: 0 report, 1 LAND, 2 ALT_HOLD, 3 LAND from any mode", INT8)
    EKF_THRESH: float = param(
        0.8, 0.0, 2.0, "", "Test ratio of the estimator that counts as bad; 0 switches the check off"
    )
    EKF_FILT: float = param(5.0, 0.0, 10.0, "Hz", "Low-pass of the test ratios")
    VIBE_ENABLE: float = param(1, 0, 1, "", "1: height is held without accelerations that vibration spoils", INT8)
    CRASH_CHECK: float = param(1, 0, 1, "", "Disarm after a crash", INT8)
    OPTIONS: float = param(
        16, *BITS32, "", "Goes on: 1 AUTO, 4 GUIDED without radio; 2 AUTO, 16 pilot modes without GCS; 8 LAND", INT32
    )


class Fence(fence_parameters.Fence):
    """FENCE_: with limits in height."""

    ACTION: float = param(
        1, -128, 127, "",
        "Breached: 0 nothing, 1 RTL or LAND, 2 LAND, 3 SMART_RTL, RTL or LAND, 4 BRAKE or LAND, 5 SMART_RTL or LAND",
        INT8,
    )  # fmt: skip
    ALT_MAX: float = param(100.0, -1e9, 1e9, "m", "Greatest height above home")
    ALT_MIN: float = param(-10.0, -1e9, 1e9, "m", "Least height above home, once the vehicle has been above it")
    AUTOENABLE: float = param(
        0,
        0,
        3,
        "",
        "Fences switch themselves: 1, 2 on after an automatic take-off, 3 on when armed; off on landing",
        INT8,
    )


class Simulated(simulation.Simulated):
    """SIM_: with speed controllers, shoves and twists."""

    ESC_TELEM: float = param(1, 0, 1, "", "1: speed controllers tell how fast their motors turn", INT8)
    ESC_ARM_RPM: float = param(0, 0, 100000, "RPM", "Speed that the controllers of armed motors tell at least")
    VIB_MOT_MAX: float = param(
        0, 0, 10000, "Hz", "Turns a second at full command, of rotors whose model has no speed; noise of IMUs is theirs"
    )
    VIB_MOT_MULT: float = param(1, -1000, 1000, "", "With SIM_VIB_MOT_MAX: that noise times this")
    VIB_MOT_HMNC: float = param(
        1, 0, 255, "", "Bits: 1 the speed of the motors, 2 twice the speed, 4 three times", INT16
    )
    VIB_MOT_MASK: float = param(0, 0, 255, "", "Bits of the motors that vibrate; 0: all", INT32)
    SHOVE_X: float = param(0, -1000, 1000, "m/s/s", "Acceleration of a shove, forward")
    SHOVE_Y: float = param(0, -1000, 1000, "m/s/s", "Acceleration of a shove, right")
    SHOVE_Z: float = param(0, -1000, 1000, "m/s/s", "Acceleration of a shove, down")
    SHOVE_TIME: float = param(0, 0, 60000, "ms", "Set: shoves for so long, and is 0 again", INT32)
    TWIST_X: float = param(0, -1000, 1000, "rad/s/s", "Angular acceleration of a twist, about the forward axis")
    TWIST_Y: float = param(0, -1000, 1000, "rad/s/s", "Angular acceleration of a twist, about the axis to the right")
    TWIST_Z: float = param(0, -1000, 1000, "rad/s/s", "Angular acceleration of a twist, about the axis down")
    TWIST_TIME: float = param(0, 0, 60000, "ms", "Set: twists for so long, and is 0 again", INT32)
