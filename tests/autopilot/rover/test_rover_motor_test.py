# SPDX-License-Identifier: BSD-3-Clause
"""Motor test: one output works for a while."""

from __future__ import annotations

import math

import pytest

from sitl.autopilot.events import MOTOR_TEST
from sitl.autopilot.rover import arming, motor_test
from sitl.autopilot.rover.modes.rtl import RTL
from sitl.autopilot.rover.modes.set_mode import request
from tests.autopilot.rover.modes.driven_rover import Rover

THROTTLE, STEERING, LEFT = 1, 2, 3


@pytest.mark.parametrize(("motor", "output", "other"), [(THROTTLE, 2, 0), (STEERING, 0, 2)])
def test_one_output_moves_and_rests_again(motor: int, output: int, other: int) -> None:
    rover = Rover()
    assert motor_test.start(rover.v, motor, 0.2, 0, 2.0) == motor_test.OK
    rover.run(1.0)
    assert rover.ap.arming.armed == 1
    assert [int(rover.v.actuators.pwm[k]) for k in (output, other)] == [1600, 1500]
    rover.run(1.2)
    assert rover.ap.arming.armed == 0
    assert int(rover.v.actuators.pwm[output]) == 1500
    assert [a for code, a, _ in rover.events() if code == MOTOR_TEST] == [1.0, 0.0]


def test_a_pulse_instead() -> None:
    rover = Rover()
    assert motor_test.start(rover.v, THROTTLE, 0.0, 1650, 2.0) == motor_test.OK
    rover.run(0.1)
    assert int(rover.v.actuators.pwm[2]) == 1650


@pytest.mark.parametrize("pulse", [-1, 1, 799, 2201])
def test_a_pulse_that_is_none(pulse: int) -> None:
    rover = Rover()
    assert motor_test.start(rover.v, THROTTLE, 0.0, pulse, 2.0) == motor_test.BAD_THROTTLE
    assert rover.ap.arming.armed == 0


def test_needs_the_arming_checks() -> None:
    rover = Rover()
    request(rover.v, RTL, 2)
    assert motor_test.start(rover.v, THROTTLE, 0.2, 0, 2.0) == motor_test.NOT_ARMABLE
    assert rover.texts() == ["Arm: Mode not armable"]


@pytest.mark.parametrize(
    ("motor", "throttle", "seconds", "answer"),
    [
        (0, 0.2, 1.0, motor_test.BAD_MOTOR),
        (LEFT, 0.2, 1.0, motor_test.BAD_MOTOR),
        (THROTTLE, 1.1, 1.0, motor_test.BAD_THROTTLE),
        (THROTTLE, math.nan, 1.0, motor_test.BAD_THROTTLE),
        (THROTTLE, 0.2, -1.0, motor_test.BAD_TIME),
        (THROTTLE, 0.2, math.nan, motor_test.BAD_TIME),
    ],
)
def test_refusals_change_nothing(motor: int, throttle: float, seconds: float, answer: int) -> None:
    rover = Rover()
    before = bytes(rover.v._bytes)
    assert motor_test.start(rover.v, motor, throttle, 0, seconds) == answer
    assert bytes(rover.v._bytes) == before


def test_disarming_ends_it() -> None:
    rover = Rover()
    motor_test.start(rover.v, THROTTLE, 0.2, 0, 20.0)
    rover.run(0.5)
    arming.disarm(rover.v, 1, False)
    rover.run(0.1)
    assert int(rover.v.actuators.pwm[2]) == 1500
    assert not motor_test.is_running(rover.ap.control.motors)
