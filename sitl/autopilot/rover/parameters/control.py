# SPDX-License-Identifier: BSD-3-Clause
"""Parameters of the rover's controllers, motors and servos."""

from __future__ import annotations

from ...params.gains import BasicPidGains, PidGains
from ...params.parameter import INT8, INT16, ParameterGroup, group, param


class LoopGains(PidGains):
    """A loop of steering or speed: the firmware's own ranges and defaults."""

    P: float = param(0.2, 0.0, 10.0, "", "proportional gain")
    I: float = param(0.2, 0.0, 10.0, "", "integral gain")  # noqa: E741
    D: float = param(0.0, 0.0, 10.0, "", "derivative gain")
    FF: float = param(0.0, 0.0, 10.0, "", "feed-forward of the target")
    IMAX: float = param(1.0, 0.0, 1.0, "", "limit of the integrator")
    FLTT: float = param(0.0, 0.0, 100.0, "Hz", "low-pass of the target; 0: none")
    FLTE: float = param(10.0, 0.0, 100.0, "Hz", "low-pass of the error; 0: none")
    FLTD: float = param(0.0, 0.0, 100.0, "Hz", "low-pass of the derivative; 0: none")
    PDMX: float = param(0.0, 0.0, 1.0, "", "limit of P and D together; 0: none")
    D_FF: float = param(0.0, 0.0, 1.0, "", "feed-forward of the target's rate")


class Attitude(ParameterGroup):
    """ATC_: steering and speed control."""

    STR_RAT: LoopGains = group(
        "Turn-rate loop", FF={"default": 0.2, "doc": "Turn-rate loop: steering per rad/s of the target"}
    )
    SPEED: LoopGains = group(
        "Speed loop", FF={"doc": "Speed loop: feed-forward of the target, on top of CRUISE_THROTTLE"}
    )
    ACCEL_MAX: float = param(1.0, 0.0, 100.0, "m/s/s", "Fastest change of the desired speed; 0: no limit")
    BRAKE: float = param(1, 0, 1, "", "1: the throttle may work against the motion to slow down", INT8)
    STOP_SPEED: float = param(0.1, 0.0, 10.0, "m/s", "Speed below which the vehicle counts as stopped")
    STR_ANG_P: float = param(2.0, 0.0, 20.0, "1/s", "Turn rate asked for per heading error")
    STR_ACC_MAX: float = param(120.0, 0.0, 1000.0, "deg/s/s", "Fastest growth of the desired turn rate; 0: no limit")
    STR_RAT_MAX: float = param(120.0, 0.0, 1000.0, "deg/s", "Turn-rate limit; 0: none")
    DECEL_MAX: float = param(0.0, 0.0, 100.0, "m/s/s", "Deceleration of the desired speed; 0: ATC_ACCEL_MAX")
    TURN_MAX_G: float = param(0.6, 0.1, 10.0, "gravities", "Lateral acceleration that turns may need")
    STR_DEC_MAX: float = param(0.0, 0.0, 1000.0, "deg/s/s", "Decay of the desired turn rate; 0: ATC_STR_ACC_MAX")


class Position(ParameterGroup):
    """PSC_: position control."""

    POS_P: float = param(0.2, 0.0, 10.0, "1/s", "Speed asked for per position error")
    VEL: BasicPidGains = group(
        "Velocity loop",
        P={"default": 1.0, "doc": "Acceleration asked for per velocity error"},
        I=0.0,
        IMAX={"default": 1.0, "high": 100.0, "unit": "m/s/s"},
        FLTE={"high": 100.0},
        D=0.0,
        FLTD={"high": 100.0},
    )


class Motors(ParameterGroup):
    """MOT_: motors."""

    SAFE_DISARM: float = param(0, 0, 1, "", "1: no pulses to the motors while disarmed; 0: SERVOn_TRIM", INT8)
    THR_MIN: float = param(0, 0, 20, "%", "Throttle at which the motors begin to turn", INT8)
    THR_MAX: float = param(100, 5, 100, "%", "Throttle limit", INT8)
    SLEWRATE: float = param(100, 0, 1000, "%/s", "Fastest change of the throttle; 0: no limit", INT16)
    THST_EXPO: float = param(0.0, -1.0, 1.0, "", "Curve of thrust over command: 0 linear, 1 quadratic")
    SPD_SCA_BASE: float = param(1.0, 0.0, 10.0, "m/s", "Speed above which steering shrinks with speed; 0: never")
    STR_THR_MIX: float = param(0.5, 0.2, 1.0, "", "Skid steering used up: 0.5 shares, above favours steering")
    THST_ASYM: float = param(1.0, 1.0, 10.0, "", "Skid steering: forward thrust over backward thrust")
    REV_DELAY: float = param(0.0, 0.0, 1.0, "s", "Pause at zero when a motor changes direction")


class ServoOutput(ParameterGroup):
    """SERVOn_: an output.

    FUNCTION (ArduPilot's numbers): 0 none (free for DO_SET_SERVO), 1 the same channel of the receiver, 26 steering,
    51 .. 66 channel 1 .. 16 of the receiver, 70 throttle, 73 and 74 left and right motor of a skid-steered vehicle.
    """

    MIN: float = param(1100, 800, 2200, "us", "Shortest pulse of output {n}", INT16)
    MAX: float = param(1900, 800, 2200, "us", "Longest pulse of output {n}", INT16)
    TRIM: float = param(1500, 800, 2200, "us", "Pulse of output {n} at rest", INT16)
    REVERSED: float = param(0, 0, 1, "", "Output {n} works the other way round", INT8)
    FUNCTION: float = param(26, -1, 300, "", "What output {n} does", INT16)


class WheelEncoder(ParameterGroup):
    """WENC_: encoders of vehicles whose airframe has none; from the next boot on."""

    TYPE: float = param(0, 0, 10, "", "10: simulated encoders on the driven wheels; 0 none", INT8)
    CPR: float = param(3200, 1, 32767, "", "Counts a turn of the wheel", INT16)
    RADIUS: float = param(0.05, 0.001, 100.0, "m", "Of the wheel, with which counts become a distance")


class SecondEncoder(ParameterGroup):
    """WENC2_: that of the right wheel."""

    TYPE: float = param(0, 0, 10, "", "10: WHEEL_DISTANCE tells of the right wheel, too; 0 not", INT8)
