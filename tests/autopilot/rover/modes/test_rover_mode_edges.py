# SPDX-License-Identifier: BSD-3-Clause
"""A rover's modes at their edges: circles that fit it, ways back, set-points that expire, commands that end."""

from __future__ import annotations

import math
from typing import Any

import pytest

from sitl.autopilot.arming_checks import DISARMED, ArmingMethod
from sitl.autopilot.avoidance import limit
from sitl.autopilot.command_results import CommandResult
from sitl.autopilot.home import set_here
from sitl.autopilot.modes import ModeReason, ModeResult
from sitl.autopilot.navigation import state as kinds
from sitl.autopilot.navigation.state import GO_ON, LEG_ENDING
from sitl.autopilot.notes import Text
from sitl.autopilot.rover import pilot
from sitl.autopilot.rover.modes import acro, auto, circle, drive, guided, guided_setpoints, loiter, update
from sitl.autopilot.rover.modes.auto import AUTO
from sitl.autopilot.rover.modes.circle import CIRCLE, CIRCLE_ADAPTED, FELL_BEHIND, RADIUS_ENLARGED
from sitl.autopilot.rover.modes.guided import GUIDED
from sitl.autopilot.rover.modes.hold import HOLD
from sitl.autopilot.rover.modes.loiter import LOITER
from sitl.autopilot.rover.modes.manual import MANUAL
from sitl.autopilot.rover.modes.mode import no_destination
from sitl.autopilot.rover.modes.set_mode import change_speed, request
from sitl.autopilot.rover.modes.state import AutoState, CircleState, GuidedState, LoiterState, Modes
from sitl.autopilot.rover.modes.table import MODES
from sitl.core.algebra import ZERO2
from sitl.core.mavlink import MavSeverity
from sitl.core.vectors import Vec2, Vec3
from tests.autopilot.rover.modes.driven_rover import Rover

BY_NUMBER = {mode.number: mode for mode in MODES}


def said(rover: Rover) -> list[tuple[float, float]]:
    """CIRCLE_ADAPTED since the last call: (what, value)."""
    return [(a, b) for code, a, b in rover.events() if code == CIRCLE_ADAPTED]


@pytest.mark.parametrize(
    ("radius", "turn", "wanted"), ((0.4, 0.0, 0.1), (0.5, 0.0, 0.2), (20.0, 0.9, 0.9), (0.4, 0.05, 0.1))
)
def test_so_near_to_its_edge_it_is_on_it(radius: float, turn: float, wanted: float) -> None:
    assert circle.tolerance(radius, turn) == wanted


@pytest.mark.parametrize(
    ("radius", "turn", "wanted", "told"),
    (
        (20.0, 0.9, 20.0, False),
        (-20.0, 0.9, 20.0, False),
        (0.0, 0.0, 0.1, False),
        (0.5, 0.9, 0.9, True),
        (0.9, 0.9, 0.9, False),
    ),
)
def test_a_radius_is_one_that_the_vehicle_can_drive(
    rover: Rover, radius: float, turn: float, wanted: float, told: bool
) -> None:
    state = rover.ap.modes.circle
    circle.set_radius(state, rover.ap.events, 5, radius, turn)
    assert state.radius == pytest.approx(wanted)
    assert said(rover) == ([(float(RADIUS_ENLARGED), pytest.approx(wanted))] if told else [])


@pytest.mark.parametrize(
    ("what", "value", "text"),
    (
        (0, 3.456, "Circle: max speed is  3.5"),
        (1, 12.34, "Circle: radius increased to TURN_RADIUS (12.3)"),
        (2, 3.456, "Circle: cannot keep up, slowing to 3.5m/s"),
    ),
)
def test_what_a_circle_says(what: int, value: float, text: str) -> None:
    assert CIRCLE_ADAPTED.notes(None, float(what), value) == [Text(MavSeverity.WARNING, text)]


@pytest.mark.parametrize(
    ("own", "decel", "waypoint", "wanted"),
    (
        (1.5, 0.0, 0.0, 1.5),
        (1.5, 1.2, 0.0, 1.2),
        (1.5, 0.0, 0.7, 0.7),
        (1.5, 0.0, 9.0, 1.5),
        (0.0, 0.0, 0.0, 1.0),
        (0.0, 0.0, 0.4, 0.4),
    ),
)
def test_the_acceleration_of_a_circle(rover: Rover, own: float, decel: float, waypoint: float, wanted: float) -> None:
    p = rover.ap.params
    p.ATC.ACCEL_MAX, p.ATC.DECEL_MAX, p.WP.ACCEL = own, decel, waypoint
    assert circle.acceleration(p) == pytest.approx(wanted)


@pytest.mark.parametrize(("jerk", "wanted"), ((0.0, 0.7), (2.0, 2.0)))
def test_limits_of_a_circle_go_to_the_position_controller(rover: Rover, jerk: float, wanted: float) -> None:
    p, c, state = rover.ap.params, rover.ap.control.position, rover.ap.modes.circle
    p.WP.JERK, p.WP.ACCEL, state.speed = jerk, 0.7, 2.5
    circle.set_limits(c, state, p)
    assert (c.speed_max, c.accel_max, c.jerk_max) == pytest.approx((2.5, 0.7, wanted))


@pytest.mark.parametrize(("choice", "direction"), ((0.0, 1.0), (1.0, -1.0), (2.0, 1.0)))
def test_circ_dir_says_which_way_round(rover: Rover, choice: float, direction: float) -> None:
    rover.ap.params.CIRC.DIR, rover.ap.params.CIRC.RADIUS = choice, 10.0
    rover.place(3.0, 4.0, 0.5)
    assert circle.start(rover.v) == ModeResult.ACCEPTED
    state = rover.ap.modes.circle
    assert (state.direction, state.centre, state.angle) == (direction, (3.0, 4.0), pytest.approx(0.5))
    assert state.target == pytest.approx((3.0 + 10.0 * math.cos(0.5), 4.0 + 10.0 * math.sin(0.5)))


@pytest.mark.parametrize(("own", "wanted"), ((0.0, 5.0), (2.0, 2.0)))
def test_the_speed_of_a_circle_is_circ_speed_or_wp_speed(rover: Rover, own: float, wanted: float) -> None:
    rover.ap.params.CIRC.SPEED, rover.ap.params.CIRC.RADIUS = own, 30.0
    circle.start(rover.v)
    assert rover.ap.modes.circle.speed == pytest.approx(wanted)


def test_without_an_origin_there_is_no_circle(rover: Rover) -> None:
    rover.ap.estimate.origin_set = 0
    assert circle.start(rover.v) == loiter.start(rover.v) == ModeResult.INIT_FAILED


def on_edge(**values: Any) -> CircleState:
    """A circle of 10 m around the origin, at its northern point."""
    state = CircleState()
    state.radius, state.direction, state.speed, state.at_edge = 10.0, 1.0, 2.0, True
    for name, value in values.items():
        setattr(state, name, value)
    return state


@pytest.mark.parametrize("direction", (1.0, -1.0))
def test_the_target_goes_round_with_its_acceleration_and_speed(rover: Rover, direction: float) -> None:
    state = on_edge(direction=direction)
    moves = [circle.advance(state, 1.0, rover.ap.estimate) for _ in range(300)]
    assert moves[0].vel == pytest.approx((0.0, 0.01 * direction), abs=1e-4), "half of the acceleration, for 20 ms"
    assert moves[0].acc.y == pytest.approx(0.5 * direction, abs=1e-3)
    last = moves[-1]
    assert math.hypot(*last.vel) == pytest.approx(2.0) and math.hypot(*last.acc) == pytest.approx(2.0 * 2.0 / 10.0)
    assert last.pos.x * last.vel.x + last.pos.y * last.vel.y == pytest.approx(0.0, abs=1e-9)
    assert last.pos.x * last.acc.x + last.pos.y * last.acc.y == pytest.approx(-4.0), "inwards"
    assert state.total * direction > 0.0 and circle.turns(state) == pytest.approx(abs(state.total) / math.tau)
    assert state.target == last.pos and math.hypot(*last.pos) == pytest.approx(10.0)


def test_a_target_that_waits_stays_beside_the_vehicle(rover: Rover) -> None:
    rover.place(0.0, 5.0)
    state = on_edge(waiting=True, total=1.0)
    circle.advance(state, 1.0, rover.ap.estimate)
    assert (state.angle, state.total) == (pytest.approx(math.pi / 2), 1.0)
    assert state.target == pytest.approx((0.0, 10.0), abs=1e-9)


@pytest.mark.parametrize(
    ("north", "waits_before", "behind", "waits", "speed"),
    (
        (12.1, False, True, True, 1.6),  # twice the tolerance of 1 m
        (11.9, False, False, False, 2.0),
        (8.1, False, False, False, 2.0),
        (7.9, False, True, True, 1.6),
        (12.1, True, False, True, 2.0),
        (11.1, True, False, True, 2.0),
        (10.9, True, False, False, 2.0),  # near again
    ),
)
def test_a_vehicle_that_falls_behind_gets_a_slower_circle(
    rover: Rover, north: float, waits_before: bool, behind: bool, waits: bool, speed: float
) -> None:
    rover.place(north, 0.0)
    state = on_edge(waiting=waits_before)
    assert circle.follow(state, rover.ap.control.position, rover.ap.estimate, 1.0) is behind
    assert (bool(state.waiting), state.speed) == (waits, pytest.approx(speed))


@pytest.mark.parametrize(("north", "there"), ((11.0, True), (11.01, False)))
def test_first_it_drives_to_the_edge(rover: Rover, north: float, there: bool) -> None:
    rover.place(north, 0.0)
    state = on_edge(at_edge=False, target=Vec2(10.0, 0.0))
    assert not circle.follow(state, rover.ap.control.position, rover.ap.estimate, 1.0)
    assert bool(state.at_edge) == there and state.total == 0.0


def test_falling_behind_is_told_with_the_new_speed(rover: Rover) -> None:
    assert request(rover.v, CIRCLE, ModeReason.GCS) == 0
    state = rover.ap.modes.circle
    state.at_edge, state.speed = True, 2.0
    rover.place(500.0, 0.0)
    rover.events()
    rover.step()
    assert said(rover) == [(float(FELL_BEHIND), pytest.approx(1.6))]


def test_without_a_position_a_circle_stops(rover: Rover) -> None:
    assert request(rover.v, CIRCLE, ModeReason.GCS) == 0
    rover.place(0.0, 0.0, speed=2.0)
    rover.ap.estimate.position_ok = 0
    rover.ap.control.motors.steering = 0.7
    circle.run(rover.v)
    assert rover.ap.control.motors.steering == 0.0


@pytest.mark.parametrize(
    ("wanted", "taken", "limit_raised"),
    ((3.0, True, True), (1.0, True, False), (0.0, False, False), (-1.0, False, False)),
)
def test_a_circle_takes_a_new_speed(rover: Rover, wanted: float, taken: bool, limit_raised: bool) -> None:
    rover.ap.params.CIRC.SPEED = 2.0
    assert request(rover.v, CIRCLE, ModeReason.GCS) == 0
    assert circle.change_speed(rover.v, wanted) is taken
    assert rover.ap.modes.circle.speed == pytest.approx(wanted if taken else 2.0)
    assert rover.ap.control.position.speed_max == pytest.approx(wanted if limit_raised else 2.0)


@pytest.mark.parametrize(
    ("kind", "place", "yaw", "heading", "speed"),
    (
        (0, (0.0, 6.0), 0.0, 90.0, 0.5),  # at a right angle at half the speed
        (0, (6.0, 0.0), 0.0, 0.0, 1.0),
        (0, (-6.0, 0.0), 0.0, 0.0, -1.0),  # backwards: it is nearer
        (1, (-6.0, 0.0), 0.0, 180.0, 0.5),
        (2, (6.0, 0.0), 0.0, 180.0, -0.5),
        (2, (-6.0, 0.0), 0.0, 0.0, -1.0),
        (0, (60.0, 0.0), 0.0, 0.0, 5.0),  # no faster than WP_SPEED
        (0, (0.0, 6.0), math.pi / 2, 90.0, 1.0),  # it points there
        (0, (0.0, 6.0), -math.pi / 2, -90.0, -1.0),
        (0, (0.0, 6.0), math.pi / 4, 90.0, 0.75),
    ),
)
def test_the_way_back_of_loiter(
    rover: Rover, kind: int, place: tuple[float, float], yaw: float, heading: float, speed: float
) -> None:
    """LOIT_TYPE; 4 m beyond LOIT_RADIUS 2 m with LOIT_SPEED_GAIN 0.25 are 1 m/s."""
    p, state = rover.ap.params, LoiterState()
    p.LOIT.TYPE, p.LOIT.RADIUS, p.LOIT.SPEED_GAIN = float(kind), 2.0, 0.25
    state.place, state.distance = Vec2(*place), math.hypot(*place)
    loiter.aim(state, ZERO2, yaw, p)
    assert abs(math.remainder(math.degrees(state.heading) - heading, 360.0)) == pytest.approx(0.0, abs=1e-6)
    assert state.speed == pytest.approx(speed)


@pytest.mark.parametrize(("away", "drives"), ((2.0, False), (2.01, True)))
def test_within_loit_radius_it_stays(rover: Rover, away: float, drives: bool) -> None:
    rover.ap.params.LOIT.RADIUS = 2.0
    assert request(rover.v, LOITER, ModeReason.GCS) == 0
    state = rover.ap.modes.loiter
    state.place, state.speed = Vec2(away, 0.0), 3.0
    rover.ap.control.speed.last_tick = -1000
    loiter.run(rover.v)
    assert (state.speed > 0.0) == drives and state.distance == pytest.approx(away)


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


def test_steering_and_throttle_are_cut_and_a_heading_is_wrapped(rover: Rover) -> None:
    request(rover.v, GUIDED, ModeReason.GCS)
    state = rover.ap.modes.guided
    assert guided_setpoints.set_steering_and_throttle(rover.ap.modes, 9, 3.0, -3.0) == CommandResult.OK
    assert (state.steering, state.throttle, state.submode, state.update_us) == (
        1.0,
        -1.0,
        guided.STEERING_AND_THROTTLE,
        9,
    )
    guided_setpoints.set_heading_and_speed(rover.ap.modes, 9, 1.5 * math.pi, 2.0)
    assert (state.heading, state.speed) == (pytest.approx(-0.5 * math.pi), 2.0)
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


def done(kind: int, submode: int = auto.STOPPED, seconds: float = 9.0, pos: Vec2 = ZERO2, **nav: Any) -> bool:
    """Whether a command is done ``seconds`` after its position was reached (``since_us``)."""
    modes = Modes()
    modes.nav.command_kind, modes.auto.submode, modes.nav.since_us = kind, submode, 1_000_000
    for name, value in nav.items():
        setattr(modes.nav, name, value)
    return bool(auto.is_done(modes, 1_000_000 + round(seconds * 1e6), pos, 2.0))


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
    got = done(kinds.GUIDED, auto.GUIDED_IN_MISSION, pos=pos, has_place=place, target=Vec3(10.0, 0.0, 0.0))
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
    modes.number, modes.circle.target, modes.loiter.place = AUTO, Vec2(1.0, 2.0), Vec2(3.0, 4.0)
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


def test_modes_without_a_path_take_no_speed(rover: Rover) -> None:
    for number in (MANUAL, HOLD, LOITER):
        request(rover.v, number, ModeReason.GCS)
        assert not BY_NUMBER[number].change_speed(rover.v, 2.0)


def test_acro_drives_by_its_sticks_also_while_its_speed_is_not_known(rover: Rover) -> None:
    request(rover.v, acro.ACRO, ModeReason.GCS)
    rover.sticks(steering=1900, throttle=1800)
    rover.run(1.0)
    assert rover.speed > 0.5 and rover.heading > 0.1
    control = rover.ap.control
    control.speed.forward_ok, control.motors.throttle = 0, 0.0
    acro.run(rover.v)
    wanted = pilot.limited_sticks(rover.ap.modes.pilot, control.motors.throttle_last, rover.ap.params)
    assert control.motors.throttle == pytest.approx(wanted.throttle) and wanted.throttle > 0.1


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


def test_the_end_of_a_detour_is_told_to_the_shell(rover: Rover) -> None:
    rover.ap.modes.nav.request_pending = GO_ON
    update.update([rover.v], 0)
    assert LEG_ENDING in [code for code, _, _ in rover.events()]


def test_the_steering_stick_arms_and_disarms_after_two_seconds() -> None:
    rover = Rover()
    rover.run(1.1)
    rover.ap.params.ARMING.RUDDER = 2.0
    rover.sticks(steering=2000, throttle=1500)
    rover.run(1.9)
    assert not rover.ap.arming.armed
    rover.run(0.3)
    assert rover.ap.arming.armed
    rover.sticks(steering=1500)
    rover.run(0.1)
    rover.events()
    rover.sticks(steering=1000)
    rover.run(2.3)
    assert not rover.ap.arming.armed
    assert (DISARMED, float(ArmingMethod.RUDDER)) in [(code, a) for code, a, _ in rover.events()]


@pytest.mark.parametrize(
    ("armed", "locked", "located", "moves"), ((0, 0, 1, True), (1, 0, 1, False), (0, 1, 1, False), (0, 0, 0, False))
)
def test_home_follows_a_disarmed_rover(armed: int, locked: int, located: int, moves: bool) -> None:
    rover = Rover()
    home, est = rover.ap.home, rover.ap.estimate
    set_here(home, est)
    home.locked, est.position_ok = locked, located
    est.pos = Vec3(50.0, 0.0, 0.0)
    update.follow_home(home, est, bool(armed))
    assert (home.pos.x == 50.0) == moves
    est.pos = Vec3(50.0 + (update.HOME_MOVES - 0.01), 0.0, -99.0)
    update.follow_home(home, est, bool(armed))
    assert home.pos.x != est.pos.x, "not for less than its step"
    est.pos = Vec3(50.0 + update.HOME_MOVES, 0.0, 0.0)
    update.follow_home(home, est, bool(armed))
    assert (home.pos.x == est.pos.x) == moves
