# SPDX-License-Identifier: BSD-3-Clause
"""What AUTO begins for a command, how it flies it, and when it is done."""

from __future__ import annotations

from typing import Any

import pytest

from sitl.autopilot.arming_checks import DISARMED, ArmingMethod
from sitl.autopilot.command_results import CommandResult
from sitl.autopilot.copter.control.spool import DesiredSpoolState
from sitl.autopilot.copter.modes import auto, auto_yaw, mode_commands
from sitl.autopilot.copter.modes import takeoff as takeoff_mode
from sitl.autopilot.copter.modes.auto import CIRCLE_BEGINS
from sitl.autopilot.copter.modes.state import Modes
from sitl.autopilot.copter.navigation.planner import PLANNER
from sitl.autopilot.modes import ModeResult
from sitl.autopilot.navigation import state as kinds
from sitl.autopilot.navigation.state import COMPLETE, RUNNING
from sitl.core.vectors import Vec3
from tests.autopilot.copter.modes.obedient_copter import MODE, hovering, move, ticks
from tests.autopilot.copter.steady_copter import told, wait

FULL = DesiredSpoolState.THROTTLE_UNLIMITED
DT = 0.0025


def mission(kind: int = kinds.WAYPOINT, **nav: Any) -> Any:
    """In AUTO, given a command of a kind."""
    v = hovering("AUTO")
    ap = v.autopilot
    ap.modes.mission_count, ap.home.is_set = 5, 1
    assert auto.start(v) == ModeResult.ACCEPTED
    PLANNER.begin(ap, v.time_us, Vec3(20.0, 0.0, -10.0))
    ap.modes.nav.mission_state, ap.modes.nav.has_target = RUNNING, 1
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
    assert begun(kinds.LAND, has_target=1).modes.auto.land_state == auto.FLYING
    assert begun(kinds.LAND, has_target=0).modes.auto.land_state == auto.DESCENDING


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
    code = mode_commands.set_paused(modes, True)
    if name == "LOITER":
        assert code == CommandResult.WRONG_MODE
    elif name == "AUTO":
        assert code == (CommandResult.OK if on_path else CommandResult.NOT_ON_A_PATH)
        assert bool(modes.nav.paused) == on_path and not modes.guided.paused
        assert mode_commands.set_paused(modes, False) == CommandResult.OK and not modes.nav.paused
    else:
        assert (code, modes.guided.paused, modes.nav.paused) == (CommandResult.OK, 1, 0)


def test_a_take_off_is_announced_by_its_event_only_when_it_flies() -> None:
    v = mission(kinds.TAKEOFF, target=Vec3(0.0, 0.0, -25.0))
    v.autopilot.modes.auto.started = 1
    ticks(v, auto.run, 3)
    assert told(v, takeoff_mode.TAKEOFF_COMPLETE) == []
