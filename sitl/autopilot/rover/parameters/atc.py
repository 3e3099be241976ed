# SPDX-License-Identifier: BSD-3-Clause
"""Steering-rate and speed control."""

from __future__ import annotations

from ...params.parameter import INT8, Parameter

PARAMETERS = (
    Parameter("ATC_STR_RAT_P", 0.2, 0.0, 10.0, "", "Turn-rate loop: proportional gain"),
    Parameter("ATC_STR_RAT_I", 0.2, 0.0, 10.0, "", "Turn-rate loop: integral gain"),
    Parameter("ATC_STR_RAT_D", 0.0, 0.0, 10.0, "", "Turn-rate loop: derivative gain"),
    Parameter("ATC_STR_RAT_FF", 0.2, 0.0, 10.0, "", "Turn-rate loop: steering per rad/s of the target"),
    Parameter("ATC_STR_RAT_IMAX", 1.0, 0.0, 1.0, "", "Turn-rate loop: limit of the integrator"),
    Parameter("ATC_STR_RAT_FLTT", 0.0, 0.0, 100.0, "Hz", "Turn-rate loop: low-pass of the target; 0: none"),
    Parameter("ATC_STR_RAT_FLTE", 10.0, 0.0, 100.0, "Hz", "Turn-rate loop: low-pass of the error; 0: none"),
    Parameter("ATC_STR_RAT_FLTD", 0.0, 0.0, 100.0, "Hz", "Turn-rate loop: low-pass of the derivative; 0: none"),
    Parameter("ATC_STR_RAT_PDMX", 0.0, 0.0, 1.0, "", "Turn-rate loop: limit of P and D together; 0: none"),
    Parameter("ATC_STR_RAT_D_FF", 0.0, 0.0, 1.0, "", "Turn-rate loop: feed-forward of the target's rate"),
    Parameter("ATC_SPEED_P", 0.2, 0.0, 10.0, "", "Speed loop: proportional gain"),
    Parameter("ATC_SPEED_I", 0.2, 0.0, 10.0, "", "Speed loop: integral gain"),
    Parameter("ATC_SPEED_D", 0.0, 0.0, 10.0, "", "Speed loop: derivative gain"),
    Parameter("ATC_SPEED_FF", 0.0, 0.0, 10.0, "", "Speed loop: feed-forward of the target, on top of CRUISE_THROTTLE"),
    Parameter("ATC_SPEED_IMAX", 1.0, 0.0, 1.0, "", "Speed loop: limit of the integrator"),
    Parameter("ATC_SPEED_FLTT", 0.0, 0.0, 100.0, "Hz", "Speed loop: low-pass of the target; 0: none"),
    Parameter("ATC_SPEED_FLTE", 10.0, 0.0, 100.0, "Hz", "Speed loop: low-pass of the error; 0: none"),
    Parameter("ATC_SPEED_FLTD", 0.0, 0.0, 100.0, "Hz", "Speed loop: low-pass of the derivative; 0: none"),
    Parameter("ATC_SPEED_PDMX", 0.0, 0.0, 1.0, "", "Speed loop: limit of P and D together; 0: none"),
    Parameter("ATC_SPEED_D_FF", 0.0, 0.0, 1.0, "", "Speed loop: feed-forward of the target's rate"),
    Parameter("ATC_ACCEL_MAX", 1.0, 0.0, 100.0, "m/s/s", "Fastest change of the desired speed; 0: no limit"),
    Parameter("ATC_BRAKE", 1, 0, 1, "", "1: the throttle may work against the motion to slow down", INT8),
    Parameter("ATC_STOP_SPEED", 0.1, 0.0, 10.0, "m/s", "Speed below which the vehicle counts as stopped"),
    Parameter("ATC_STR_ANG_P", 2.0, 0.0, 20.0, "1/s", "Turn rate asked for per heading error"),
    Parameter("ATC_STR_ACC_MAX", 120.0, 0.0, 1000.0, "deg/s/s", "Fastest growth of the desired turn rate; 0: no limit"),
    Parameter("ATC_STR_RAT_MAX", 120.0, 0.0, 1000.0, "deg/s", "Turn-rate limit; 0: none"),
    Parameter("ATC_DECEL_MAX", 0.0, 0.0, 100.0, "m/s/s", "Deceleration of the desired speed; 0: ATC_ACCEL_MAX"),
    Parameter("ATC_TURN_MAX_G", 0.6, 0.1, 10.0, "gravities", "Lateral acceleration that turns may need"),
    Parameter("ATC_STR_DEC_MAX", 0.0, 0.0, 1000.0, "deg/s/s", "Decay of the desired turn rate; 0: ATC_STR_ACC_MAX"),
)
