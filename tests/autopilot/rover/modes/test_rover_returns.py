# SPDX-License-Identifier: BSD-3-Clause
"""RTL, SMART_RTL, LOITER and CIRCLE: where the vehicle ends up, and by which way."""

from __future__ import annotations

import math

import pytest

from sitl.autopilot.rover.modes import circle
from sitl.autopilot.rover.modes.circle import CIRCLE, CIRCLE_ADAPTED
from sitl.autopilot.rover.modes.guided import GUIDED
from sitl.autopilot.rover.modes.loiter import LOITER
from sitl.autopilot.rover.modes.rtl import RTL
from sitl.autopilot.rover.modes.set_mode import change_speed, request
from sitl.autopilot.rover.modes.smart_rtl import SMART_RTL
from tests.autopilot.rover.modes.driven_rover import Rover, drive_to, set_velocity


def out(way: list[tuple[float, float]], **params: float) -> Rover:
    """A rover armed at the origin that was driven along ``way`` in GUIDED."""
    rover = Rover(**params)
    rover.run(1.1)
    rover.arm()
    request(rover.v, GUIDED, 2)
    for place in way:
        drive_to(rover.v, *place)
        for _ in range(60):
            rover.run(0.5)
            if math.dist(rover.position, place) < 1.0:
                break
    rover.run(3.0)
    rover.events()
    return rover


def test_rtl_comes_home_and_says_so_once() -> None:
    rover = out([(25.0, 10.0)])
    assert request(rover.v, RTL, 2) == 0
    rover.run(25.0)
    assert math.hypot(*rover.position) < 1.0
    assert abs(rover.speed) < 0.1
    assert rover.texts() == ["Reached destination"]


def test_rtl_speed() -> None:
    rover = out([(25.0, 0.0)], RTL_SPEED=1.0)
    request(rover.v, RTL, 2)
    top = 0.0
    for _ in range(100):
        rover.run(0.1)
        top = max(top, abs(rover.speed))
    assert top == pytest.approx(1.0, abs=0.25)


def test_rtl_needs_a_home() -> None:
    rover = Rover()
    rover.ap.home.is_set = 0
    assert request(rover.v, RTL, 2) != 0
    assert rover.texts() == ["Flight mode change failed"]


def test_smart_rtl_drives_back_the_way_it_came() -> None:
    rover = out([(20.0, 0.0), (20.0, 20.0)])
    request(rover.v, SMART_RTL, 2)
    nearest = 99.0
    for _ in range(600):
        rover.run(0.1)
        nearest = min(nearest, math.dist(rover.position, (20.0, 0.0)))
    assert nearest < 3.0  # round the corner, not across
    assert math.hypot(*rover.position) < 1.5
    assert rover.texts() == ["Reached destination"]


def test_smart_rtl_needs_a_path() -> None:
    rover = Rover(SRTL_POINTS=0.0).arm()
    assert request(rover.v, SMART_RTL, 2) != 0


def test_loiter_stops_and_stays() -> None:
    rover = out([])
    for _ in range(40):
        set_velocity(rover.v, 2.0, 0.0)
        rover.run(0.1)
    here = rover.position[0]
    request(rover.v, LOITER, 2)
    rover.run(5.0)
    assert abs(rover.speed) < 0.11
    assert rover.position[0] - here == pytest.approx(2.0, abs=0.7)


@pytest.mark.parametrize(("kind", "forwards"), [(0, False), (1, True), (2, False)])
def test_loiter_drives_back(kind: int, forwards: bool) -> None:
    rover = out([], LOIT_TYPE=float(kind))
    request(rover.v, LOITER, 2)
    rover.place(8.0, 0.0)  # pushed away, ahead of its place
    rover.run(3.0)
    assert (rover.speed > 0.0) == forwards
    rover.run(30.0)
    assert math.hypot(*rover.position) < 2.5


def test_circle_keeps_its_radius() -> None:
    rover = out([], CIRC_RADIUS=10.0, CIRC_SPEED=2.0)
    assert request(rover.v, CIRCLE, 2) == 0
    rover.run(20.0)
    away = []
    for _ in range(300):
        rover.run(0.1)
        away.append(math.hypot(*rover.position))
    assert min(away) > 9.3
    assert max(away) < 10.7
    assert rover.speed == pytest.approx(2.0, abs=0.1)
    assert circle.turns(rover.ap.modes.circle) > 1.0
    assert float(rover.ap.estimate.rates[2]) > 0.0  # clockwise


def test_circle_the_other_way_round() -> None:
    rover = out([], CIRC_RADIUS=10.0, CIRC_SPEED=2.0, CIRC_DIR=1.0)
    request(rover.v, CIRCLE, 2)
    rover.run(30.0)
    assert float(rover.ap.estimate.rates[2]) < 0.0
    assert rover.ap.modes.circle.total < 0.0


def test_circle_within_the_vehicles_limits() -> None:
    rover = out([], CIRC_RADIUS=1.0, CIRC_SPEED=9.0, TURN_RADIUS=3.0, ATC_TURN_MAX_G=0.5)
    request(rover.v, CIRCLE, 2)
    top = math.sqrt(0.5 * 9.80665 * 3.0)
    told = [(a, b) for code, a, b in rover.events() if code == CIRCLE_ADAPTED]
    assert told[0] == (circle.RADIUS_ENLARGED, 3.0)
    assert told[1] == (circle.SPEED_LIMITED, pytest.approx(top))
    assert change_speed(rover.v, 1.0)
    assert rover.ap.modes.circle.speed == 1.0
    assert not change_speed(rover.v, 0.0)
