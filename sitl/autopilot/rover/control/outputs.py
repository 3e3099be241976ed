# SPDX-License-Identifier: BSD-3-Clause
"""The last step: what ``motors`` made of the demands, as pulses on the outputs that have a function."""

from __future__ import annotations

from ....core.kernels import law
from . import servos
from .motors import TEST_LEFT, TEST_RIGHT, TEST_STEERING, TEST_THROTTLE


@law
def _is_tested(m, function):
    motor = int(m.test_motor)
    return (
        (motor == TEST_THROTTLE and function == servos.THROTTLE)
        or (motor == TEST_STEERING and function == servos.STEERING)
        or (motor == TEST_LEFT and function == servos.LEFT)
        or (motor == TEST_RIGHT and function == servos.RIGHT)
    )


@law
def _function_pulse(ap, output, function):
    """Pulse [us] of an output with a function; 0 for none."""
    m = ap.control.motors
    if function == servos.PASS_THROUGH:
        return int(ap.rc.channels[output])
    if servos.RECEIVER_1 <= function <= servos.RECEIVER_16:
        return int(ap.rc.channels[function - servos.RECEIVER_1])
    if m.test_pulse != 0 and _is_tested(m, function):
        return int(m.test_pulse)
    if function == servos.STEERING:
        return servos.pulse(ap, output, float(m.out_steering))
    value = 0.0
    if function == servos.THROTTLE:
        value = float(m.out_throttle)
    elif function == servos.LEFT:
        value = float(m.out_left)
    elif function == servos.RIGHT:
        value = float(m.out_right)
    else:
        return 0
    if ap.arming.armed == 0 and ap.params.MOT.SAFE_DISARM != 0.0:
        return 0
    return servos.pulse(ap, output, value)


@law
def write_actuators(ap, actuators):
    """Pulses of the outputs that have a function; one that loses its function falls silent."""
    m = ap.control.motors
    for k in range(servos.OUTPUTS):
        function = servos.function(ap, k)
        if function > servos.NONE:
            servos.write(actuators, k, _function_pulse(ap, k, function))
            m.driven[k] = 1
        elif m.driven[k] != 0:
            servos.write(actuators, k, 0)
            m.driven[k] = 0
    actuators.armed = ap.arming.armed
