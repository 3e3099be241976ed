# SPDX-License-Identifier: BSD-3-Clause
"""AUTO: begins what the shell writes, says when it is done, and what comes after the mission."""

from __future__ import annotations

import math
from typing import Any

import pytest

from sitl.autopilot.command_results import CommandResult
from sitl.autopilot.modes import MODE_CHANGED
from sitl.autopilot.navigation import state as kinds
from sitl.autopilot.navigation.state import COMMAND_COMPLETE
from sitl.autopilot.rover.modes import auto, circle, guided_setpoints
from sitl.autopilot.rover.modes.acro import ACRO
from sitl.autopilot.rover.modes.auto import AUTO
from sitl.autopilot.rover.modes.guided import GUIDED
from sitl.autopilot.rover.modes.manual import MANUAL
from sitl.autopilot.rover.modes.set_mode import change_speed, request
from sitl.autopilot.rover.modes.state import Modes
from sitl.autopilot.rover.navigation.planner import PLANNER
from sitl.autopilot.state import Estimate
from sitl.core.vectors import Vec2, Vec3
from tests.autopilot.rover.modes.driven_rover import Rover, drive_to, set_velocity


@pytest.fixture
def rover() -> Rover:
    made = Rover()
    made.run(1.1)
    made.arm()
    made.ap.modes.mission_count = 3
    assert request(made.v, AUTO, 2) == 0
    made.ap.modes.nav.mission_state = kinds.RUNNING
    made.events()
    return made


def give(rover: Rover, kind: int, place: tuple[float, float] | None = None, **fields: Any) -> None:
    """What the shell does to give a command."""
    nav = rover.ap.modes.nav
    if place is not None and kind != kinds.LOITER_TURNS:
        PLANNER.begin(rover.ap, int(rover.v.time_us), Vec3(*place, 0.0))
    if place is not None:
        nav.target = (*place, 0.0)
    nav.has_target = int(place is not None)
    for name, value in {"delay": 0.0, "turns": 0.0, **fields}.items():
        setattr(nav, name, value)
    nav.command_kind = kind
    nav.command_count += 1


def is_complete(rover: Rover) -> bool:
    return (COMMAND_COMPLETE, kinds.NAV_COMMAND, float(rover.ap.modes.nav.command_count)) in rover.events()


def seconds_until_complete(rover: Rover, most: float) -> float:
    for k in range(round(most * 10)):
        rover.run(0.1)
        if is_complete(rover):
            return 0.1 * (k + 1)
    return math.inf


def test_entering_is_told_to_the_shell_and_nothing_moves() -> None:
    rover = Rover().arm()
    rover.ap.modes.mission_count = 2
    rover.events()
    request(rover.v, AUTO, 2)
    assert rover.events() == [(MODE_CHANGED, float(AUTO), 2.0)]
    assert rover.ap.events.attention == 1
    rover.run(1.0)
    assert rover.speed == 0.0


def test_waypoint(rover: Rover) -> None:
    give(rover, kinds.WAYPOINT, (20.0, 0.0))
    assert seconds_until_complete(rover, 20.0) < 14.0
    assert rover.position[0] == pytest.approx(20.0, abs=3.0)


def test_waypoint_with_delay_waits(rover: Rover) -> None:
    give(rover, kinds.WAYPOINT, (20.0, 0.0), delay=5.0)
    assert seconds_until_complete(rover, 14.0) == math.inf
    assert rover.ap.modes.nav.reached == 1
    assert seconds_until_complete(rover, 6.0) < 5.0
    assert abs(rover.speed) < 0.05


def test_loiter_unlimited_never_ends(rover: Rover) -> None:
    give(rover, kinds.LOITER_UNLIMITED, (10.0, 0.0))
    assert seconds_until_complete(rover, 25.0) == math.inf
    assert rover.position[0] == pytest.approx(10.0, abs=0.5)
    assert abs(rover.speed) < 0.05


def test_delay_stands(rover: Rover) -> None:
    give(rover, kinds.DELAY, delay=3.0)
    assert seconds_until_complete(rover, 5.0) == pytest.approx(3.1, abs=0.11)
    assert rover.speed == 0.0


def test_turns_around_a_place(rover: Rover) -> None:
    give(rover, kinds.LOITER_TURNS, (0.0, 10.0), circle_radius=-8.0, turns=1.0)
    assert seconds_until_complete(rover, 60.0) < 45.0
    assert rover.ap.modes.circle.total == pytest.approx(-2.0 * math.pi, abs=0.2)
    assert math.dist(rover.position, (0.0, 10.0)) == pytest.approx(8.0, abs=1.5)


@pytest.mark.parametrize(
    ("north", "east", "angle"), [(3.0, 0.0, 0.0), (0.0, 5.0, 90.0), (-4.0, 0.0, 180.0), (0.0, 0.0, 40.0)]
)
def test_in_which_direction_it_is_seen_from_a_centre(north: float, east: float, angle: float) -> None:
    estimate = Estimate()
    estimate.pos, estimate.euler = Vec3(10.0 + north, 20.0 + east, 0.0), (0.0, 0.0, math.radians(40.0))
    assert math.degrees(circle.angle_from(Vec2(10.0, 20.0), estimate)) == pytest.approx(angle)


def test_return(rover: Rover) -> None:
    rover.place(15.0, 0.0, math.pi)
    give(rover, kinds.RTL)
    assert seconds_until_complete(rover, 20.0) < 15.0
    assert "Reached destination" in rover.texts() or math.hypot(*rover.position) < 3.0


def test_heading_and_speed(rover: Rover) -> None:
    give(rover, kinds.YAW_SPEED, heading=1.5, heading_speed=9.0)
    assert seconds_until_complete(rover, 20.0) < 15.0
    assert rover.ap.modes.auto.speed == 5.0  # WP_SPEED
    assert rover.heading == pytest.approx(1.5, abs=0.15)


def test_guided_until_its_place_or_limit(rover: Rover) -> None:
    assert set_velocity(rover.v, 1.0, 0.0) == CommandResult.WRONG_MODE
    guided_setpoints.set_limits(rover.ap.modes.guided, 4.0, 0.0)
    give(rover, kinds.GUIDED)
    rover.run(0.1)
    assert set_velocity(rover.v, 2.0, 0.0) == CommandResult.OK
    assert seconds_until_complete(rover, 10.0) == pytest.approx(4.0, abs=0.2)
    assert rover.position[0] > 2.0
    guided_setpoints.set_limits(rover.ap.modes.guided, 0.0, 0.0)
    give(rover, kinds.GUIDED)
    rover.ap.modes.nav.target = (30.0, 0.0, 0.0)
    rover.ap.modes.nav.has_target = 1
    rover.run(0.1)
    assert drive_to(rover.v, 30.0, 0.0) == CommandResult.OK
    assert seconds_until_complete(rover, 20.0) < 15.0


def test_a_command_to_pass_over_is_done_at_once(rover: Rover) -> None:
    give(rover, kinds.PASSED_OVER)
    assert seconds_until_complete(rover, 1.0) == 0.1


def test_change_speed(rover: Rover) -> None:
    give(rover, kinds.WAYPOINT, (60.0, 0.0))
    rover.run(0.1)
    assert change_speed(rover.v, 1.0)
    rover.run(12.0)
    assert abs(rover.speed) < 5.0
    assert rover.ap.modes.nav.speed_ne == 1.0


@pytest.mark.parametrize(
    ("choice", "mode", "submode"),
    [(0, AUTO, auto.STOPPED), (1, AUTO, auto.LOITERING), (2, ACRO, -1), (3, MANUAL, -1)],
)
def test_mission_done(rover: Rover, choice: int, mode: int, submode: int) -> None:
    rover.ap.params.MIS_DONE_BEHAVE = float(choice)
    give(rover, kinds.NONE)
    rover.ap.modes.nav.mission_state = kinds.COMPLETE
    rover.run(0.1)
    assert rover.ap.modes.number == mode
    if submode >= 0:
        assert rover.ap.modes.auto.submode == submode


def test_a_mission_that_is_flown_again_is_done_again(rover: Rover) -> None:
    rover.ap.params.MIS_DONE_BEHAVE = 1.0
    for _ in range(2):
        give(rover, kinds.WAYPOINT, (50.0, 0.0))
        rover.ap.modes.nav.mission_state = kinds.RUNNING
        rover.run(0.1)
        assert rover.ap.modes.auto.submode == auto.ON_PATH
        rover.ap.modes.nav.mission_state = kinds.COMPLETE
        rover.run(0.1)
        assert rover.ap.modes.auto.submode == auto.LOITERING


def test_leaving_auto_is_told() -> None:
    rover = Rover().arm()
    rover.ap.modes.mission_count = 2
    request(rover.v, AUTO, 2)
    rover.ap.events.attention = 0
    request(rover.v, GUIDED, 2)
    assert rover.ap.events.attention == 1


@pytest.mark.parametrize(
    ("kind", "since_us", "done"),
    [
        (kinds.NONE, 1, False),
        (kinds.WAYPOINT, 0, False),
        (kinds.WAYPOINT, 2, False),
        (kinds.WAYPOINT, 1, True),
        (kinds.LOITER_TIME, 1, True),
        (kinds.LOITER_UNLIMITED, 1, False),
        (kinds.DELAY, 2, False),
        (kinds.DELAY, 1, True),
        (kinds.PASSED_OVER, 0, True),
    ],
)
def test_a_command_is_done_when_it_has_waited(kind: int, since_us: int, done: bool) -> None:
    modes = Modes()
    modes.nav.command_kind, modes.nav.since_us, modes.nav.delay = kind, since_us, 3.0
    assert auto.is_done(modes, 3_000_001, Vec2(0.0, 0.0), 2.0) == done


def test_guided_within_a_mission_is_done_at_its_place() -> None:
    modes = Modes()
    modes.nav.command_kind, modes.auto.submode = kinds.GUIDED, auto.GUIDED_IN_MISSION
    modes.nav.target = Vec3(10.0, 0.0, 0.0)
    assert not auto.is_done(modes, 1, Vec2(9.0, 0.0), 2.0)
    modes.nav.has_target = True
    assert auto.is_done(modes, 1, Vec2(9.0, 0.0), 2.0)
    assert not auto.is_done(modes, 1, Vec2(7.0, 0.0), 2.0)
