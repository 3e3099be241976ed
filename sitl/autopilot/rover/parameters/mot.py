# SPDX-License-Identifier: BSD-3-Clause
"""Motors."""

from __future__ import annotations

from ...params.parameter import INT8, INT16, Parameter

PARAMETERS = (
    Parameter("MOT_SAFE_DISARM", 0, 0, 1, "", "1: no pulses to the motors while disarmed; 0: SERVOn_TRIM", INT8),
    Parameter("MOT_THR_MIN", 0, 0, 20, "%", "Throttle at which the motors begin to turn", INT8),
    Parameter("MOT_THR_MAX", 100, 5, 100, "%", "Throttle limit", INT8),
    Parameter("MOT_SLEWRATE", 100, 0, 1000, "%/s", "Fastest change of the throttle; 0: no limit", INT16),
    Parameter("MOT_THST_EXPO", 0.0, -1.0, 1.0, "", "Curve of thrust over command: 0 linear, 1 quadratic"),
    Parameter("MOT_SPD_SCA_BASE", 1.0, 0.0, 10.0, "m/s", "Speed above which steering shrinks with speed; 0: never"),
    Parameter("MOT_STR_THR_MIX", 0.5, 0.2, 1.0, "", "Skid steering used up: 0.5 shares, above favours steering"),
    Parameter("MOT_THST_ASYM", 1.0, 1.0, 10.0, "", "Skid steering: forward thrust over backward thrust"),
    Parameter("MOT_REV_DELAY", 0.0, 0.0, 1.0, "s", "Pause at zero when a motor changes direction"),
)
