# SPDX-License-Identifier: BSD-3-Clause
"""Arming as a recorded ArduRover answers, and the motor test: one output works for a while."""

from __future__ import annotations

import math

import pytest

from sitl.autopilot.rover import arming, motor_test
from sitl.autopilot.rover.modes.auto import AUTO
from sitl.autopilot.rover.modes.guided import GUIDED
from sitl.autopilot.rover.modes.hold import HOLD
from sitl.autopilot.rover.modes.manual import MANUAL
from sitl.autopilot.rover.modes.rtl import RTL
from sitl.autopilot.rover.modes.set_mode import request
from sitl.autopilot.rover.motor_test import MOTOR_TEST
from tests.autopilot.rover.modes.driven_rover import Rover


def refused(rover: Rover, method: int = 1) -> list[str]:
    ok, texts = arming.arm(rover.v, method, False)
    assert not ok
    return texts


@pytest.mark.parametrize("mode", [MANUAL, HOLD])
def test_arms_without_a_position_where_none_is_needed(mode: int) -> None:
    rover = Rover()
    rover.set_estimate(False)
    request(rover.v, mode, 2)
    rover.arm()
    assert rover.texts() == ["Throttle armed"]


def test_guided_needs_a_position_unless_forced() -> None:
    rover = Rover()
    rover.set_estimate(False)
    rover.v.sensors.gps_fix = 3
    request(rover.v, GUIDED, 2)
    assert refused(rover) == ["Arm: AHRS: not using configured AHRS type"]
    assert arming.arm(rover.v, 1, True) == (True, [])


def test_sensors_must_agree_for_a_while_after_boot() -> None:
    rover = Rover()
    rover.v.time_us = 12_000_000
    assert refused(rover) == ["Arm: Accels inconsistent"]
    rover.v.time_us = 14_000_000
    assert refused(rover) == ["Arm: Gyros inconsistent"]
    rover.v.time_us = 24_000_000
    rover.arm()


def test_not_on_the_way_home() -> None:
    rover = Rover()
    assert request(rover.v, RTL, 2) == 0
    assert refused(rover) == ["Arm: Mode not armable"]


def test_throttle_must_be_at_rest() -> None:
    rover = Rover()
    rover.sticks(throttle=1800)
    rover.run(0.1)
    assert refused(rover) == ["Arm: Throttle (RC3) is not neutral"]


def test_arming_check_0_skips_everything() -> None:
    rover = Rover(ARMING_CHECK=0.0)
    request(rover.v, GUIDED, 2)
    rover.set_estimate(False)
    rover.sticks(throttle=1800)
    rover.run(0.1)
    rover.arm()
    assert rover.v.autopilot.arming.armed


def test_a_driving_rover_is_disarmed_by_command_but_not_by_stick() -> None:
    rover = Rover().arm()
    rover.sticks(throttle=1700)
    rover.run(2.0)
    assert rover.speed > 1.0
    assert arming.disarm(rover.v, 0, 0) == 0
    rover.v.autopilot.arming.auto_armed, rover.v.autopilot.arming.crash_ticks = True, 5
    assert arming.disarm(rover.v, 1, 0) == 1
    assert rover.texts()[-1] == "Throttle disarmed"
    state = rover.v.autopilot.arming
    assert (state.armed, state.auto_armed, state.landed, state.crash_ticks) == (False, False, True, 0)


def test_steering_stick_arms_and_disarms_after_two_seconds() -> None:
    rover = Rover()
    rover.sticks(steering=2000)
    rover.run(1.9)
    assert rover.ap.arming.armed == 0
    rover.run(0.3)
    assert rover.ap.arming.armed == 1
    rover.sticks(steering=1000)
    rover.run(2.2)
    assert rover.ap.arming.armed == 0


def test_no_stick_arming_in_autopilot_modes() -> None:
    rover = Rover()
    request(rover.v, GUIDED, 2)
    rover.sticks(steering=2000)
    rover.run(2.5)
    assert rover.ap.arming.armed == 0


def test_home_follows_until_armed_and_unlocked() -> None:
    rover = Rover()
    rover.run(1.1)
    rover.place(3.0, 4.0)
    rover.run(1.1)
    assert tuple(rover.ap.home.pos[:2]) == pytest.approx((3.0, 4.0))
    rover.arm()
    rover.place(8.0, 8.0)
    rover.run(1.1)
    assert tuple(rover.ap.home.pos[:2]) == pytest.approx((3.0, 4.0))


def test_auto_needs_a_mission_even_disarmed() -> None:
    rover = Rover()
    assert request(rover.v, AUTO, 2) != 0
    assert rover.texts() == ["No Mission. Can't set AUTO.", "Flight mode change failed"]
    assert rover.ap.modes.number == MANUAL


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
    ("motor", "throttle", "answer"),
    [
        (0, 0.2, motor_test.BAD_MOTOR),
        (LEFT, 0.2, motor_test.BAD_MOTOR),
        (THROTTLE, 1.1, motor_test.BAD_THROTTLE),
        (THROTTLE, math.nan, motor_test.BAD_THROTTLE),
    ],
)
def test_a_test_that_cannot_be_leaves_it_disarmed(motor: int, throttle: float, answer: int) -> None:
    rover = Rover()
    assert motor_test.start(rover.v, motor, throttle, 0, 1.0) == answer
    assert not rover.ap.arming.armed and not motor_test.is_running(rover.ap.control.motors)


@pytest.mark.parametrize("seconds", [-1.0, 0.0])
def test_a_test_without_time_is_over_at_once(seconds: float) -> None:
    rover = Rover()
    assert motor_test.start(rover.v, THROTTLE, 0.2, 0, seconds) == motor_test.OK
    rover.run(0.1)
    assert not rover.ap.arming.armed


def test_disarming_ends_it() -> None:
    rover = Rover()
    motor_test.start(rover.v, THROTTLE, 0.2, 0, 20.0)
    rover.run(0.5)
    arming.disarm(rover.v, 1, False)
    rover.run(0.1)
    assert int(rover.v.actuators.pwm[2]) == 1500
    assert not motor_test.is_running(rover.ap.control.motors)
