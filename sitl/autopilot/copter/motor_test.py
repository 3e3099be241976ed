# SPDX-License-Identifier: BSD-3-Clause
"""Motor test (MAV_CMD_DO_MOTOR_TEST): one motor turns for a while on the ground.

The vehicle counts as armed meanwhile, as in ArduPilot; ``control.motors`` drives the motor, the modes stand
aside. The test ends by itself, or with a disarming.
"""

from __future__ import annotations

from ...core.kernels import inlined
from ...core.mavlink import MavSeverity
from ...core.scalars import constrain
from ..arming_checks import ArmingMethod
from ..events import Event, emit
from ..state import Arming
from .control.spool import DesiredSpoolState
from .control.state import MotorsState
from .modes import ground
from .state import Vehicle

LONGEST_S = 600.0

MOTOR_TEST = Event(21, MavSeverity.INFO, {0: "finished motor test", 1: "starting motor test"})  # b: motor

# Answers of start()
OK = 0
NOT_LANDED = 1
BAD_MOTOR = 2
BAD_THROTTLE = 3


def refusal(motors: MotorsState, arming: Arming, motor: int, throttle: float) -> int:
    """OK, or why motor 0 .. is not turned so."""
    if not arming.landed:
        return NOT_LANDED
    if motor < 0 or motor >= motors.count:
        return BAD_MOTOR
    return OK if 0.0 <= throttle <= 1.0 else BAD_THROTTLE


def start(v: Vehicle, motor: int, throttle: float, seconds: float) -> int:
    """Turn motor 0 .. at ``throttle`` (0 .. 1 of the pulse range) for ``seconds``, at most 600. OK, or why not.

    A test under way goes on with the new motor, throttle and time; a vehicle that was armed is disarmed afterwards.
    """
    ap = v.autopilot
    motors = ap.control.motors
    cause = refusal(motors, ap.arming, motor, throttle)
    if cause != OK:
        return cause
    if motors.test_motor == 0:
        emit(ap.events, v.time_us, MOTOR_TEST, 1.0, float(motor + 1))
    motors.test_motor = motor + 1
    motors.test_actuator = throttle
    motors.test_until_us = v.time_us + int(constrain(seconds, 0.0, LONGEST_S) * 1e6)
    ap.arming.armed = True
    ap.arming.armed_us = v.time_us
    return OK


def end(v: Vehicle) -> None:
    """A test under way ends with the next tick."""
    v.autopilot.control.motors.test_until_us = v.time_us


@inlined
def run(v: Vehicle) -> None:
    """Every tick of a test, behind the mode: keep the mode's hands off the motors; end in time."""
    ap = v.autopilot
    motors = ap.control.motors
    if motors.test_motor == 0:
        return
    motors.desired_spool = DesiredSpoolState.SHUT_DOWN
    ap.arming.auto_armed = False
    ap.arming.idle_us = v.time_us
    if v.time_us >= motors.test_until_us or not ap.arming.landed or not ap.arming.armed:
        motors.test_motor = 0
        emit(ap.events, v.time_us, MOTOR_TEST, 0.0, 0.0)
        ground.disarm(v, ArmingMethod.MOTOR_TEST)
