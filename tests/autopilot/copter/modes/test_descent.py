# SPDX-License-Identifier: BSD-3-Clause
"""Descents, with and without a position; what AUTO begins and when its commands are done; headings under way."""

from __future__ import annotations

import math
from typing import Any

import pytest

from sitl.autopilot.arming_checks import DISARMED, ArmingMethod
from sitl.autopilot.command_results import CommandResult
from sitl.autopilot.copter.control.spool import DesiredSpoolState, SpoolState
from sitl.autopilot.copter.control.state import AltitudeState
from sitl.autopilot.copter.modes import auto, auto_yaw, commands, descent, guided, land, precision_land
from sitl.autopilot.copter.modes import takeoff as takeoff_mode
from sitl.autopilot.copter.modes.auto import CIRCLE_BEGINS
from sitl.autopilot.copter.modes.state import Modes
from sitl.autopilot.copter.navigation.planner import PLANNER
from sitl.autopilot.copter.parameters.flight import Land
from sitl.autopilot.modes import ModeReason, ModeResult
from sitl.autopilot.navigation import state as kinds
from sitl.autopilot.navigation.state import COMPLETE, RUNNING
from sitl.core.vectors import Vec2, Vec3
from tests.autopilot.copter.modes.obedient_copter import MODE, hovering, move, standing, ticks, turn_body
from tests.autopilot.copter.steady_copter import told, wait

FULL = DesiredSpoolState.THROTTLE_UNLIMITED
DT = 0.0025


def landing(height: float = 30.0, located: bool = True, **params: float) -> Any:
    """In LAND; ``params``: LAND_*."""
    v = hovering("LAND", height)
    for name, value in params.items():
        v.autopilot.params.LAND[name] = value
    v.autopilot.estimate.position_ok = located
    assert land.start(v) == ModeResult.ACCEPTED
    return v


@pytest.mark.parametrize("located", (True, False))
def test_it_lands_with_a_position_where_there_is_one(located: bool) -> None:
    v = landing(located=located)
    ticks(v, MODE["LAND"].run)
    control = v.autopilot.control
    assert bool(v.autopilot.modes.land.with_position) == located
    assert (control.pos_ne.last_tick == control.tick) == located
    assert control.pos_d.accel_desired > 0.0 and control.motors.desired_spool == FULL


@pytest.mark.parametrize(("reposition", "lean"), ((1.0, 30.0), (0.0, 0.0)))
def test_without_a_position_the_sticks_lean_it_where_they_may_move_it(reposition: float, lean: float) -> None:
    v = landing(located=False, REPOSITION=reposition)
    v.autopilot.modes.pilot.roll, v.autopilot.modes.pilot.yaw_rate = 1.0, 0.4
    ticks(v, MODE["LAND"].run)
    target = v.autopilot.control.attitude.target_euler
    assert math.degrees(target.roll) == pytest.approx(lean)
    assert target.yaw == pytest.approx(0.4 * DT, rel=0.3)


def test_with_a_position_the_sticks_move_it_and_it_softens_where_it_may_stand() -> None:
    v = landing()
    ap = v.autopilot
    ap.modes.pilot.pitch = -1.0
    descent.descend(ap.modes, 30.0, False, ap.control, ap.estimate, ap.params)
    assert ap.control.pos_ne.accel_desired.x > 0.0
    ap.control.pos_ne.last_tick, ap.control.pos_ne.pos_desired = ap.control.tick, Vec2(1.0, 0.0)
    descent.descend(ap.modes, 30.0, True, ap.control, ap.estimate, ap.params)
    assert ap.control.pos_ne.pos_desired.x == pytest.approx(1.0 - DT / (DT + 0.16), abs=1e-4)


def test_a_descent_begins_anew() -> None:
    v = landing()
    state = v.autopilot.modes.land
    state.pause, state.repositioned, state.stage, state.tries, state.with_position = 1, 1, 2, 3, 0
    v.autopilot.modes.auto_yaw.mode = auto_yaw.ROI
    wait(v, 1.0)
    descent.begin(v.autopilot.modes, v.time_us, v.autopilot.control, v.autopilot.estimate, v.autopilot.params)
    assert (state.pause, state.repositioned, state.stage, state.tries, state.with_position) == (0, 0, 0, 0, 1)
    assert state.start_us == v.time_us and v.autopilot.modes.auto_yaw.mode == auto_yaw.HOLD


@pytest.mark.parametrize(
    ("height", "slow", "fast", "low", "limit", "rate"),
    (
        (100.0, 50.0, 0.0, 1000.0, 1.5, 1.5),  # LAND_SPEED_HIGH 0: that of descents
        (100.0, 50.0, 80.0, 1000.0, 1.5, 0.8),
        (100.0, 90.0, 80.0, 1000.0, 1.5, 0.9),  # not slower than near the ground
        (9.0, 50.0, 0.0, 1000.0, 1.5, 0.5),
        (10.7, 50.0, 0.0, 1000.0, 1.5, 0.7),  # between
        (5.0, -50.0, 0.0, 1000.0, 1.5, 0.5),
        (1.7, 50.0, 0.0, 0.0, 1.5, 0.7),  # LAND_ALT_LOW is a metre at least
    ),
)
def test_how_fast_it_sinks(height: float, slow: float, fast: float, low: float, limit: float, rate: float) -> None:
    p, limits = Land(), AltitudeState()
    p.SPEED, p.SPEED_HIGH, p.ALT_LOW = slow, fast, low
    limits.speed_down, limits.accel_max = limit, 1.0
    assert descent.sink_rate(height, limits, p, 1.0) == pytest.approx(rate)


@pytest.mark.parametrize(
    ("pause", "height", "maybe", "at_limit", "sinks"),
    ((1, 30.0, False, 0.0, False), (0, 30.0, False, 1.0, True), (0, 9.9, False, 0.0, True), (0, 30.0, True, 0.0, True)),
)
def test_near_the_ground_it_goes_on_at_the_least_throttle(
    pause: int, height: float, maybe: bool, at_limit: float, sinks: bool
) -> None:
    v = landing()
    ap = v.autopilot
    ap.control.pos_d.limit, ap.modes.land.pause = 1.0 if not pause else 0.0, pause
    descent.sink(ap.control.pos_d, ap.modes.land, height, maybe, ap.params)
    assert ap.control.pos_d.limit == at_limit and (ap.control.pos_d.accel_desired > 0.0) == sinks


@pytest.mark.parametrize(
    ("roll", "pitch", "yaw", "wanted"),
    (
        (1.0, 0.0, 0.0, (0.0, 1.0)),
        (0.0, -1.0, 0.0, (1.0, 0.0)),
        (0.0, -1.0, math.pi / 2, (0.0, 1.0)),
        (1.0, -1.0, 0.0, (math.sqrt(0.5), math.sqrt(0.5))),  # a diagonal is no faster
        (0.0, 0.0, 1.0, (0.0, 0.0)),
    ),
)
def test_the_sticks_move_the_landing(roll: float, pitch: float, yaw: float, wanted: tuple[float, float]) -> None:
    """As fast as half a second of WPNAV_ACCEL gives."""
    v = landing()
    v.autopilot.params.WPNAV.ACCEL = 200.0
    v.autopilot.modes.pilot.roll, v.autopilot.modes.pilot.pitch = roll, pitch
    assert descent.stick_velocity(v.autopilot.modes.pilot, yaw, v.autopilot.params) == pytest.approx(wanted)


@pytest.mark.parametrize(("located", "name"), ((1, "LOITER"), (0, "ALT_HOLD")))
def test_a_landing_that_the_throttle_cancels_goes_on_in_a_mode_of_the_pilot(located: int, name: str) -> None:
    v = landing(located=bool(located))
    v.autopilot.params.PILOT.THR_BHV, v.autopilot.modes.pilot.throttle = 2.0, 0.71
    ticks(v, MODE["LAND"].run)
    modes = v.autopilot.modes
    assert (modes.wanted, modes.wanted_reason) == (MODE[name].number + 1, ModeReason.THROTTLE_LAND_ESCAPE)


@pytest.mark.parametrize(
    ("armed", "landed", "spool", "rests", "stays_armed"),
    (
        (1, 1, SpoolState.THROTTLE_UNLIMITED, 1, 1),
        (1, 1, SpoolState.GROUND_IDLE, 0, 0),
        (0, 1, SpoolState.SHUT_DOWN, 0, 0),
    ),
)
def test_on_the_ground_it_rests_and_disarms_once_it_idles(
    armed: int, landed: int, spool: int, rests: int, stays_armed: int
) -> None:
    v = landing(0.0)
    ap = v.autopilot
    ap.arming.armed, ap.arming.landed, ap.control.motors.spool_state = armed, landed, spool
    ticks(v, MODE["LAND"].run)
    assert (ap.control.motors.desired_spool, ap.arming.armed) == (rests, stays_armed)


@pytest.mark.parametrize(("stage", "height"), ((precision_land.CLIMBING, -13.0), (precision_land.RETURNING, -10.0)))
def test_it_flies_back_to_where_it_saw_its_target(stage: int, height: float) -> None:
    v = landing()
    ap = v.autopilot
    ap.modes.land.stage, ap.params.PLND.STRICT = stage, 1.0
    ap.landing_target.seen_from = ap.landing_target.last_place = Vec3(3.0, 4.0, -10.0)
    goal = precision_land.position_to_try(ap.modes.land, ap.landing_target, ap.params.PLND)
    assert goal.z <= -10.0 and (goal.z < -10.0) == (stage == precision_land.CLIMBING)
    precision_land.fly_back(v)
    path = ap.control.pos_ne
    assert path.accel_desired.x > 0.0 and path.accel_desired.y > 0.0 and ap.control.pos_d.accel_desired > 0.0
    assert path.last_tick == ap.control.pos_d.last_tick == ap.control.tick
    assert height <= goal.z


@pytest.mark.parametrize(
    ("off", "near"), ((0.0, True), (precision_land.NEAR - 1e-6, True), (precision_land.NEAR, False))
)
def test_it_is_there_within_a_distance_in_space(off: float, near: bool) -> None:
    for way in (Vec3(off, 0.0, 0.0), Vec3(0.0, -off, 0.0), Vec3(0.0, 0.0, off)):
        assert precision_land.is_near(Vec3(0.0, 0.0, 0.0), way) == near


def mission(kind: int = kinds.WAYPOINT, **nav: Any) -> Any:
    """In AUTO, given a command of a kind."""
    v = hovering("AUTO")
    ap = v.autopilot
    ap.modes.mission_count, ap.home.is_set = 5, 1
    assert auto.start(v) == ModeResult.ACCEPTED
    PLANNER.begin(ap, v.time_us, Vec3(20.0, 0.0, -10.0))
    ap.modes.nav.mission_state, ap.modes.nav.has_place = RUNNING, 1
    for name, value in nav.items():
        setattr(ap.modes.nav, name, value)
    ap.modes.nav.command_kind = kind
    ap.modes.nav.command_count += 1
    return v


def begun(kind: int, **nav: Any) -> Any:
    v = mission(kind, **nav)
    auto.begin(v)
    assert (v.autopilot.modes.auto.submode, v.autopilot.modes.auto.command) == (
        kind,
        v.autopilot.modes.nav.command_count,
    )
    return v.autopilot


def test_a_take_off_command_begins_one_to_its_height() -> None:
    v = mission(kinds.TAKEOFF, target=Vec3(0.0, 0.0, -25.0))
    v.autopilot.modes.takeoff.complete = 1
    auto.begin(v)
    assert (v.autopilot.modes.takeoff.target_d, v.autopilot.modes.takeoff.complete) == (-25.0, 0)


def test_an_rtl_command_begins_the_way_home() -> None:
    ap = begun(kinds.RTL)
    assert ap.modes.rtl.state == 1 and ap.modes.nav.request_pending == 2


def test_a_guided_command_begins_its_limits() -> None:
    v = mission(kinds.GUIDED)
    v.autopilot.modes.guided.paused = 1
    v.autopilot.estimate.pos = Vec3(3.0, 4.0, -10.0)
    auto.begin(v)
    state = v.autopilot.modes.guided
    assert (state.limit_since_us, state.limit_from, state.paused) == (v.time_us, (3.0, 4.0), 0)
    assert auto.is_guided(v.autopilot.modes)


def test_a_land_command_flies_to_its_position_or_lands_at_once() -> None:
    assert begun(kinds.LAND, has_place=1).modes.auto.land_state == auto.FLYING
    assert begun(kinds.LAND, has_place=0).modes.auto.land_state == auto.DESCENDING


@pytest.mark.parametrize(("state", "lands"), ((auto.FLYING, False), (auto.DESCENDING, True)))
def test_a_mission_lands_from_the_descent_on(state: int, lands: bool) -> None:
    modes = Modes()
    modes.auto.submode, modes.auto.land_state = kinds.LAND, state
    assert bool(auto.is_landing(modes)) == lands
    modes.auto.submode, modes.rtl.state = kinds.RTL, 5 if lands else 2
    assert bool(auto.is_landing(modes)) == lands
    modes.auto.submode, modes.auto.land_state = kinds.WAYPOINT, auto.DESCENDING
    assert not auto.is_landing(modes)


@pytest.mark.parametrize(
    ("submode", "complete", "takes_off"), ((kinds.TAKEOFF, 0, 1), (kinds.TAKEOFF, 1, 0), (kinds.LAND, 0, 0))
)
def test_a_mission_takes_off_until_that_is_complete(submode: int, complete: int, takes_off: int) -> None:
    modes = Modes()
    modes.auto.submode, modes.takeoff.complete = submode, complete
    assert bool(auto.is_taking_off(modes)) == bool(takes_off)


@pytest.mark.parametrize(
    ("armed", "started", "options", "commanded"), ((1, 1, 0.0, 1), (1, 0, 0.0, 0), (1, 0, 2.0, 1), (0, 1, 0.0, 0))
)
def test_a_take_off_waits_for_the_mission_to_be_started(
    armed: int, started: int, options: float, commanded: int
) -> None:
    v = mission(kinds.TAKEOFF)
    ap = v.autopilot
    ap.arming.armed, ap.arming.auto_armed, ap.arming.landed = armed, 0, 1
    ap.modes.auto.started, ap.params.AUTO_OPTIONS = started, options
    assert not auto.run_command(v, kinds.TAKEOFF)
    assert ap.arming.auto_armed == commanded
    ap.modes.takeoff.complete = 1
    assert auto.run_command(v, kinds.TAKEOFF)


@pytest.mark.parametrize(("landed", "state", "done"), ((1, 5, True), (0, 5, False), (1, 2, False)))
def test_an_rtl_command_is_done_on_the_ground(landed: int, state: int, done: bool) -> None:
    v = mission(kinds.RTL)
    v.autopilot.arming.landed, v.autopilot.modes.rtl.state = landed, state
    assert auto.run_command(v, kinds.RTL) == done


@pytest.mark.parametrize(
    ("armed", "landed", "state", "stays"), ((1, 1, COMPLETE, 0), (1, 1, RUNNING, 1), (1, 0, COMPLETE, 1))
)
def test_on_the_ground_after_its_mission_it_disarms(armed: int, landed: int, state: int, stays: int) -> None:
    v = mission()
    ap = v.autopilot
    ap.arming.armed, ap.arming.auto_armed, ap.arming.landed, ap.modes.nav.mission_state = armed, 0, landed, state
    auto.run_path(v, kinds.WAYPOINT)
    assert (ap.arming.armed, ap.control.motors.desired_spool) == (stays, 1 if stays else 0)
    if not stays:
        assert [a for a, _ in told(v, DISARMED)] == [float(ArmingMethod.MISSION_EXIT)]


@pytest.mark.parametrize(
    ("kind", "seconds", "done"), ((kinds.DELAY, 5.0, True), (kinds.DELAY, 4.9, False), (kinds.WAYPOINT, 5.0, False))
)
def test_a_delay_runs_on_the_ground_as_well(kind: int, seconds: float, done: bool) -> None:
    v = mission(kind, delay=5.0)
    v.autopilot.arming.landed, v.autopilot.modes.nav.since_us = 1, v.time_us
    wait(v, seconds)
    assert auto.run_path(v, kind) == done


def test_a_command_without_a_path_holds_its_position() -> None:
    v = mission(kinds.NONE)
    move(v, 2.0, 0.0, 0.0)
    v.autopilot.control.pos_ne.last_tick = 0
    assert not ticks(v, lambda v: auto.run_path(v, kinds.NONE), 20)
    assert 0.0 < v.autopilot.control.pos_ne.vel_desired.x < 2.0
    assert v.autopilot.control.motors.desired_spool == FULL


def test_a_waypoint_is_flown_to_with_the_motors_at_full_power() -> None:
    v = mission()
    v.autopilot.control.motors.desired_spool = DesiredSpoolState.GROUND_IDLE
    ticks(v, auto.run, 100)
    assert v.autopilot.control.pos_ne.vel_desired.x > 0.005 and v.autopilot.control.motors.desired_spool == FULL


def test_circles_of_a_mission_are_told_when_they_begin() -> None:
    v = mission(kinds.LOITER_TURNS)
    nav = v.autopilot.modes.nav
    nav.turns = 2.0
    for total in (0.0, 1.0, 6.3, 6.4, 12.6, -12.7):
        nav.circle_total = total
        auto.report_circle(nav, v.autopilot.events, v.time_us)
    assert told(v, CIRCLE_BEGINS) == [(1.0, 2.0), (2.0, 2.0), (3.0, 2.0)]


@pytest.mark.parametrize(
    ("options", "kind", "turns"), ((0.0, kinds.WAYPOINT, 1), (128.0, kinds.WAYPOINT, 0), (0.0, kinds.GUIDED, 0))
)
def test_the_yaw_stick_turns_it_unless_auto_options_says_no(options: float, kind: int, turns: int) -> None:
    """In GUIDED within a mission GUID_OPTIONS decides."""
    v = mission(kind)
    v.autopilot.params.AUTO_OPTIONS, v.autopilot.params.GUID.OPTIONS = options, 4.0
    v.autopilot.modes.pilot.yaw_rate = 0.5
    ticks(v, auto.run)
    assert (v.autopilot.modes.auto_yaw.mode == auto_yaw.PILOT_RATE) == bool(turns)


@pytest.mark.parametrize(
    ("kind", "reached", "on_path"),
    (
        (kinds.WAYPOINT, 0, True),
        (kinds.WAYPOINT, 1, False),
        (kinds.LOITER_UNLIMITED, 0, True),
        (kinds.LOITER_TIME, 0, True),
        (kinds.LAND, 0, False),
    ),
)
@pytest.mark.parametrize("name", ("AUTO", "GUIDED", "GUIDED_NOGPS", "LOITER"))
def test_where_a_pause_is_taken(name: str, kind: int, reached: int, on_path: bool) -> None:
    modes = Modes()
    modes.number, modes.nav.command_kind, modes.nav.reached = MODE[name].number, kind, reached
    code = commands.set_paused(modes, True)
    if name == "LOITER":
        assert code == CommandResult.WRONG_MODE
    elif name == "AUTO":
        assert code == (CommandResult.OK if on_path else CommandResult.NOT_ON_A_PATH)
        assert bool(modes.nav.paused) == on_path and not modes.guided.paused
        assert commands.set_paused(modes, False) == CommandResult.OK and not modes.nav.paused
    else:
        assert (code, modes.guided.paused, modes.nav.paused) == (CommandResult.OK, 1, 0)


@pytest.mark.parametrize(("kind", "index"), ((commands.HORIZONTAL, 0), (commands.CLIMB, 1), (commands.DESCENT, 2)))
def test_each_speed_is_changed_alone(kind: int, index: int) -> None:
    v = hovering("GUIDED")
    ap = v.autopilot
    guided.start(v)

    def speeds() -> list[float]:
        c, d = ap.control.pos_ne, ap.control.pos_d
        return [float(c.speed_max), float(d.speed_up), float(d.speed_down), float(c.accel_max), float(d.accel_max)]

    wanted = speeds()
    wanted[index] = 3.25
    assert commands.change_speed(ap.control, ap.params, kind, 3.25) == CommandResult.OK
    assert speeds() == wanted
    assert commands.change_speed(ap.control, ap.params, 7, 3.25) == CommandResult.OUT_OF_RANGE


def test_without_a_position_attitudes_begin_level_at_the_heading_of_now() -> None:
    v = hovering("GUIDED_NOGPS")
    turn_body(v, 0.2, 0.1, 0.7)
    state = v.autopilot.modes.guided
    state.use_thrust, state.climb_rate, state.rates = 1, 2.0, Vec3(1.0, 0.0, 0.0)
    assert MODE["GUIDED_NOGPS"].start(v) == ModeResult.ACCEPTED
    ticks(v, MODE["GUIDED_NOGPS"].run)
    assert (state.submode, state.use_thrust, state.climb_rate) == (guided.ANGLE, 0, 0.0)
    assert v.autopilot.control.attitude.target_euler == pytest.approx((0.0, 0.0, 0.7), abs=1e-6)
    wait(v, 3.1)
    ticks(v, MODE["GUIDED_NOGPS"].run, 2)
    assert len(told(v, guided.GUIDED_TIMEOUT)) == 1


@pytest.mark.parametrize(
    ("mode", "heading", "rate", "absolute"),
    (
        (auto_yaw.HOLD, 0.0, 0.0, False),
        (auto_yaw.RATE, 0.0, 0.5, False),
        (auto_yaw.PILOT_RATE, 0.0, 0.5, False),
        (auto_yaw.ANGLE_RATE, 1.0 + 0.5 * 0.1, 0.5, True),
        (auto_yaw.CIRCLE, 1.0, 0.5, True),
        (auto_yaw.LOOK_AHEAD, math.pi / 2, 0.0, True),
        (auto_yaw.ROI, math.pi, 0.0, True),
        (auto_yaw.FIXED, 1.0, 0.0, True),
    ),
)
def test_headings_under_way(mode: int, heading: float, rate: float, absolute: bool) -> None:
    v = hovering("GUIDED")
    ap = v.autopilot
    yaw = ap.modes.auto_yaw
    yaw.mode, yaw.yaw, yaw.rate, yaw.roi = mode, 1.0, 0.5, Vec3(-5.0, 0.0, 0.0)
    move(v, 0.0, 1.01, 0.0)
    got = auto_yaw.advance(yaw, ap.control.pos_ne, ap.control.attitude, ap.estimate, 0.1)
    assert tuple(got) == pytest.approx((heading, rate, absolute))


@pytest.mark.parametrize(("speed", "east", "kept"), ((0.99, -5.0, False), (1.01, -5.0, True), (0.0, 0.09, False)))
def test_a_slow_course_and_a_point_below_say_nothing_of_the_heading(speed: float, east: float, kept: bool) -> None:
    v = hovering("GUIDED")
    ap = v.autopilot
    yaw = ap.modes.auto_yaw
    yaw.mode, yaw.look_ahead, yaw.yaw, yaw.roi = auto_yaw.LOOK_AHEAD, 0.3, 0.3, Vec3(0.0, east, 0.0)
    move(v, 0.0, speed, 0.0)
    got = auto_yaw.advance(yaw, ap.control.pos_ne, ap.control.attitude, ap.estimate, 0.1)
    assert (got.angle == pytest.approx(math.pi / 2)) == kept
    yaw.mode = auto_yaw.ROI
    got = auto_yaw.advance(yaw, ap.control.pos_ne, ap.control.attitude, ap.estimate, 0.1)
    assert (got.angle == 0.3) == (abs(east) <= 0.1)


@pytest.mark.parametrize(("speed", "follows"), ((0.51, True), (0.49, False)))
def test_the_nose_looks_along_a_path_faster_than_a_twentieth_of_its_speed(speed: float, follows: bool) -> None:
    v = hovering("GUIDED")
    ap = v.autopilot
    turn_body(v, 0.0, 0.0, 0.4)
    path = ap.control.pos_ne
    path.speed_max, path.vel_desired, path.accel_desired = 10.0, Vec2(0.0, speed), Vec2(-0.2, 0.0)
    rate = auto_yaw.look_along(ap.modes.auto_yaw, path, ap.control.attitude)
    assert ap.modes.auto_yaw.yaw == pytest.approx(math.pi / 2 if follows else 0.4)
    assert rate == pytest.approx(0.2 / speed if follows else 0.0)


@pytest.mark.parametrize(
    ("behaviour", "homeward", "mode"),
    (
        (0, False, auto_yaw.HOLD),
        (1, False, auto_yaw.LOOK_AT_NEXT_WP),
        (1, True, auto_yaw.LOOK_AT_NEXT_WP),
        (2, False, auto_yaw.LOOK_AT_NEXT_WP),
        (2, True, auto_yaw.HOLD),
        (3, True, auto_yaw.LOOK_AHEAD),
        (9, True, auto_yaw.LOOK_AT_NEXT_WP),
    ),
)
def test_wp_yaw_behavior(behaviour: int, homeward: bool, mode: int) -> None:
    assert auto_yaw.default_mode(behaviour, homeward) == mode


@pytest.mark.parametrize(
    ("rate", "fastest", "slew"),
    ((0.0, 1.0, 1.0), (0.5, 1.0, 0.5), (2.0, 1.0, 1.0), (2.0, 0.0, 2.0), (0.0, 0.0, 0.0), (1.0, 1.0, 1.0)),
)
def test_a_turn_is_no_faster_than_the_slew_rate(rate: float, fastest: float, slew: float) -> None:
    yaw = hovering("GUIDED").autopilot.modes.auto_yaw
    yaw.rate = 7.0
    auto_yaw.turn_to(yaw, auto_yaw.Turn(1.0, rate, 0, True), 0.2, fastest)
    assert (yaw.slew, yaw.yaw, yaw.offset, yaw.rate) == (slew, 0.2, 1.0, 0.0)
    auto_yaw.turn_to(yaw, auto_yaw.Turn(1.0, rate, -1, True), 5.0, fastest)
    assert (yaw.yaw, yaw.offset) == (0.2, -1.0), "repeated it goes on from where it is"


@pytest.mark.parametrize(
    ("mode", "offset", "heading", "turned"),
    (
        (auto_yaw.FIXED, 0.0, 0.034, True),
        (auto_yaw.FIXED, 0.0, 0.036, False),
        (auto_yaw.FIXED, 0.0, -0.034 - 2.0 * math.pi, True),
        (auto_yaw.FIXED, 0.01, 0.0, False),
        (auto_yaw.FIXED, -0.01, 0.0, False),
        (auto_yaw.RATE, 1.0, 3.0, True),
    ),
)
def test_a_turn_is_done_within_two_degrees(mode: int, offset: float, heading: float, turned: bool) -> None:
    yaw = hovering("GUIDED").autopilot.modes.auto_yaw
    yaw.mode, yaw.offset, yaw.yaw = mode, offset, 0.0
    assert auto_yaw.has_turned(yaw, heading) == turned


@pytest.mark.parametrize(
    ("rate", "lost", "mode"),
    (
        (2e-4, 0, auto_yaw.PILOT_RATE),
        (-2e-4, 0, auto_yaw.PILOT_RATE),
        (5e-5, 0, auto_yaw.FIXED),
        (0.5, 1, auto_yaw.FIXED),
    ),
)
def test_the_yaw_stick_takes_over_while_there_is_a_radio(rate: float, lost: int, mode: int) -> None:
    v = hovering("GUIDED")
    modes = v.autopilot.modes
    modes.auto_yaw.mode, modes.pilot.yaw_rate, modes.failsafe.radio = auto_yaw.FIXED, rate, lost
    auto_yaw.follow_pilot(modes, v.autopilot.control.attitude, v.autopilot.estimate)
    assert modes.auto_yaw.mode == mode


def test_on_the_ground_brake_rests_and_in_the_air_it_stops() -> None:
    v = standing("BRAKE")
    ticks(v, MODE["BRAKE"].run)
    assert v.autopilot.control.motors.desired_spool == DesiredSpoolState.GROUND_IDLE
    v = hovering("BRAKE")
    v.autopilot.control.motors.desired_spool = DesiredSpoolState.GROUND_IDLE
    move(v, 3.0, 0.0, 0.0)
    assert MODE["BRAKE"].start(v) == ModeResult.ACCEPTED
    ticks(v, MODE["BRAKE"].run, 40)
    assert 0.0 < v.autopilot.control.pos_ne.vel_desired.x < 3.0 and v.autopilot.control.motors.desired_spool == FULL


def test_a_take_off_is_announced_by_its_event_only_when_it_flies() -> None:
    v = mission(kinds.TAKEOFF, target=Vec3(0.0, 0.0, -25.0))
    v.autopilot.modes.auto.started = 1
    ticks(v, auto.run, 3)
    assert told(v, takeoff_mode.TAKEOFF_COMPLETE) == []
