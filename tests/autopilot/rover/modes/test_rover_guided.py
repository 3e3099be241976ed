# SPDX-License-Identifier: BSD-3-Clause
"""GUIDED: set-points, their age, and ArduPilot's recorded drives."""

from __future__ import annotations

import math

import pytest

from sitl.autopilot.command_results import CommandResult
from sitl.autopilot.rover.modes import guided_setpoints
from sitl.autopilot.rover.modes.guided import GUIDED, GUIDED_REACHED, GUIDED_TIMEOUT, STOP
from sitl.autopilot.rover.modes.hold import HOLD
from sitl.autopilot.rover.modes.set_mode import change_speed, request
from tests.autopilot.rover.modes.driven_rover import (
    Rover,
    drive_to,
    set_heading,
    set_turn_rate,
    set_velocity,
)


@pytest.fixture
def rover() -> Rover:
    made = Rover().arm()
    assert request(made.v, GUIDED, 2) == 0
    return made


def stream(rover: Rover, seconds: float, setter: object, *numbers: float) -> None:
    """Send a set-point ten times a second."""
    for _ in range(round(seconds * 10)):
        assert setter(rover.v, *numbers) == CommandResult.OK  # type: ignore[operator]
        rover.run(0.1)


def test_velocity_north_as_recorded(rover: Rover) -> None:
    times: dict[float, float] = {}
    for k in range(100):
        set_velocity(rover.v, 2.0, 0.0)
        rover.run(0.1)
        for mark in (1.0, 1.9):
            if rover.speed >= mark:
                times.setdefault(mark, 0.1 * (k + 1))
    assert times[1.0] == pytest.approx(1.32, abs=0.15)
    assert times[1.9] == pytest.approx(2.0, abs=0.15)
    assert rover.speed == pytest.approx(2.0, abs=0.02)
    assert rover.position[0] == pytest.approx(18.0, abs=0.5)


def test_a_set_point_is_good_for_three_seconds(rover: Rover) -> None:
    stream(rover, 10.0, set_velocity, 2.0, 0.0)
    rover.events()
    rover.run(2.9)
    assert rover.events() == []
    rover.run(0.1)
    assert rover.events() == [(GUIDED_TIMEOUT, 3.0, 0.0)]
    rover.run(2.2)
    assert abs(rover.speed) < 0.1  # recorded: stopped 4.9 s after the last one
    rover.run(5.0)
    assert rover.events() == []  # said once


def test_position_as_recorded(rover: Rover) -> None:
    drive_to(rover.v, 0.0, 20.0)
    seen: dict[str, float] = {}
    top = 0.0
    for k in range(150):
        rover.run(0.1)
        away = math.hypot(rover.position[0], rover.position[1] - 20.0)
        top = max(top, rover.speed)
        for mark in (3.0, 1.0):
            if away < mark:
                seen.setdefault(f"within {mark}", 0.1 * (k + 1))
        if away < 3.0 and rover.speed < 0.1:
            seen.setdefault("stopped", 0.1 * (k + 1))
    assert seen["within 3.0"] == pytest.approx(7.8, rel=0.05)
    assert seen["within 1.0"] == pytest.approx(9.2, rel=0.05)
    assert seen["stopped"] == pytest.approx(10.6, rel=0.05)
    assert top == pytest.approx(3.96, rel=0.05)
    assert (GUIDED_REACHED, 0.0, 0.0) in rover.events()


def test_positions_need_no_renewal_and_arrival_is_said_once(rover: Rover) -> None:
    drive_to(rover.v, 10.0, 0.0)
    rover.run(20.0)
    assert [e[0] for e in rover.events()].count(GUIDED_REACHED) == 1
    assert rover.position[0] == pytest.approx(10.0, abs=0.5)


@pytest.mark.parametrize("aside", [12.0, 25.0, 40.0])
def test_a_position_beside_the_way_is_not_circled_for_ever(rover: Rover, aside: float) -> None:
    stream(rover, 15.0, set_velocity, 5.0, 0.0)
    assert rover.speed > 4.5
    north, east = rover.position
    assert drive_to(rover.v, north, east + aside) == CommandResult.OK
    rover.events()
    rover.run(60.0)
    assert (GUIDED_REACHED, 0.0, 0.0) in rover.events()
    assert rover.position == pytest.approx((north, east + aside), abs=3.5)


def test_planned_positions(rover: Rover) -> None:
    rover.ap.params.GUID_OPTIONS = 64.0
    drive_to(rover.v, 10.0, 5.0)
    rover.run(15.0)
    assert rover.position == pytest.approx((10.0, 5.0), abs=0.7)


def test_heading_and_speed(rover: Rover) -> None:
    stream(rover, 6.0, set_heading, 2.0, 1.5)
    assert rover.speed == pytest.approx(1.5, abs=0.05)
    assert rover.heading == pytest.approx(2.0, abs=0.05)


def test_backwards(rover: Rover) -> None:
    stream(rover, 6.0, set_heading, 0.0, -1.5)
    assert rover.speed == pytest.approx(-1.5, abs=0.05)


def test_turn_rate_and_speed(rover: Rover) -> None:
    stream(rover, 6.0, set_turn_rate, 0.3, 2.0)
    assert float(rover.ap.estimate.rates[2]) == pytest.approx(0.3, abs=0.02)


def test_stop(rover: Rover) -> None:
    stream(rover, 4.0, set_velocity, 2.0, 0.0)
    assert guided_setpoints.stop(rover.ap.modes) == CommandResult.OK
    rover.run(3.0)
    assert abs(rover.speed) < 0.1
    assert rover.ap.modes.guided.submode == STOP


@pytest.mark.parametrize("setter", [drive_to, set_heading, set_turn_rate])
def test_refusals_change_nothing(setter: object) -> None:
    rover = Rover().arm()
    before = bytes(rover.v._bytes)
    for numbers, code in (
        ((1.0, 1.0), CommandResult.WRONG_MODE),
        ((math.nan, 0.0), CommandResult.NOT_FINITE),
        ((0.0, math.inf), CommandResult.NOT_FINITE),
    ):
        assert setter(rover.v, *numbers) == code  # type: ignore[operator]
    assert bytes(rover.v._bytes) == before


def test_change_speed_is_for_positions(rover: Rover) -> None:
    assert not change_speed(rover.v, 3.0)
    drive_to(rover.v, 50.0, 0.0)
    assert not change_speed(rover.v, -5.0)
    assert not change_speed(rover.v, math.nan)
    assert change_speed(rover.v, 1.0)
    rover.run(10.0)
    assert rover.speed == pytest.approx(1.0, abs=0.1)


def test_hold_rolls_out_as_recorded(rover: Rover) -> None:
    stream(rover, 6.0, set_velocity, 2.0, 0.0)
    start, before = rover.position[0], rover.speed
    request(rover.v, HOLD, 2)
    rover.run(5.5)
    assert rover.speed == pytest.approx(before * math.exp(-5.5 / 2.0), rel=0.05)
    assert rover.position[0] - start == pytest.approx(3.8, abs=0.2)
