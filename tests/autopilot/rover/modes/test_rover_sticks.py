# SPDX-License-Identifier: BSD-3-Clause
"""What the sticks do in the modes that a pilot drives."""

from __future__ import annotations

import math

import pytest

from sitl.autopilot.rover import arming, pilot
from sitl.autopilot.rover.modes import steering
from sitl.autopilot.rover.modes.acro import ACRO
from sitl.autopilot.rover.modes.hold import HOLD
from sitl.autopilot.rover.modes.manual import MANUAL
from sitl.autopilot.rover.modes.rtl import RTL
from sitl.autopilot.rover.modes.set_mode import request
from sitl.autopilot.rover.modes.simple import SIMPLE
from sitl.autopilot.rover.modes.state import PilotState
from sitl.autopilot.rover.modes.steering import STEERING
from tests.autopilot.rover.modes.driven_rover import Rover


def in_mode(mode: int, **params: float) -> Rover:
    rover = Rover(**params).arm()
    assert request(rover.v, mode, 1) == 0
    return rover


def test_manual_is_steering_and_throttle() -> None:
    rover = in_mode(MANUAL, MOT_SLEWRATE=0.0)
    rover.sticks(steering=1700, throttle=1765)
    rover.run(0.1)
    pwm = rover.v.actuators.pwm
    assert int(pwm[2]) == pytest.approx(1500 + 500 * (765 - 500 - 30) / 470, abs=1)
    assert int(pwm[0]) == pytest.approx(1500 + 500 * (700 - 500 - 30) / 470, abs=1)


def test_manual_steering_shrinks_with_speed_only_when_told() -> None:
    pulses = []
    for options in (0.0, 1.0):
        rover = in_mode(MANUAL, MANUAL_OPTIONS=options)
        rover.place(0.0, 0.0, 0.0, 5.0)
        rover.sticks(steering=2000, throttle=1600)
        rover.run(0.1)
        pulses.append(int(rover.v.actuators.pwm[0]))
    assert pulses[0] == 2000
    assert 1550 < pulses[1] < 1700


def test_steering_expo_softens_the_middle() -> None:
    rover = in_mode(MANUAL, MANUAL_STR_EXPO=0.5)
    rover.sticks(steering=1765)
    rover.run(0.1)
    assert 1500 < int(rover.v.actuators.pwm[0]) < 1700


@pytest.mark.parametrize(
    ("kind", "sticks", "wanted"),
    [
        (0, (1750, 1750), (0.4681, 0.46)),
        (0, (1750, 1250), (-0.4681, -0.46)),
        (2, (1750, 1250), (-0.4681, -0.46)),
        (3, (1750, 1250), (0.4681, -0.46)),  # throttle in whole percent
        (1, (1750, 1750), (0.0, 0.5)),
        (1, (1750, 1250), (0.5, 0.0)),
    ],
)
def test_pilot_steer_type(kind: int, sticks: tuple[int, int], wanted: tuple[float, float]) -> None:
    rover = Rover(PILOT_STEER_TYPE=float(kind))
    rover.sticks(*sticks)
    rover.run(0.04)
    assert pilot.sticks(rover.ap.modes.pilot, rover.ap.params) == pytest.approx(wanted, abs=1e-4)


def test_hold_does_nothing() -> None:
    rover = in_mode(HOLD)
    rover.place(0.0, 0.0, 0.0, 2.0)
    rover.sticks(steering=2000, throttle=2000)
    rover.run(1.0)
    assert list(rover.v.actuators.pwm[[0, 2]]) == [1500, 1500]


def test_acro_stick_is_a_turn_rate() -> None:
    rover = in_mode(ACRO, ACRO_TURN_RATE=60.0)
    rover.sticks(throttle=1600)
    rover.run(8.0)
    rover.sticks(steering=1765)
    rover.run(5.0)
    assert float(rover.ap.estimate.rates[2]) == pytest.approx(math.radians(30.0), rel=0.05)


def test_acro_and_steering_drive_a_speed() -> None:
    for mode in (ACRO, STEERING):
        rover = in_mode(mode)
        rover.sticks(throttle=1500 + 30 + 94)  # a fifth of 5 m/s / 30 %
        rover.run(12.0)
        assert rover.speed == pytest.approx(0.2 * 5.0 / 0.3, rel=0.03)
        assert abs(rover.heading) < 1e-6


def test_steering_full_stick_is_the_tightest_turn() -> None:
    for speed, accel in ((1.0, 0.5), (10.0, 5.9), (0.0, 0.1)):
        assert steering.full_stick_accel(speed, 2.0, 5.9) == pytest.approx(accel)


def test_steering_turns_right_forwards_and_backwards() -> None:
    for throttle in (1600, 1400):
        rover = in_mode(STEERING)
        rover.sticks(throttle=throttle)
        rover.run(4.0)
        rover.sticks(steering=1700)
        before = rover.heading
        rover.run(1.0)
        turned = rover.heading - before
        assert turned * (1 if throttle > 1500 else -1) > 0.05  # like a car's wheel


def test_a_skid_steered_rover_turns_on_the_spot_at_the_turn_rate_of_the_stick() -> None:
    """ACRO_TURN_RATE [deg/s] at full stick, while the throttle is in its middle; else the stick is an acceleration."""
    skid = {"SERVO1_FUNCTION": 73.0, "SERVO3_FUNCTION": 74.0}
    rates = []
    for throttle in (1500, 1700):
        rover = in_mode(STEERING, ACRO_TURN_RATE=90.0, ATC_STR_ACC_MAX=0.0, **skid)
        rover.sticks(steering=1500 + 30 + 235, throttle=throttle)
        rover.run(0.1)
        rates.append(math.degrees(rover.ap.control.steering.turn_rate))
    assert rates[0] == pytest.approx(45.0, abs=0.5) and rates[1] != pytest.approx(45.0, abs=5.0)


def test_velocity_modes_rest_without_a_speed() -> None:
    rover = in_mode(STEERING)
    rover.set_estimate(False)
    rover.sticks(throttle=1900)
    rover.run(1.0)
    assert int(rover.v.actuators.pwm[2]) == 1500
    blind = Rover()
    blind.set_estimate(False)
    blind.arm().run(0.1)
    assert request(blind.v, STEERING, 1) != 0
    assert request(blind.v, ACRO, 1) != 0
    assert request(blind.v, HOLD, 1) == 0


@pytest.mark.parametrize(("kind", "heading"), [(0, 1.0 + math.pi / 4), (1, math.pi / 4)])
def test_simple_points_where_to_drive(kind: int, heading: float) -> None:
    rover = Rover(SIMPLE_TYPE=float(kind))
    rover.place(0.0, 0.0, 1.0)
    rover.arm()
    request(rover.v, SIMPLE, 1)
    rover.sticks(steering=1650, throttle=1650)
    rover.run(8.0)
    assert math.remainder(rover.heading - heading, 2 * math.pi) == pytest.approx(0.0, abs=0.03)
    rover.sticks(steering=1500, throttle=1500)
    rover.run(8.0)
    assert rover.speed == pytest.approx(0.0, abs=0.11)
    assert math.remainder(rover.heading - heading, 2 * math.pi) == pytest.approx(0.0, abs=0.05)


def test_mode_switch() -> None:
    rover = Rover()
    rover.run(1.2)
    rover.sticks(mode=1425)  # position 3
    rover.run(0.1)
    assert rover.ap.modes.number == MANUAL
    rover.run(0.3)
    assert rover.ap.modes.number == RTL
    rover.run(1.0)
    request(rover.v, HOLD, 2)
    rover.run(1.0)
    assert rover.ap.modes.number == HOLD  # the switch speaks only when it moves


def test_stick_mixing_adds_to_the_autopilots_steering() -> None:
    rover = Rover(STICK_MIXING=1.0)
    rover.sticks(steering=1750)
    rover.run(0.04)
    assert pilot.mixed(rover.ap.modes.pilot, 0.4, 1.0) == pytest.approx(150 / 400 * 0.4 + 220 / 470)
    assert pilot.mixed(rover.ap.modes.pilot, 0.4, 0.0) == 0.4


@pytest.mark.parametrize(
    ("stick", "armed", "moving", "enabled", "command"),
    [
        (1.0, False, False, 1.0, 1),
        (1.0, False, False, 0.0, 0),
        (1.0, True, False, 2.0, 0),
        (0.8, False, False, 2.0, 0),
        (-1.0, True, False, 2.0, -1),
        (-1.0, True, True, 2.0, 0),
        (-1.0, True, False, 1.0, 0),
    ],
)
def test_arming_by_stick(stick: float, armed: bool, moving: bool, enabled: float, command: int) -> None:
    sticks = PilotState()
    sticks.steering = stick
    assert arming.stick_command(sticks, MANUAL, armed, moving, enabled) == command
    assert arming.stick_command(sticks, RTL, armed, moving, enabled) == 0
    sticks.throttle = 0.1
    assert arming.stick_command(sticks, MANUAL, armed, moving, enabled) == 0
    sticks.throttle, sticks.lost = 0.0, True
    assert arming.stick_command(sticks, MANUAL, armed, moving, enabled) == 0
