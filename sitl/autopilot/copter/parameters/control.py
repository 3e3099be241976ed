# SPDX-License-Identifier: BSD-3-Clause
"""Parameters of the copter's controllers and motors."""

from __future__ import annotations

from ...params.gains import BasicPidGains, PidGains
from ...params.parameter import INT8, INT16, ParameterGroup, group, param


class Attitude(ParameterGroup):
    """ATC_: attitude and rate control."""

    SLEW_YAW: float = param(6000.0, 0, 36000, "cdeg/s", "Fastest turn of modes that fly by themselves; 0: no limit")
    ACCEL_Y_MAX: float = param(27000.0, 0, 180000, "cdeg/s/s", "Yaw acceleration of shaped targets; 0: no limit")
    RATE_FF_ENAB: float = param(1, 0, 1, "", "1: shape attitude targets and feed their rates forward", INT8)
    ACCEL_R_MAX: float = param(110000.0, 0, 1000000, "cdeg/s/s", "Roll acceleration of shaped targets; 0: no limit")
    ACCEL_P_MAX: float = param(110000.0, 0, 1000000, "cdeg/s/s", "Pitch acceleration of shaped targets; 0: no limit")
    ANGLE_BOOST: float = param(1, 0, 1, "", "1: raise the throttle with the lean so that lift stays", INT8)
    ANG_RLL_P: float = param(4.5, 0.0, 40.0, "1/s", "Roll rate asked for per roll error")
    ANG_PIT_P: float = param(4.5, 0.0, 40.0, "1/s", "Pitch rate asked for per pitch error")
    ANG_YAW_P: float = param(4.5, 0.0, 40.0, "1/s", "Yaw rate asked for per heading error")
    ANG_LIM_TC: float = param(1.0, 0.0, 60.0, "s", "Time constant of the lean limit that keeps altitude")
    RATE_R_MAX: float = param(0.0, 0, 1080, "deg/s", "Roll rate limit; 0: none")
    RATE_P_MAX: float = param(0.0, 0, 1080, "deg/s", "Pitch rate limit; 0: none")
    RATE_Y_MAX: float = param(0.0, 0, 1080, "deg/s", "Yaw rate limit; 0: none")
    INPUT_TC: float = param(0.15, 0.0, 2.0, "s", "Time constant of shaped attitude: small is crisp, large is soft")
    RAT_RLL: PidGains = group("Roll rate loop")
    RAT_PIT: PidGains = group("Pitch rate loop")
    RAT_YAW: PidGains = group("Yaw rate loop", P=0.18, I=0.018, D=0.0, FLTE=2.5)
    THR_MIX_MIN: float = param(0.1, 0.1, 0.25, "", "Priority of attitude over throttle while landing")
    THR_MIX_MAX: float = param(0.5, 0.1, 0.9, "", "Priority of attitude over throttle in flight")
    THR_MIX_MAN: float = param(
        0.1, 0.1, 5.0, "", "Priority of attitude over throttle with throttle in the pilot's hand"
    )


class Position(ParameterGroup):
    """PSC_: position control."""

    POSZ_P: float = param(1.0, 0.0, 10.0, "1/s", "Climb rate asked for per altitude error")
    VELZ: BasicPidGains = group(
        "Climb-rate loop",
        P={"default": 5.0, "high": 50.0, "doc": "Vertical acceleration asked for per climb-rate error"},
        I={"default": 0.0, "high": 50.0},
        D=0.0,
    )
    ACCZ: PidGains = group(
        "Vertical thrust loop",
        P={"default": 0.5, "doc": "Vertical thrust loop: thousandths of throttle per cm/s/s"},
        I=1.0,
        D=0.0,
        IMAX={"default": 800.0, "high": 1000.0, "unit": "d%"},
        FLTT=0.0,
        FLTE=20.0,
        FLTD={"default": 0.0, "doc": "Vertical thrust loop: low-pass of the derivative; 0 none"},
        PDMX={"high": 1000.0, "unit": "d%"},
    )
    POSXY_P: float = param(1.0, 0.0, 10.0, "1/s", "Speed asked for per position error")
    VELXY: BasicPidGains = group("Speed loop", P={"doc": "Acceleration asked for per speed error"})
    ANGLE_MAX: float = param(0.0, 0.0, 80.0, "deg", "Lean limit of modes that hold position; 0: ANGLE_MAX")
    JERK_XY: float = param(5.0, 0.5, 50.0, "m/s/s/s", "Horizontal jerk of shaped paths")
    JERK_Z: float = param(5.0, 0.5, 50.0, "m/s/s/s", "Vertical jerk of shaped paths")


class Motors(ParameterGroup):
    """MOT_: motors."""

    YAW_HEADROOM: float = param(
        200, 0, 1000, "PWM", "Thrust kept for yaw when roll and pitch want it all, in thousandths", INT16
    )
    THST_EXPO: float = param(0.65, -1.0, 1.0, "", "Curve of thrust over command: 0 linear, 1 quadratic")
    SPIN_MAX: float = param(0.95, 0.5, 1.0, "", "Command at which thrust is full")
    BAT_VOLT_MAX: float = param(0.0, 0.0, 100.0, "V", "Voltage at which thrust is full; 0: no compensation")
    BAT_VOLT_MIN: float = param(0.0, 0.0, 100.0, "V", "Lowest voltage that is compensated")
    PWM_MIN: float = param(1000, 0, 2000, "us", "Shortest pulse", INT16)
    PWM_MAX: float = param(2000, 0, 2200, "us", "Longest pulse", INT16)
    SPIN_MIN: float = param(0.15, 0.0, 0.3, "", "Command at which thrust begins")
    SPIN_ARM: float = param(0.1, 0.0, 0.3, "", "Command of motors that idle armed on the ground")
    THST_HOVER: float = param(0.35, 0.125, 0.6875, "", "Throttle that hovers; learnt in flight")
    HOVER_LEARN: float = param(2, 0, 2, "", "0: keep MOT_THST_HOVER, 1: learn it, 2: learn and save it", INT8)
    SPOOL_TIME: float = param(0.5, 0.0, 2.0, "s", "Time from rest to idle, and from idle to full throttle")
    SLEW_UP_TIME: float = param(0.0, 0.0, 0.5, "s", "Least time from no to full command; 0: no limit")
    SLEW_DN_TIME: float = param(0.0, 0.0, 0.5, "s", "Least time from full to no command; 0: no limit")
    SPOOL_TIM_DN: float = param(0.0, 0.0, 2.0, "s", "Time to spool down; 0: MOT_SPOOL_TIME")
