# SPDX-License-Identifier: BSD-3-Clause
"""Outputs: which function each drives (SERVOn_FUNCTION) and its pulse (SERVOn_MIN, _MAX, _TRIM, _REVERSED).

Outputs 1 .. 4 have parameters, the others are free for DO_SET_SERVO, as is an output whose function is 0.
"""

from __future__ import annotations

from ....core.kernels import law
from ....core.scalars import constrain, finite

OUTPUTS = 4
CHANNELS = 16
NONE, PASS_THROUGH, STEERING, RECEIVER_1, RECEIVER_16, THROTTLE, LEFT, RIGHT = 0, 1, 26, 51, 66, 70, 73, 74


@law
def function(ap, output):
    """SERVOn_FUNCTION of output 0 .. 3; 0 of the others."""
    p = ap.params
    if output == 0:
        return int(p.SERVO[0].FUNCTION)
    if output == 1:
        return int(p.SERVO[1].FUNCTION)
    if output == 2:
        return int(p.SERVO[2].FUNCTION)
    if output == 3:
        return int(p.SERVO[3].FUNCTION)
    return NONE


@law
def travel(ap, output):
    """(MIN, TRIM, MAX) [us] and REVERSED of output 0 .. 3."""
    p = ap.params
    if output == 0:
        return (float(p.SERVO[0].MIN), float(p.SERVO[0].TRIM), float(p.SERVO[0].MAX), float(p.SERVO[0].REVERSED))
    if output == 1:
        return (float(p.SERVO[1].MIN), float(p.SERVO[1].TRIM), float(p.SERVO[1].MAX), float(p.SERVO[1].REVERSED))
    if output == 2:
        return (float(p.SERVO[2].MIN), float(p.SERVO[2].TRIM), float(p.SERVO[2].MAX), float(p.SERVO[2].REVERSED))
    return (float(p.SERVO[3].MIN), float(p.SERVO[3].TRIM), float(p.SERVO[3].MAX), float(p.SERVO[3].REVERSED))


@law
def is_assigned(ap, number):
    """Whether some output has this function."""
    p = ap.params
    return (
        int(p.SERVO[0].FUNCTION) == number
        or int(p.SERVO[1].FUNCTION) == number
        or int(p.SERVO[2].FUNCTION) == number
        or int(p.SERVO[3].FUNCTION) == number
    )


@law
def pulse(ap, output, value):
    """Pulse [us] for -1 .. 1 of the travel; the part beside TRIM is cut to whole microseconds, as ArduPilot cuts it."""
    least, trim, most, is_reversed = travel(ap, output)
    value = constrain(value, -1.0, 1.0) if finite(value) else 0.0
    if is_reversed != 0.0:
        value = -value
    if value > 0.0:
        return int(trim) + int(value * (most - trim))
    return int(trim) - int(-value * (trim - least))


@law
def write(actuators, output, width):
    """A pulse [us] (0: none) and the control -1 .. 1 that it is."""
    actuators.pwm[output] = width
    if width == 0:
        actuators.controls[output] = 0.0
    else:
        actuators.controls[output] = constrain((float(width) - 1500.0) / 500.0, -1.0, 1.0)


@law
def set_servo(v, output, width):
    """DO_SET_SERVO: a pulse [us] on output 0 .. 15; 0 when a function has that output."""
    if output < 0 or output >= CHANNELS or function(v.autopilot, output) != NONE:
        return 0
    write(v.actuators, output, width)
    return 1
