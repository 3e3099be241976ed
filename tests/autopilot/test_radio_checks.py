# SPDX-License-Identifier: BSD-3-Clause
"""Arming checks of the radio, as ArduCopter and ArduRover 4.7 answer to the same sticks and parameters."""

from __future__ import annotations

from typing import Any

import pytest

from sitl.autopilot.arming_checks import ArmingMethod, refusal
from sitl.autopilot.copter import arming as copter_arming
from sitl.autopilot.copter.event_list import EVENTS
from sitl.autopilot.copter.parameters import TABLE as COPTER
from sitl.autopilot.notes import ChecksFailed
from sitl.autopilot.parameter_checks import Found
from sitl.autopilot.params.table import Values
from sitl.autopilot.radio_checks import OFF_CENTRE, PARAMETERS, STICK_NAMES, calibration_texts
from sitl.autopilot.rover import arming as rover_arming
from sitl.autopilot.rover.parameter_checks import STICKS
from sitl.autopilot.rover.parameters import TABLE as ROVER
from sitl.autopilot.sensor_calibration import PARAMETERS_BAD
from sitl.bridge.copter.autopilot import CopterAutopilot
from tests.autopilot.copter.steady_copter import make
from tests.autopilot.rover.modes.driven_rover import Rover

STABILIZE, GUIDED, LOITER = 0, 4, 5


def copter(mode: int = STABILIZE, **params: float) -> Any:
    v = make()
    v.autopilot.modes.number = mode
    for name, value in params.items():
        setattr(v.autopilot.params, name, value)
    return v


def copter_texts(v: Any, method: int = ArmingMethod.MAVLINK) -> list[str]:
    return copter_arming.arm(v, method, False)[1]


@pytest.mark.parametrize("mode", (STABILIZE, LOITER, GUIDED))
@pytest.mark.parametrize(("channel", "name"), ((1, "Roll"), (2, "Pitch"), (4, "Yaw")))
@pytest.mark.parametrize(("pulse", "rests"), ((1475, False), (1480, True), (1515, True), (1521, False), (2000, False)))
def test_a_copters_sticks_must_rest_in_the_middle(mode: int, channel: int, name: str, pulse: int, rests: bool) -> None:
    v = copter(mode)
    v.autopilot.rc.channels[channel - 1] = pulse
    assert copter_texts(v) == ([] if rests else [f"Arm: {name} (RC{channel}) is not neutral"])


@pytest.mark.parametrize(("pulse", "rests"), ((1000, True), (1020, True), (1040, False), (1500, False)))
def test_a_copters_throttle_must_be_down_in_every_mode(pulse: int, rests: bool) -> None:
    v = copter(GUIDED, RC3_MIN=1000.0)
    v.autopilot.rc.channels[2] = pulse
    assert copter_texts(v) == ([] if rests else ["Arm: Throttle (RC3) is not neutral"])


def test_where_the_throttle_makes_thrust_its_own_check_speaks_alone() -> None:
    v = copter(STABILIZE)
    v.autopilot.rc.channels[2] = 1500
    v.autopilot.modes.pilot.throttle = 0.5
    assert copter_texts(v) == ["Arm: Throttle too high"]


def test_yaw_may_be_off_when_it_is_the_arming_stick() -> None:
    v = copter()
    v.autopilot.rc.channels[3] = 2000
    assert copter_texts(v, ArmingMethod.RUDDER) == []


@pytest.mark.parametrize(
    ("params", "texts"),
    (
        ({"RC1_MIN": 1300.0}, []),
        ({"RC1_MIN": 1301.0}, ["Roll radio min too high"]),
        ({"RC2_MAX": 1699.0}, ["Pitch radio max too low"]),
        ({"RC3_MIN": 1301.0}, ["Throttle radio min too high"]),
        ({"RC4_MIN": 1450.0}, ["Yaw radio min too high"]),
        ({"RC6_MAX": 1400.0}, ["RC6_MAX is less than RC6_TRIM"]),
        ({"RC8_MIN": 1600.0, "RC9_MIN": 1600.0}, ["RC8_MIN is greater than RC8_TRIM"]),  # the receiver has no ninth
        (
            {"RC1_MIN": 1400.0, "RC2_MIN": 1400.0, "RC1_MAX": 1450.0, "RC7_MIN": 1600.0},
            [
                "Roll radio min too high",
                "Roll radio max too low",
                "Pitch radio min too high",
                "RC1_MAX is less than RC1_TRIM",
                "RC7_MIN is greater than RC7_TRIM",
            ],
        ),
        ({"RCMAP_ROLL": 2.0, "RCMAP_PITCH": 5.0, "RC2_MIN": 1400.0}, ["Roll radio min too high"]),
    ),
)
def test_a_copters_channels_must_be_calibrated(params: dict[str, float], texts: list[str]) -> None:
    v = copter()
    values = Values(COPTER, v.autopilot.params)
    values.update(params)
    assert list(calibration_texts(values, v.autopilot.params, STICK_NAMES)) == texts


def test_texts_name_the_channel_of_a_stick() -> None:
    v = copter(RCMAP_ROLL=2.0, RCMAP_PITCH=1.0)
    v.autopilot.rc.channels[1] = 1700
    assert copter_texts(v) == ["Arm: Roll (RC2) is not neutral"]


def rover_texts(rover: Rover, method: int = ArmingMethod.MAVLINK) -> list[str]:
    return rover_arming.arm(rover.v, method, False)[1]


@pytest.mark.parametrize(
    ("channel", "pulse", "texts"),
    (
        (1, 1550, ["Arm: Roll (RC1) is not neutral"]),
        (2, 2000, []),
        (3, 1400, ["Arm: Throttle (RC3) is not neutral"]),
        (4, 1300, ["Arm: Yaw (RC4) is not neutral"]),
    ),
)
def test_a_rovers_sticks(channel: int, pulse: int, texts: list[str]) -> None:
    rover = Rover()
    rover.ap.rc.channels[channel - 1] = pulse
    assert rover_texts(rover) == texts


@pytest.mark.parametrize(
    ("params", "texts"),
    (
        ({"RC1_MIN": 1301.0}, ["Steer radio min too high"]),
        ({"RC3_MIN": 1400.0}, ["Throttle radio min too high"]),
        ({"RC1_MAX": 1699.0}, ["Steer radio max too low"]),
        ({"RC2_MIN": 1400.0, "RC4_MAX": 1600.0}, []),
        ({"RC5_MIN": 1600.0}, ["RC5_MIN is greater than RC5_TRIM"]),
        ({"RC6_TRIM": -1.0}, ["RC6_MAX is less than RC6_TRIM"]),
    ),
)
def test_a_rovers_channels(params: dict[str, float], texts: list[str]) -> None:
    ap = Rover().ap
    values = Values(ROVER, ap.params)
    values.update(params)
    assert list(calibration_texts(values, ap.params, STICKS)) == texts


def test_a_refusal_keeps_all_its_bits_in_the_event() -> None:
    """A float holds 53 bits; the checks are more."""
    v = copter()
    v.autopilot.calibrated.state = PARAMETERS_BAD
    v.autopilot.rc.receiver_ok, v.autopilot.rc.receiver_us = False, 0
    failed = copter_arming.try_arm(v, ArmingMethod.SWITCH, False)
    events = v.autopilot.events
    assert failed & PARAMETERS and failed & 2048
    a, b = float(events.a[0]), float(events.b[0])
    assert refusal(a, b) == (failed, ArmingMethod.SWITCH)
    assert refusal(float((1 << 48) - 1), float(OFF_CENTRE[3] >> 48 << 5 | 18)) == ((1 << 48) - 1 | OFF_CENTRE[3], 18)


def test_a_refused_switch_says_all() -> None:
    v = copter()
    v.autopilot.calibrated.state = PARAMETERS_BAD
    v.autopilot.rc.receiver_ok, v.autopilot.rc.receiver_us = False, 0
    copter_arming.try_arm(v, ArmingMethod.SWITCH, False)
    events = v.autopilot.events
    pilot = CopterAutopilot.__new__(CopterAutopilot)
    pilot._v, pilot._found = v, [Found("Roll radio min too high", False, True)]
    (note,) = EVENTS[int(events.code[0])].notes(v, float(events.a[0]), float(events.b[0]))
    assert isinstance(note, ChecksFailed)
    assert pilot.refusal_texts(note.failed) == ["Arm: RC not found", "Arm: Roll radio min too high"]
