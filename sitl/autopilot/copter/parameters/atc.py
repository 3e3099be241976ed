# SPDX-License-Identifier: BSD-3-Clause
"""Attitude and rate control."""

from __future__ import annotations

from ..parameter import INT8, Parameter

PARAMETERS = (
    Parameter(
        "ATC_SLEW_YAW",
        6000.0,
        0,
        36000,
        "cdeg/s",
        "Fastest turn of modes that fly by themselves; 0: no limit",
    ),
    Parameter(
        "ATC_ACCEL_Y_MAX", 27000.0, 0, 180000, "cdeg/s/s", "Yaw acceleration of shaped targets; 0: no limit"
    ),
    Parameter(
        "ATC_RATE_FF_ENAB", 1, 0, 1, "", "1: shape attitude targets and feed their rates forward", INT8
    ),
    Parameter(
        "ATC_ACCEL_R_MAX", 110000.0, 0, 360000, "cdeg/s/s", "Roll acceleration of shaped targets; 0: no limit"
    ),
    Parameter(
        "ATC_ACCEL_P_MAX",
        110000.0,
        0,
        360000,
        "cdeg/s/s",
        "Pitch acceleration of shaped targets; 0: no limit",
    ),
    Parameter("ATC_ANGLE_BOOST", 1, 0, 1, "", "1: raise the throttle with the lean so that lift stays", INT8),
    Parameter("ATC_ANG_RLL_P", 4.5, 0.0, 30.0, "1/s", "Roll rate asked for per roll error"),
    Parameter("ATC_ANG_PIT_P", 4.5, 0.0, 30.0, "1/s", "Pitch rate asked for per pitch error"),
    Parameter("ATC_ANG_YAW_P", 4.5, 0.0, 30.0, "1/s", "Yaw rate asked for per heading error"),
    Parameter("ATC_ANG_LIM_TC", 1.0, 0.0, 60.0, "s", "Time constant of the lean limit that keeps altitude"),
    Parameter("ATC_RATE_R_MAX", 0.0, 0, 1080, "deg/s", "Roll rate limit; 0: none"),
    Parameter("ATC_RATE_P_MAX", 0.0, 0, 1080, "deg/s", "Pitch rate limit; 0: none"),
    Parameter("ATC_RATE_Y_MAX", 0.0, 0, 1080, "deg/s", "Yaw rate limit; 0: none"),
    Parameter(
        "ATC_INPUT_TC", 0.15, 0.0, 2.0, "s", "Time constant of shaped attitude: small is crisp, large is soft"
    ),
    Parameter("ATC_RAT_RLL_P", 0.135, 0.0, 5.0, "", "Roll rate loop: proportional gain"),
    Parameter("ATC_RAT_RLL_I", 0.135, 0.0, 10.0, "", "Roll rate loop: integral gain"),
    Parameter("ATC_RAT_RLL_D", 0.0036, 0.0, 1.0, "", "Roll rate loop: derivative gain"),
    Parameter("ATC_RAT_RLL_FF", 0.0, 0.0, 5.0, "", "Roll rate loop: feed-forward of the target"),
    Parameter("ATC_RAT_RLL_IMAX", 0.5, 0.0, 1.0, "", "Roll rate loop: limit of the integrator"),
    Parameter("ATC_RAT_RLL_FLTT", 20.0, 0.0, 400.0, "Hz", "Roll rate loop: low-pass of the target; 0: none"),
    Parameter("ATC_RAT_RLL_FLTE", 0.0, 0.0, 400.0, "Hz", "Roll rate loop: low-pass of the error; 0: none"),
    Parameter(
        "ATC_RAT_RLL_FLTD", 20.0, 0.0, 400.0, "Hz", "Roll rate loop: low-pass of the derivative; 0: none"
    ),
    Parameter("ATC_RAT_RLL_PDMX", 0.0, 0.0, 1.0, "", "Roll rate loop: limit of P and D together; 0: none"),
    Parameter("ATC_RAT_RLL_D_FF", 0.0, 0.0, 1.0, "", "Roll rate loop: feed-forward of the target's rate"),
    Parameter("ATC_RAT_PIT_P", 0.135, 0.0, 5.0, "", "Pitch rate loop: proportional gain"),
    Parameter("ATC_RAT_PIT_I", 0.135, 0.0, 10.0, "", "Pitch rate loop: integral gain"),
    Parameter("ATC_RAT_PIT_D", 0.0036, 0.0, 1.0, "", "Pitch rate loop: derivative gain"),
    Parameter("ATC_RAT_PIT_FF", 0.0, 0.0, 5.0, "", "Pitch rate loop: feed-forward of the target"),
    Parameter("ATC_RAT_PIT_IMAX", 0.5, 0.0, 1.0, "", "Pitch rate loop: limit of the integrator"),
    Parameter("ATC_RAT_PIT_FLTT", 20.0, 0.0, 400.0, "Hz", "Pitch rate loop: low-pass of the target; 0: none"),
    Parameter("ATC_RAT_PIT_FLTE", 0.0, 0.0, 400.0, "Hz", "Pitch rate loop: low-pass of the error; 0: none"),
    Parameter(
        "ATC_RAT_PIT_FLTD", 20.0, 0.0, 400.0, "Hz", "Pitch rate loop: low-pass of the derivative; 0: none"
    ),
    Parameter("ATC_RAT_PIT_PDMX", 0.0, 0.0, 1.0, "", "Pitch rate loop: limit of P and D together; 0: none"),
    Parameter("ATC_RAT_PIT_D_FF", 0.0, 0.0, 1.0, "", "Pitch rate loop: feed-forward of the target's rate"),
    Parameter("ATC_RAT_YAW_P", 0.18, 0.0, 5.0, "", "Yaw rate loop: proportional gain"),
    Parameter("ATC_RAT_YAW_I", 0.018, 0.0, 10.0, "", "Yaw rate loop: integral gain"),
    Parameter("ATC_RAT_YAW_D", 0.0, 0.0, 1.0, "", "Yaw rate loop: derivative gain"),
    Parameter("ATC_RAT_YAW_FF", 0.0, 0.0, 5.0, "", "Yaw rate loop: feed-forward of the target"),
    Parameter("ATC_RAT_YAW_IMAX", 0.5, 0.0, 1.0, "", "Yaw rate loop: limit of the integrator"),
    Parameter("ATC_RAT_YAW_FLTT", 20.0, 0.0, 400.0, "Hz", "Yaw rate loop: low-pass of the target; 0: none"),
    Parameter("ATC_RAT_YAW_FLTE", 2.5, 0.0, 400.0, "Hz", "Yaw rate loop: low-pass of the error; 0: none"),
    Parameter(
        "ATC_RAT_YAW_FLTD", 20.0, 0.0, 400.0, "Hz", "Yaw rate loop: low-pass of the derivative; 0: none"
    ),
    Parameter("ATC_RAT_YAW_PDMX", 0.0, 0.0, 1.0, "", "Yaw rate loop: limit of P and D together; 0: none"),
    Parameter("ATC_RAT_YAW_D_FF", 0.0, 0.0, 1.0, "", "Yaw rate loop: feed-forward of the target's rate"),
    Parameter("ATC_THR_MIX_MIN", 0.1, 0.1, 0.25, "", "Priority of attitude over throttle while landing"),
    Parameter("ATC_THR_MIX_MAX", 0.5, 0.1, 0.9, "", "Priority of attitude over throttle in flight"),
    Parameter(
        "ATC_THR_MIX_MAN",
        0.1,
        0.1,
        5.0,
        "",
        "Priority of attitude over throttle with throttle in the pilot's hand",
    ),
)
