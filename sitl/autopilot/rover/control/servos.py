# SPDX-License-Identifier: BSD-3-Clause
"""Outputs: which function each drives (SERVOn_FUNCTION) and its pulse (SERVOn_MIN, _MAX, _TRIM, _REVERSED).

Outputs 1 .. 4 have parameters, the others are free for DO_SET_SERVO, as is an output whose function is 0. The last step
of a period turns what ``motors`` made of the demands into pulses on the outputs that have a function.
"""

from __future__ import annotations

from ....core.kernels import law
from ....core.scalars import constrain, finite
from ...state import Actuators, Radio
from ..parameters import Parameters
from ..parameters.control import ServoOutput
from .state import TEST_LEFT, TEST_RIGHT, TEST_STEERING, TEST_THROTTLE, MotorsState

OUTPUTS = 4
CHANNELS = 16
NONE, PASS_THROUGH, STEERING, RECEIVER_1, RECEIVER_16, THROTTLE, LEFT, RIGHT = 0, 1, 26, 51, 66, 70, 73, 74


@law
def function_of(params: Parameters, output: int) -> int:
    """SERVOn_FUNCTION of output 0 .. 3; 0 of the others."""
    return int(params.SERVO[output].FUNCTION) if 0 <= output < OUTPUTS else NONE


@law
def is_assigned(params: Parameters, number: int) -> bool:
    """Whether some output has this function."""
    assigned = False
    for output in range(OUTPUTS):
        assigned = assigned or function_of(params, output) == number
    return assigned


@law
def pulse(servo: ServoOutput, value: float) -> int:
    """Pulse [us] for -1 .. 1 of the travel; the part beside TRIM is cut to whole microseconds, as ArduPilot cuts it."""
    value = constrain(value, -1.0, 1.0) if finite(value) else 0.0
    if servo.REVERSED != 0.0:
        value = -value
    if value > 0.0:
        return int(servo.TRIM) + int(value * (servo.MAX - servo.TRIM))
    return int(servo.TRIM) - int(-value * (servo.TRIM - servo.MIN))


@law
def write(actuators: Actuators, output: int, width: int) -> None:
    """A pulse [us] (0: none) and the control -1 .. 1 that it is."""
    actuators.pwm[output] = width
    if width == 0:
        actuators.controls[output] = 0.0
    else:
        actuators.controls[output] = constrain((float(width) - 1500.0) / 500.0, -1.0, 1.0)


@law
def set_servo(params: Parameters, actuators: Actuators, output: int, width: int) -> bool:
    """DO_SET_SERVO: a pulse [us] on output 0 .. 15; whether it is free: a function may have it."""
    if output < 0 or output >= CHANNELS or function_of(params, output) != NONE:
        return False
    write(actuators, output, width)
    return True


@law
def is_tested(motor: int, function: int) -> bool:
    """Whether the motor test (TEST_*) drives this function."""
    return (
        (motor == TEST_THROTTLE and function == THROTTLE)
        or (motor == TEST_STEERING and function == STEERING)
        or (motor == TEST_LEFT and function == LEFT)
        or (motor == TEST_RIGHT and function == RIGHT)
    )


@law
def drives(function: int) -> bool:
    """Whether the function is a motor's."""
    return function in (THROTTLE, LEFT, RIGHT)


@law
def function_value(m: MotorsState, function: int) -> float:
    """-1 .. 1 of the travel of steering or a motor."""
    if function == STEERING:
        return m.out_steering
    if function == THROTTLE:
        return m.out_throttle
    return m.out_left if function == LEFT else m.out_right


@law
def receiver_channel(output: int, function: int) -> int:
    """Channel, from 0 on, of the receiver that an output passes on; -1 when its function is another one."""
    if function == PASS_THROUGH:
        return output
    return function - RECEIVER_1 if RECEIVER_1 <= function <= RECEIVER_16 else -1


@law
def function_pulse(m: MotorsState, function: int, silent: bool, servo: ServoOutput) -> int:
    """Pulse [us] of an output that steering or a motor drives; 0 for none. ``silent``: motors get none."""
    if m.test_pulse != 0 and is_tested(m.test_motor, function):
        return m.test_pulse
    if function != STEERING and not drives(function):
        return 0
    if drives(function) and silent:
        return 0
    return pulse(servo, function_value(m, function))


@law
def write_actuators(m: MotorsState, actuators: Actuators, rc: Radio, armed: bool, params: Parameters) -> None:
    """Pulses of the outputs that have a function; one that loses its function falls silent."""
    silent = not armed and params.MOT.SAFE_DISARM != 0.0
    for k in range(OUTPUTS):
        function = function_of(params, k)
        if function > NONE:
            channel = receiver_channel(k, function)
            width = function_pulse(m, function, silent, params.SERVO[k]) if channel < 0 else rc.channels[channel]
            write(actuators, k, width)
            m.driven[k] = 1
        elif m.driven[k] != 0:
            write(actuators, k, 0)
            m.driven[k] = 0
    actuators.armed = armed
