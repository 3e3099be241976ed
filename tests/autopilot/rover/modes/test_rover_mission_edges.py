# SPDX-License-Identifier: BSD-3-Clause
"""A rover's set-points that expire or are refused, and commands of a mission that begin and end."""

from __future__ import annotations

import math
from typing import Any

import pytest

from sitl.autopilot.avoidance import limit
from sitl.autopilot.command_results import CommandResult
from sitl.autopilot.modes import ModeReason
from sitl.autopilot.navigation import state as kinds
from sitl.autopilot.rover.modes import auto, circle, drive, guided, guided_setpoints, loiter
from sitl.autopilot.rover.modes.auto import AUTO
from sitl.autopilot.rover.modes.guided import GUIDED
from sitl.autopilot.rover.modes.hold import HOLD
from sitl.autopilot.rover.modes.mode import no_destination
from sitl.autopilot.rover.modes.set_mode import change_speed, request
from sitl.autopilot.rover.modes.state import AutoState, GuidedState, Modes
from sitl.core.algebra import ZERO2
from sitl.core.vectors import Vec2, Vec3
from tests.autopilot.rover.modes.driven_rover import Rover


def done(kind: int, submode: int = auto.STOPPED, seconds: float = 9.0, pos: Vec2 = ZERO2, **nav: Any) -> bool:
    """Whether a command is done ``seconds`` after its position was reached (``since_us``)."""
    modes = Modes()
    modes.nav.command_kind, modes.auto.submode, modes.nav.since_us = kind, submode, 1_000_000
    for name, value in nav.items():
        setattr(modes.nav, name, value)
    return bool(auto.is_done(modes, 1_000_000 + round(seconds * 1e6), pos, 2.0))


@pytest.mark.parametrize(("age_us", "dropped"), ((3_000_000, False), (3_000_001, True)))
def test_a_set_point_is_good_for_three_seconds(rover: Rover, age_us: int, dropped: bool) -> None:
    state = GuidedState()
    state.has_target, state.update_us = True, 5
    for _ in range(2):
        guided.check_age(state, rover.ap.events, 5 + age_us)
    assert bool(state.has_target) != dropped
    assert rover.texts() == (["target not received last 3secs, stopping"] if dropped else [])


@pytest.mark.parametrize(
    ("limit_us", "distance", "after_us", "east", "ends"),
    (
        (0, 0.0, 10**9, 99.0, False),
        (5, 0.0, 4, 0.0, False),
        (5, 0.0, 5, 0.0, True),
        (0, 3.0, 0, 3.0, False),
        (0, 3.0, 0, 3.1, True),
    ),
)
def test_limits_of_guided_in_a_mission(limit_us: int, distance: float, after_us: int, east: float, ends: bool) -> None:
    state = GuidedState()
    state.limit_us, state.limit_distance = limit_us, distance
    guided.begin_limits(state, 100, Vec2(0.0, 7.0))
    assert guided.is_at_limit(state, 100 + after_us, Vec2(0.0, 7.0 + east)) == ends


@pytest.mark.parametrize(
    ("seconds", "distance", "code"),
    (
        (0.0, 0.0, CommandResult.OK),
        (2.5, 3.0, CommandResult.OK),
        (-0.1, 0.0, CommandResult.OUT_OF_RANGE),
        (0.0, -0.1, CommandResult.OUT_OF_RANGE),
        (math.nan, 0.0, CommandResult.NOT_FINITE),
        (0.0, math.inf, CommandResult.NOT_FINITE),
    ),
)
def test_limits_that_are_none_are_refused(seconds: float, distance: float, code: int) -> None:
    state = GuidedState()
    state.limit_us, state.limit_distance = 7, 8.0
    assert guided_setpoints.set_limits(state, seconds, distance) == code
    kept = (7, 8.0) if code != CommandResult.OK else (round(seconds * 1e6), distance)
    assert (state.limit_us, state.limit_distance) == kept


@pytest.mark.parametrize(
    ("value", "usable"), ((1e9, True), (-1e9, True), (1.1e9, False), (math.nan, False), (-math.inf, False))
)
def test_numbers_of_a_set_point_are_usable_up_to_a_limit(value: float, usable: bool) -> None:
    assert guided_setpoints.are_finite(value, 0.0) == guided_setpoints.are_finite(0.0, value) == usable


def test_a_heading_is_wrapped_and_a_turn_rate_is_not(rover: Rover) -> None:
    request(rover.v, GUIDED, ModeReason.GCS)
    state = rover.ap.modes.guided
    guided_setpoints.set_heading_and_speed(rover.ap.modes, 9, 1.5 * math.pi, 2.0)
    assert (state.heading, state.speed, state.update_us) == (pytest.approx(-0.5 * math.pi), 2.0, 9)
    guided_setpoints.set_turn_rate_and_speed(rover.ap.modes, 9, 0.3, -1.0)
    assert (state.turn_rate, state.speed, state.submode) == (0.3, -1.0, guided.TURN_RATE_AND_SPEED)


@pytest.mark.parametrize(
    ("options", "avoids", "planned"), ((0.0, 0.0, 0), (64.0, 0.0, 1), (32.0, 0.0, 0), (0.0, 1.0, 1))
)
def test_a_position_is_driven_to_along_a_planned_leg_with_the_option_or_path_planning(
    rover: Rover, options: float, avoids: float, planned: int
) -> None:
    request(rover.v, GUIDED, ModeReason.GCS)
    rover.ap.params.GUID_OPTIONS, rover.ap.params.OA.TYPE = options, avoids
    assert guided_setpoints.set_position(rover.v, Vec2(9.0, 2.0)) == CommandResult.OK
    assert rover.ap.modes.nav.request_pending == planned
    if planned:
        assert rover.ap.modes.nav.request == (9.0, 2.0, 0.0)
    assert not rover.ap.modes.guided.arrival_reported and rover.ap.modes.guided.pos == (9.0, 2.0)


@pytest.mark.parametrize(
    ("number", "submode", "is_open"), ((GUIDED, 0, True), (AUTO, 5, True), (AUTO, 1, False), (HOLD, 5, False))
)
def test_set_points_are_taken_in_guided_and_by_a_mission_that_says_so(number: int, submode: int, is_open: bool) -> None:
    modes = Modes()
    modes.number, modes.auto.submode = number, auto.GUIDED_IN_MISSION if submode == 5 else submode
    assert guided_setpoints.is_open(modes) == is_open
    assert (guided_setpoints.stop(modes) == CommandResult.OK) == is_open


@pytest.mark.parametrize(
    ("kind", "submode"),
    (
        (kinds.WAYPOINT, auto.ON_PATH),
        (kinds.LOITER_TIME, auto.ON_PATH),
        (kinds.LOITER_TURNS, auto.CIRCLING),
        (kinds.RTL, auto.RETURNING),
        (kinds.GUIDED, auto.GUIDED_IN_MISSION),
        (kinds.YAW_SPEED, auto.TURNING),
        (kinds.DELAY, auto.STOPPED),
        (kinds.NONE, auto.STOPPED),
    ),
)
def test_what_a_command_begins(kind: int, submode: int) -> None:
    assert auto.first_submode(kind) == submode


@pytest.mark.parametrize(
    ("kind", "fields", "is_done"),
    (
        (kinds.NONE, {}, False),
        (kinds.LOITER_UNLIMITED, {}, False),
        (kinds.WAYPOINT, {"delay": 9.0}, True),
        (kinds.WAYPOINT, {"delay": 9.1}, False),
        (kinds.WAYPOINT, {"since_us": 0}, False),  # not there yet
        (kinds.DELAY, {"delay": 9.0}, True),
        (kinds.DELAY, {"delay": 9.1}, False),
        (kinds.DELAY, {"since_us": 0, "delay": 1.0}, True),
        (kinds.LOITER_TURNS, {}, True),  # it could not begin
    ),
)
def test_when_a_command_is_done(kind: int, fields: dict[str, Any], is_done: bool) -> None:
    assert done(kind, **fields) == is_done


@pytest.mark.parametrize(
    ("place", "pos", "is_done"), ((1, Vec2(8.0, 0.0), True), (1, Vec2(7.9, 0.0), False), (0, Vec2(10.0, 0.0), False))
)
def test_guided_in_a_mission_ends_at_its_position(place: int, pos: Vec2, is_done: bool) -> None:
    got = done(kinds.GUIDED, auto.GUIDED_IN_MISSION, pos=pos, has_target=place, target=Vec3(10.0, 0.0, 0.0))
    assert got == is_done


@pytest.mark.parametrize(("wanted", "limit_speed", "kept"), ((9.0, 3.0, 3.0), (-9.0, 3.0, -3.0), (2.0, 3.0, 2.0)))
def test_a_turn_of_a_mission_is_no_faster_than_wp_speed(wanted: float, limit_speed: float, kept: float) -> None:
    state, modes = AutoState(), Modes()
    modes.nav.heading, modes.nav.heading_speed, state.heading_reached = 1.5 * math.pi, wanted, True
    auto.begin_turn(state, modes.nav, limit_speed)
    assert (state.heading, state.speed) == (pytest.approx(-0.5 * math.pi), kept)
    assert not state.heading_reached and state.submode == auto.TURNING


def test_a_command_that_cannot_begin_becomes_a_stop(rover: Rover) -> None:
    rover.ap.modes.nav.command_kind, rover.ap.estimate.origin_set = kinds.LOITER_TURNS, 0
    auto.begin(rover.v)
    assert rover.ap.modes.auto.submode == auto.STOPPED


@pytest.mark.parametrize(
    ("submode", "wanted", "taken"),
    (
        (auto.TURNING, 1.5, True),
        (auto.LOITERING, 1.5, False),
        (auto.ON_PATH, 1.5, True),
        (auto.CIRCLING, 1.5, True),
        (auto.GUIDED_IN_MISSION, 1.5, False),
    ),
)
def test_a_mission_takes_a_new_speed_where_there_is_one(rover: Rover, submode: int, wanted: float, taken: bool) -> None:
    rover.ap.modes.mission_count = 2
    request(rover.v, AUTO, ModeReason.GCS)
    rover.ap.modes.auto.submode = submode
    rover.ap.modes.circle.radius = 20.0
    assert change_speed(rover.v, wanted) is taken
    if submode == auto.TURNING:
        assert rover.ap.modes.auto.speed == 1.5
    if submode == auto.CIRCLING:
        assert rover.ap.modes.circle.speed == 1.5


def test_where_it_drives_to_is_that_of_what_it_does() -> None:
    modes = Modes()
    modes.number, modes.circle.target, modes.loiter.hold_pos = AUTO, Vec2(1.0, 2.0), Vec2(3.0, 4.0)
    wanted = {auto.CIRCLING: circle.destination(modes), auto.LOITERING: loiter.destination(modes)}
    wanted |= {auto.ON_PATH: auto.end_of_path(modes), auto.RETURNING: auto.end_of_path(modes)}
    wanted |= {auto.GUIDED_IN_MISSION: guided.destination(modes), auto.STOPPED: no_destination(modes)}
    for modes.auto.submode, there in wanted.items():
        assert auto.destination(modes) == there
    assert wanted[auto.CIRCLING].position == (1.0, 2.0) and wanted[auto.LOITERING].position == (3.0, 4.0)
    kinds_of = [wanted[s].kind for s in (auto.CIRCLING, auto.LOITERING, auto.STOPPED, auto.ON_PATH)]
    assert len(set(kinds_of)) == 4
    modes.guided.submode = guided.POSITION
    assert guided.destination(modes) == auto.end_of_path(modes)
    modes.guided.submode = guided.STOP
    assert guided.destination(modes) == no_destination(modes)


@pytest.mark.parametrize("law", ("at speed", "on path"))
def test_what_is_in_the_way_limits_the_speed(rover: Rover, law: str, monkeypatch: Any) -> None:
    asked: list[Any] = []

    def limited(ap: Any, time_us: int, desired: float, b: Any) -> float:
        asked.append((desired, b))
        return 0.7

    monkeypatch.setattr(limit, "is_active", lambda avoid: True)
    monkeypatch.setattr(limit, "limit_speed", limited)
    speeds: list[float] = []
    monkeypatch.setattr(drive.speed, "drive", lambda control, armed, desired, p: speeds.append(desired))
    rover.ap.params.ATC.DECEL_MAX, rover.ap.params.PSC.POS_P = 1.6, 0.4
    c = rover.ap.control.position
    c.accel_max, c.lat_accel_max = 2.0, 0.9
    (drive.at_speed if law == "at speed" else drive.on_path)(rover.v, 4.0)
    assert speeds == [0.7] and asked[0][0] == pytest.approx(4.0)
    got = asked[0][1]
    wanted = (0.0, 0.8) if law == "at speed" else (0.4, 0.9)
    assert (got[0], got[1]) == pytest.approx(wanted), "gain and deceleration"
