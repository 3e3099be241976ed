# SPDX-License-Identifier: BSD-3-Clause
"""Motors."""

from __future__ import annotations

from ...params.parameter import INT8, INT16, Parameter

PARAMETERS = (
    Parameter(
        "MOT_YAW_HEADROOM",
        200,
        0,
        1000,
        "PWM",
        "Thrust kept for yaw when roll and pitch want it all, in thousandths",
        INT16,
    ),
    Parameter("MOT_THST_EXPO", 0.65, -1.0, 1.0, "", "Curve of thrust over command: 0 linear, 1 quadratic"),
    Parameter("MOT_SPIN_MAX", 0.95, 0.5, 1.0, "", "Command at which thrust is full"),
    Parameter("MOT_BAT_VOLT_MAX", 0.0, 0.0, 100.0, "V", "Voltage at which thrust is full; 0: no compensation"),
    Parameter("MOT_BAT_VOLT_MIN", 0.0, 0.0, 100.0, "V", "Lowest voltage that is compensated"),
    Parameter("MOT_PWM_MIN", 1000, 0, 2000, "us", "Shortest pulse", INT16),
    Parameter("MOT_PWM_MAX", 2000, 0, 2200, "us", "Longest pulse", INT16),
    Parameter("MOT_SPIN_MIN", 0.15, 0.0, 0.3, "", "Command at which thrust begins"),
    Parameter("MOT_SPIN_ARM", 0.1, 0.0, 0.3, "", "Command of motors that idle armed on the ground"),
    Parameter("MOT_THST_HOVER", 0.35, 0.125, 0.6875, "", "Throttle that hovers; learnt in flight"),
    Parameter("MOT_HOVER_LEARN", 2, 0, 2, "", "0: keep MOT_THST_HOVER, 1: learn it, 2: learn and save it", INT8),
    Parameter("MOT_SPOOL_TIME", 0.5, 0.0, 2.0, "s", "Time from rest to idle, and from idle to full throttle"),
    Parameter("MOT_SLEW_UP_TIME", 0.0, 0.0, 0.5, "s", "Least time from no to full command; 0: no limit"),
    Parameter("MOT_SLEW_DN_TIME", 0.0, 0.0, 0.5, "s", "Least time from full to no command; 0: no limit"),
    Parameter("MOT_SPOOL_TIM_DN", 0.0, 0.0, 2.0, "s", "Time to spool down; 0: MOT_SPOOL_TIME"),
)
