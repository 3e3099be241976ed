# SPDX-License-Identifier: BSD-3-Clause
"""Position control."""

from __future__ import annotations

from ...params.parameter import Parameter

PARAMETERS = (
    Parameter("PSC_POS_P", 0.2, 0.0, 10.0, "1/s", "Speed asked for per position error"),
    Parameter("PSC_VEL_P", 1.0, 0.0, 20.0, "1/s", "Acceleration asked for per velocity error"),
    Parameter("PSC_VEL_I", 0.0, 0.0, 20.0, "", "Velocity loop: integral gain"),
    Parameter("PSC_VEL_IMAX", 1.0, 0.0, 100.0, "m/s/s", "Velocity loop: limit of the integrator"),
    Parameter("PSC_VEL_FLTE", 5.0, 0.0, 100.0, "Hz", "Velocity loop: low-pass of the error; 0: none"),
    Parameter("PSC_VEL_D", 0.0, 0.0, 10.0, "", "Velocity loop: derivative gain"),
    Parameter("PSC_VEL_FLTD", 5.0, 0.0, 100.0, "Hz", "Velocity loop: low-pass of the derivative; 0: none"),
    Parameter("PSC_VEL_FF", 0.0, 0.0, 10.0, "", "Velocity loop: feed-forward of the target"),
)
