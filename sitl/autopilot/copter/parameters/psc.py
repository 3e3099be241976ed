# SPDX-License-Identifier: BSD-3-Clause
"""Position control."""

from __future__ import annotations

from ...params.parameter import Parameter

PARAMETERS = (
    Parameter("PSC_POSZ_P", 1.0, 0.0, 10.0, "1/s", "Climb rate asked for per altitude error"),
    Parameter("PSC_VELZ_P", 5.0, 0.0, 50.0, "1/s", "Vertical acceleration asked for per climb-rate error"),
    Parameter("PSC_VELZ_I", 0.0, 0.0, 50.0, "", "Climb-rate loop: integral gain"),
    Parameter("PSC_VELZ_IMAX", 1000.0, 0.0, 10000.0, "cm/s/s", "Climb-rate loop: limit of the integrator"),
    Parameter("PSC_VELZ_FLTE", 5.0, 0.0, 400.0, "Hz", "Climb-rate loop: low-pass of the error; 0: none"),
    Parameter("PSC_VELZ_D", 0.0, 0.0, 10.0, "", "Climb-rate loop: derivative gain"),
    Parameter("PSC_VELZ_FLTD", 5.0, 0.0, 400.0, "Hz", "Climb-rate loop: low-pass of the derivative; 0: none"),
    Parameter("PSC_VELZ_FF", 0.0, 0.0, 10.0, "", "Climb-rate loop: feed-forward of the target"),
    Parameter("PSC_ACCZ_P", 0.5, 0.0, 5.0, "", "Vertical thrust loop: thousandths of throttle per cm/s/s"),
    Parameter("PSC_ACCZ_I", 1.0, 0.0, 10.0, "", "Vertical thrust loop: integral gain"),
    Parameter("PSC_ACCZ_D", 0.0, 0.0, 1.0, "", "Vertical thrust loop: derivative gain"),
    Parameter("PSC_ACCZ_FF", 0.0, 0.0, 5.0, "", "Vertical thrust loop: feed-forward of the target"),
    Parameter("PSC_ACCZ_IMAX", 800.0, 0.0, 1000.0, "d%", "Vertical thrust loop: limit of the integrator"),
    Parameter("PSC_ACCZ_FLTT", 0.0, 0.0, 400.0, "Hz", "Vertical thrust loop: low-pass of the target; 0: none"),
    Parameter("PSC_ACCZ_FLTE", 20.0, 0.0, 400.0, "Hz", "Vertical thrust loop: low-pass of the error; 0: none"),
    Parameter("PSC_ACCZ_FLTD", 0.0, 0.0, 400.0, "Hz", "Vertical thrust loop: low-pass of the derivative; 0 none"),
    Parameter("PSC_ACCZ_PDMX", 0.0, 0.0, 1000.0, "d%", "Vertical thrust loop: limit of P and D together; 0: none"),
    Parameter("PSC_ACCZ_D_FF", 0.0, 0.0, 1.0, "", "Vertical thrust loop: feed-forward of the target's rate"),
    Parameter("PSC_POSXY_P", 1.0, 0.0, 10.0, "1/s", "Speed asked for per position error"),
    Parameter("PSC_VELXY_P", 2.0, 0.0, 20.0, "1/s", "Acceleration asked for per speed error"),
    Parameter("PSC_VELXY_I", 1.0, 0.0, 20.0, "", "Speed loop: integral gain"),
    Parameter("PSC_VELXY_IMAX", 1000.0, 0.0, 10000.0, "cm/s/s", "Speed loop: limit of the integrator"),
    Parameter("PSC_VELXY_FLTE", 5.0, 0.0, 400.0, "Hz", "Speed loop: low-pass of the error; 0: none"),
    Parameter("PSC_VELXY_D", 0.25, 0.0, 10.0, "", "Speed loop: derivative gain"),
    Parameter("PSC_VELXY_FLTD", 5.0, 0.0, 400.0, "Hz", "Speed loop: low-pass of the derivative; 0: none"),
    Parameter("PSC_VELXY_FF", 0.0, 0.0, 10.0, "", "Speed loop: feed-forward of the target"),
    Parameter("PSC_ANGLE_MAX", 0.0, 0.0, 80.0, "deg", "Lean limit of modes that hold position; 0: ANGLE_MAX"),
    Parameter("PSC_JERK_XY", 5.0, 0.5, 50.0, "m/s/s/s", "Horizontal jerk of shaped paths"),
    Parameter("PSC_JERK_Z", 5.0, 0.5, 50.0, "m/s/s/s", "Vertical jerk of shaped paths"),
)
