# SPDX-License-Identifier: BSD-3-Clause
"""AUTO and AUTO_RTL: which command is flown, when it is done, and the way back of a mission."""

from __future__ import annotations

from typing import Any

import pytest

from sitl.autopilot.copter.modes import auto, auto_yaw, set_mode
from sitl.autopilot.copter.modes.auto import AUTO, AUTO_RTL, DESCENDING, FLYING
from sitl.autopilot.copter.modes.set_mode import go_back, may_go_back
from sitl.autopilot.mission.returning import RETURN_ACTIVE, RETURN_WANTED
from sitl.autopilot.modes import MODE_CHANGED, MODE_REFUSED, ModeReason, ModeResult
from sitl.autopilot.navigation import state as kinds
from sitl.autopilot.navigation.state import BEST, BY_LANDING, BY_PATH, COMPLETE, LANDING, OUTWARD, RETURN_PATH
from tests.autopilot.copter.steady_copter import fly, make, told

RETURNS = ((BEST, True, True), (BY_PATH, True, False), (BY_LANDING, False, True))
"""Ways back, and whether a return path and a landing sequence are such."""


def on_mission(mode: int = AUTO) -> Any:
    """In the air, with a mission of some items."""
    v = fly(make(), mode)
    v.autopilot.modes.mission_count = 5
    return v


@pytest.mark.parametrize(("way", "by_path", "by_landing"), RETURNS)
@pytest.mark.parametrize("has_path", (False, True))
@pytest.mark.parametrize("has_landing", (False, True))
def test_a_mission_brings_back_by_what_it_has(way, by_path, by_landing, has_path, has_landing):
    modes = on_mission().autopilot.modes
    modes.mission_returns, modes.mission_lands = has_path, has_landing
    assert may_go_back(modes, way) == ((by_path and has_path) or (by_landing and has_landing))


@pytest.mark.parametrize("mode", (AUTO, 4))
@pytest.mark.parametrize("way", (BEST, BY_LANDING, BY_PATH))
def test_auto_rtl_goes_on_in_auto_and_shows_it(way: int, mode: int) -> None:
    v = on_mission(mode)
    modes = v.autopilot.modes
    modes.mission_returns = modes.mission_lands = True
    assert go_back(v, way, ModeReason.RC) == ModeResult.ACCEPTED
    assert (modes.number, modes.shown, modes.reason, modes.nav.mission_part) == (AUTO, AUTO_RTL, ModeReason.RC, LANDING)
    assert told(v, RETURN_WANTED) == [(float(way), float(mode == AUTO))]
    assert told(v, MODE_CHANGED)[-1] == (float(AUTO_RTL), float(ModeReason.RC))
    assert set_mode.request(v, AUTO_RTL, ModeReason.GCS) == ModeResult.ACCEPTED  # again: nothing new
    assert len(told(v, RETURN_WANTED)) == 1


@pytest.mark.parametrize(
    ("way", "cause"),
    ((BEST, ModeResult.NO_RETURN), (BY_LANDING, ModeResult.NO_LANDING), (BY_PATH, ModeResult.NO_PATH)),
)
def test_without_a_way_back_it_is_refused_by_name(way: int, cause: int) -> None:
    v = on_mission(4)
    assert go_back(v, way, ModeReason.RC) == cause
    assert v.autopilot.modes.number == 4
    assert told(v, MODE_REFUSED) == [(float(AUTO_RTL), float(cause))]


@pytest.mark.parametrize("part", (RETURN_PATH, LANDING))
@pytest.mark.parametrize("way", (BEST, BY_LANDING, BY_PATH))
def test_on_the_way_back_already_it_goes_on_there(way: int, part: int) -> None:
    v = on_mission()
    modes = v.autopilot.modes
    modes.mission_lands, modes.nav.mission_part = True, part
    assert go_back(v, way, ModeReason.RC) == ModeResult.ACCEPTED
    active = way != BY_LANDING
    assert told(v, RETURN_ACTIVE) == ([(float(part), 0.0)] if active else [])
    assert len(told(v, RETURN_WANTED)) == int(not active)
    assert modes.nav.mission_part == part


def test_a_way_back_that_auto_refuses_is_not_shown() -> None:
    v = on_mission(4)
    modes = v.autopilot.modes
    modes.mission_returns, modes.mission_count = True, 0
    assert go_back(v, BEST, ModeReason.RC) == ModeResult.INIT_FAILED
    assert (modes.shown, modes.nav.mission_part) == (0, OUTWARD)


@pytest.mark.parametrize(
    ("shown", "part", "state", "ends"),
    (
        (AUTO_RTL, OUTWARD, 1, True),
        (AUTO_RTL, LANDING, 1, False),
        (AUTO_RTL, OUTWARD, COMPLETE, False),
        (0, OUTWARD, 1, False),
    ),
)
def test_auto_rtl_ends_when_the_mission_goes_on_elsewhere(shown: int, part: int, state: int, ends: bool) -> None:
    v = on_mission()
    modes = v.autopilot.modes
    modes.shown, modes.nav.mission_part, modes.nav.mission_state = shown, part, state
    auto.end_return(v)
    assert modes.shown == (0 if ends else shown)
    assert told(v, MODE_CHANGED) == ([(float(AUTO), float(ModeReason.AUTO_RTL_EXIT))] if ends else [])
    assert (modes.reason == ModeReason.AUTO_RTL_EXIT) == ends


RUNS = {
    kinds.TAKEOFF: "takeoff.run",
    kinds.LAND: "run_land",
    kinds.LOITER_TO_ALT: "loiter_to_alt.run",
    kinds.PAYLOAD_PLACE: "payload_place.run",
    kinds.RTL: "rtl.run",
    kinds.GUIDED: "guided.run",
    kinds.WAYPOINT: "run_path",
    kinds.PASSED_OVER: "run_path",
}


@pytest.mark.parametrize("kind", RUNS)
@pytest.mark.parametrize("done", (False, True))
def test_each_command_is_flown_by_its_own_law(kind: int, done: bool, monkeypatch: pytest.MonkeyPatch) -> None:
    v = on_mission()
    ap = v.autopilot
    ran: list[str] = []

    def stand_in(name: str) -> Any:
        def run(*args: Any) -> bool:
            ran.append(name)
            return done

        return run

    for name in set(RUNS.values()):
        module, _, law = name.rpartition(".")
        monkeypatch.setattr(getattr(auto, module) if module else auto, law, stand_in(name))
    monkeypatch.setattr(auto.guided, "is_at_limit", lambda *args: done)
    ap.modes.takeoff.complete = done
    ap.arming.landed, ap.modes.rtl.state = done, auto.rtl.LANDING
    assert bool(auto.run_command(v, kind)) == (done or kind == kinds.PASSED_OVER)
    assert ran == [RUNS[kind]]


@pytest.mark.parametrize(("landed", "state", "done"), ((1, 5, True), (0, 5, False), (1, 4, False)))
def test_rtl_of_a_mission_is_done_on_the_ground(landed, state, done, monkeypatch):
    v = on_mission()
    monkeypatch.setattr(auto.rtl, "run", lambda v: None)
    v.autopilot.arming.landed, v.autopilot.modes.rtl.state = landed, state
    assert bool(auto.run_command(v, kinds.RTL)) == done


@pytest.mark.parametrize(
    ("armed", "started", "options", "raised"),
    ((1, True, 0, True), (1, False, 2, True), (1, False, 129, False), (0, True, 2, False)),
)
def test_a_take_off_waits_for_the_throttle_unless_it_was_started(armed, started, options, raised, monkeypatch):
    v = on_mission()
    ap = v.autopilot
    ap.arming.armed, ap.arming.auto_armed, ap.modes.auto.started = armed, 0, started
    ap.params.AUTO_OPTIONS = float(options)
    monkeypatch.setattr(auto.takeoff, "run", lambda v: None)
    auto.run_command(v, kinds.TAKEOFF)
    assert bool(ap.arming.auto_armed) == raised


def test_mission_start_raises_the_throttle_of_an_armed_vehicle() -> None:
    v = make()
    ap = v.autopilot
    auto.start_mission(ap.modes.auto, ap.arming)
    assert ap.modes.auto.started and not ap.arming.auto_armed
    ap.arming.armed = 1
    auto.start_mission(ap.modes.auto, ap.arming)
    assert ap.arming.auto_armed


@pytest.mark.parametrize(("options", "may"), ((0, False), (1, True), (2, False), (129, True)))
def test_auto_options_let_it_be_armed(options: int, may: bool) -> None:
    v = make()
    v.autopilot.params.AUTO_OPTIONS = float(options)
    assert auto.may_arm(v.autopilot.params, 0) == may


@pytest.mark.parametrize(
    ("submode", "options", "follows"),
    ((kinds.WAYPOINT, 0, True), (kinds.WAYPOINT, 128, False), (kinds.GUIDED, 0, False)),
)
def test_who_heeds_the_yaw_stick(submode, options, follows, monkeypatch):
    v = on_mission()
    ap = v.autopilot
    ap.modes.auto.submode, ap.params.AUTO_OPTIONS = submode, float(options)
    ran: list[str] = []
    monkeypatch.setattr(auto_yaw, "follow_pilot", lambda *args: ran.append("yaw"))
    monkeypatch.setattr(auto, "run_command", lambda v, kind: False)
    auto.run(v)
    assert ran == ["yaw"] * follows


def test_a_new_command_is_begun_once_and_reported_when_it_is_done(monkeypatch: pytest.MonkeyPatch) -> None:
    v = on_mission()
    modes = v.autopilot.modes
    begun: list[int] = []
    monkeypatch.setattr(auto, "run_command", lambda v, kind: True)
    monkeypatch.setattr(auto.command, "begin", lambda nav, *args: begun.append(int(nav.command_count)))
    modes.nav.command_count, modes.nav.command_kind = 3, kinds.WAYPOINT
    modes.auto.land_state = DESCENDING
    for _ in range(3):
        auto.run(v)
    assert begun == [3]
    assert (modes.auto.command, modes.auto.submode, modes.auto.land_state) == (3, kinds.WAYPOINT, FLYING)
    assert [b for _, b in told(v, kinds.COMMAND_COMPLETE)] == [3.0]


@pytest.mark.parametrize(("has_target", "state"), ((True, FLYING), (False, DESCENDING)))
def test_a_landing_without_a_target_goes_down_at_once(has_target: bool, state: int) -> None:
    v = on_mission()
    modes = v.autopilot.modes
    modes.nav.command_count, modes.nav.command_kind, modes.nav.has_target = 1, kinds.LAND, has_target
    auto.begin(v)
    assert modes.auto.land_state == state
    assert auto.is_landing(modes) == (state == DESCENDING)
    assert not auto.is_taking_off(modes)


@pytest.mark.parametrize(("landed", "spool", "done"), ((1, 0, True), (1, 1, True), (1, 2, False), (0, 0, False)))
def test_a_landing_is_done_when_the_motors_idle(landed: int, spool: int, done: bool) -> None:
    v = on_mission()
    ap = v.autopilot
    ap.modes.auto.submode, ap.modes.auto.land_state = kinds.LAND, DESCENDING
    ap.arming.landed, ap.control.motors.spool_state = landed, spool
    assert bool(auto.run_land(v)) == done


@pytest.mark.parametrize("reached", (False, True))
def test_a_landing_begins_its_descent_at_its_place(reached: bool, monkeypatch: pytest.MonkeyPatch) -> None:
    v = on_mission()
    monkeypatch.setattr(auto.waypoint, "advance", lambda *args: reached)
    assert not auto.run_land(v)
    assert v.autopilot.modes.auto.land_state == (DESCENDING if reached else FLYING)


@pytest.mark.parametrize(("landed", "state", "disarms"), ((1, COMPLETE, True), (1, 1, False), (0, COMPLETE, False)))
def test_on_the_ground_after_its_last_command_it_disarms(landed: int, state: int, disarms: bool) -> None:
    v = on_mission()
    ap = v.autopilot
    ap.arming.landed, ap.modes.nav.mission_state = landed, state
    auto.run_path(v, kinds.NONE)
    assert bool(ap.arming.armed) != disarms


def test_circles_are_counted_as_they_begin(monkeypatch: pytest.MonkeyPatch) -> None:
    v = on_mission()
    ap = v.autopilot
    nav = ap.modes.nav
    nav.turns, nav.circle_reported = 3.0, 0
    turned = [0.0, 0.5, 0.99, 1.0, 1.7, 2.0, 3.0]
    monkeypatch.setattr(auto.circle, "turned", lambda nav: turned.pop(0))
    while turned:
        auto.report_circle(nav, ap.events, v.time_us)
    assert told(v, auto.CIRCLE_BEGINS) == [(1.0, 3.0), (2.0, 3.0), (3.0, 3.0), (4.0, 3.0)]


@pytest.mark.parametrize(
    ("kind", "mode", "behaviour", "expected"),
    (
        (kinds.TAKEOFF, auto_yaw.ROI, 1.0, auto_yaw.HOLD),
        (kinds.WAYPOINT, auto_yaw.ROI, 1.0, auto_yaw.ROI),
        (kinds.WAYPOINT, auto_yaw.FIXED, 0.0, auto_yaw.FIXED),
        (kinds.WAYPOINT, auto_yaw.HOLD, 0.0, auto_yaw.HOLD),
    ),
)
def test_the_heading_of_a_new_command(kind: int, mode: int, behaviour: float, expected: int) -> None:
    v = on_mission()
    ap = v.autopilot
    yaw = ap.modes.auto_yaw
    yaw.mode, ap.params.WP.YAW_BEHAVIOR = mode, behaviour
    auto.choose_heading(yaw, kind, ap.params.WP, ap.control.attitude, ap.estimate)
    assert yaw.mode == expected


def test_a_fixed_heading_ends_with_its_command_where_the_nose_follows_the_way() -> None:
    v = on_mission()
    ap = v.autopilot
    yaw = ap.modes.auto_yaw
    yaw.mode, ap.params.WP.YAW_BEHAVIOR = auto_yaw.FIXED, 1.0
    auto.choose_heading(yaw, kinds.WAYPOINT, ap.params.WP, ap.control.attitude, ap.estimate)
    assert yaw.mode == auto_yaw.default_mode(1, False) != auto_yaw.FIXED


@pytest.mark.parametrize(
    ("mode", "submode", "guided"),
    ((4, 0, True), (AUTO, kinds.GUIDED, True), (AUTO, kinds.WAYPOINT, False), (5, kinds.GUIDED, False)),
)
def test_where_set_points_are_flown(mode: int, submode: int, guided: bool) -> None:
    v = on_mission(mode)
    v.autopilot.modes.auto.submode = submode
    assert auto.is_guided(v.autopilot.modes) == guided


def test_entering_waits_for_a_command_with_the_speeds_of_the_parameters() -> None:
    v = on_mission(4)
    modes = v.autopilot.modes
    nav = modes.nav
    nav.speed_ne = nav.speed_up = nav.speed_down = 3.0
    nav.command_count, nav.command_kind, modes.auto.started = 8, kinds.WAYPOINT, True
    modes.guided.limit_us = 5
    modes.auto_yaw.mode = auto_yaw.ROI
    assert auto.start(v) == ModeResult.ACCEPTED
    assert (nav.speed_ne, nav.speed_up, nav.speed_down, nav.command_kind) == (0.0, 0.0, 0.0, kinds.NONE)
    assert (modes.auto.command, modes.auto.submode, bool(modes.auto.started)) == (8, kinds.NONE, False)
    assert modes.guided.limit_us == 0
    assert modes.auto_yaw.mode != auto_yaw.ROI
