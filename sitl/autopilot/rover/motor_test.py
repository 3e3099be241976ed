# SPDX-License-Identifier: BSD-3-Clause
"""Motor test (MAV_CMD_DO_MOTOR_TEST): one output works for a while, all others rest.

As in ArduRover the vehicle is armed for it, with all arming checks, and radio, GCS and crash checks wait meanwhile.
``control.motors`` drives the output, the modes stand aside. The test ends by itself, or with a disarming.
"""

from __future__ import annotations

from ...core.kernels import law
from ...core.scalars import constrain
from ..arming_checks import ArmingMethod
from ..events import Event, Events, emit
from ..state import Arming
from .arming import set_disarmed, try_arm
from .control.motors import is_skid
from .control.state import TEST_RIGHT, TEST_THROTTLE, MotorsState
from .state import Vehicle

SECONDS_MAX = 30.0
PULSE_MIN, PULSE_MAX = 800, 2200
"""[us]; ArduPilot takes shorter ones, too, which no servo understands."""

MOTOR_TEST = Event(21)  # a: 1 begins, 0 has ended; b: motor

# Answers of start()
OK = 0
NOT_ARMABLE = 1
BAD_MOTOR = 2
BAD_THROTTLE = 3
STEERING = 2


@law
def refusal(skid: bool, motor: int, throttle: float, pulse: int) -> int:
    """OK, or why no vehicle, skid-steered or not, can be tested so."""
    if motor < TEST_THROTTLE or motor > TEST_RIGHT or skid != (motor > 2):
        return BAD_MOTOR
    if not -1.0 <= throttle <= 1.0 or (pulse != 0 and not PULSE_MIN <= pulse <= PULSE_MAX):
        return BAD_THROTTLE
    return OK


def start(v: Vehicle, motor: int, throttle: float, pulse: int, seconds: float) -> int:
    """Drive an output: motor 1 throttle, 2 steering, 3 left, 4 right (MOTOR_TEST_ORDER). OK, or why not.

    Args:
        v: the vehicle.
        motor: 1 .. 4; left and right only of a skid-steered vehicle, throttle and steering only of a car.
        throttle: -1 .. 1.
        pulse: pulse to give instead [us], 0 for ``throttle``.
        seconds: at most 30 are given.
    """
    ap = v.autopilot
    motors = ap.control.motors
    if not is_running(motors) and not ap.arming.armed and try_arm(v, ArmingMethod.MOTOR_TEST, False) != 0:
        return NOT_ARMABLE
    cause = refusal(is_skid(ap.params), motor, throttle, pulse)
    if cause != OK:
        set_disarmed(ap.arming, ap.events, v.time_us, ArmingMethod.MOTOR_TEST)
        return cause
    if not is_running(motors):
        emit(ap.events, v.time_us, MOTOR_TEST, 1.0, float(motor))
    motors.test_motor = motor
    motors.test_value = throttle
    motors.test_pulse = pulse
    motors.test_until_us = v.time_us + int(constrain(seconds, 0.0, SECONDS_MAX) * 1e6)
    return OK


@law
def is_running(motors: MotorsState) -> bool:
    """Whether a test is under way."""
    return motors.test_motor != 0


@law
def control(motors: MotorsState, arming: Arming, events: Events, time_us: int) -> None:
    """Every period, behind the mode: keep the mode's hands off the motors; end in time."""
    if not is_running(motors):
        return
    motors.throttle = 0.0
    motors.steering = 0.0
    if time_us >= motors.test_until_us or not arming.armed:
        motors.test_motor = 0
        motors.test_pulse = 0
        emit(events, time_us, MOTOR_TEST, 0.0, 0.0)
        set_disarmed(arming, events, time_us, ArmingMethod.MOTOR_TEST)
