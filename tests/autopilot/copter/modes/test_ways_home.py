# SPDX-License-Identifier: BSD-3-Clause
"""RTL and SMART_RTL flown to their end: which way, at which height, and what they wait for over home."""

from __future__ import annotations

import math
from typing import Any

import pytest

from sitl.autopilot import smart_rtl_path
from sitl.autopilot.copter.control.spool import DesiredSpoolState
from sitl.autopilot.copter.modes import auto_yaw, rtl, smart_rtl
from sitl.autopilot.copter.navigation.planner import PLANNER
from sitl.autopilot.modes import ModeResult
from sitl.autopilot.smart_rtl_path import point
from sitl.core.vectors import Vec3
from tests.autopilot.copter.modes.obedient_copter import MODE, hovering, throttle, ticks

HOLD = auto_yaw.HOLD
FIRST_TICK = 1


def away(name: str, north: float = 3.0, height: float = 2.0, **params: float) -> Any:
    """A fast vehicle that hovers north of home, in a mode that returns."""
    v = hovering(name, height)
    p = v.autopilot.params
    p.WPNAV.SPEED, p.WPNAV.SPEED_UP, p.WPNAV.SPEED_DN, p.WPNAV.ACCEL, p.WPNAV.ACCEL_Z = (
        1000.0,
        500.0,
        500.0,
        900.0,
        500.0,
    )
    p.WPNAV.JERK, p.PSC.JERK_XY, p.PSC.JERK_Z, p.WPNAV.RADIUS, p.WPNAV.ACCEL_C = 20.0, 20.0, 20.0, 50.0, 0.0
    p.RTL.ALT, p.RTL.CLIMB_MIN, p.RTL.LOIT_TIME = 300.0, 0.0, 200.0
    for key, value in params.items():
        p.RTL[key] = value
    v.autopilot.home.is_set, v.autopilot.home.pos = 1, (0.0, 0.0, 0.0)
    v.autopilot.estimate.pos = Vec3(north, 0.0, -height)
    return v


def flown(v: Any, name: str, until: int, longest: int = 2600) -> list[tuple[int, Vec3]]:
    """Fly until the way home is in state ``until``: (state, position) of each tick."""
    seen = []
    for _ in range(longest):
        ticks(v, MODE[name].run)
        PLANNER.serve(v.autopilot, int(v.time_us))
        seen.append((int(v.autopilot.modes.rtl.state), Vec3(*v.autopilot.estimate.pos)))
        if seen[-1][0] == until:
            return seen
    raise AssertionError(f"still in state {seen[-1]}")


def test_rtl_climbs_flies_home_waits_and_lands() -> None:
    v = away("RTL")
    assert rtl.start(v) == ModeResult.ACCEPTED
    PLANNER.serve(v.autopilot, int(v.time_us))
    seen = flown(v, "RTL", rtl.LANDING)
    assert list(dict.fromkeys(state for state, _ in seen)) == [rtl.CLIMB, rtl.RETURN, rtl.LOITER, rtl.LANDING]
    climb, home = [[pos for state, pos in seen if state == one] for one in (rtl.CLIMB, rtl.RETURN)]
    assert climb[-1] == pytest.approx((3.0, 0.0, -3.0), abs=0.6), "first up, a corner of at most WPNAV_RADIUS"
    assert home[-1] == pytest.approx((0.0, 0.0, -3.0), abs=0.6)
    waited = sum(state == rtl.LOITER for state, _ in seen) * 0.0025
    assert waited == pytest.approx(0.2, abs=0.01), "RTL_LOIT_TIME [ms]"
    assert MODE["RTL"].is_landing(v.autopilot.modes)


@pytest.mark.parametrize(("lost", "state"), ((0, rtl.FINAL_DESCENT), (1, rtl.LANDING)))
def test_over_home_it_stays_at_rtl_alt_final_unless_the_radio_is_lost(lost: int, state: int) -> None:
    v = away("RTL", ALT_FINAL=150.0)
    rtl.start(v)
    v.autopilot.modes.failsafe.radio, v.autopilot.modes.rtl.state = lost, rtl.LOITER
    v.time_us += 200_000
    ticks(v, MODE["RTL"].run)
    assert v.autopilot.modes.rtl.state == state


def test_at_rtl_alt_final_the_sticks_move_it_and_it_sinks_no_lower() -> None:
    v = away("RTL", ALT_FINAL=150.0)
    rtl.start(v)
    v.autopilot.modes.rtl.state = rtl.FINAL_DESCENT
    v.autopilot.modes.pilot.pitch = -1.0
    ticks(v, MODE["RTL"].run, 700)
    est = v.autopilot.estimate
    assert est.pos.z == pytest.approx(-1.5, abs=0.05) and est.vel.z == pytest.approx(0.0, abs=0.1)
    assert est.vel.x > 0.5 and est.vel.y == pytest.approx(0.0)


@pytest.mark.parametrize(("spent", "left"), ((199_999, rtl.LOITER), (200_000, rtl.LANDING)))
def test_it_waits_over_home_for_all_of_rtl_loit_time(spent: int, left: int) -> None:
    v = away("RTL")
    rtl.start(v)
    v.autopilot.modes.rtl.state, v.autopilot.modes.rtl.loiter_us = rtl.LOITER, v.time_us + 2500 - spent
    ticks(v, MODE["RTL"].run)
    assert v.autopilot.modes.rtl.state == left


def test_it_waits_for_the_turn_to_the_heading_of_arming() -> None:
    v = away("RTL")
    rtl.start(v)
    modes = v.autopilot.modes
    modes.rtl.state, modes.auto_yaw.mode, modes.auto_yaw.offset = rtl.LOITER, auto_yaw.FIXED, 1.0
    modes.auto_yaw.slew = 0.1
    v.time_us += 1_000_000
    ticks(v, MODE["RTL"].run)
    assert modes.rtl.state == rtl.LOITER


@pytest.mark.parametrize(("behaviour", "turns"), ((0, False), (1, True), (2, False), (3, True)))
def test_over_home_the_nose_turns_as_wp_yaw_behavior_lets_it(behaviour: int, turns: bool) -> None:
    v = away("RTL")
    ap = v.autopilot
    ap.params.WP.YAW_BEHAVIOR, ap.modes.auto_yaw.armed, ap.modes.auto_yaw.mode = float(behaviour), 1.2, HOLD
    rtl.turn_back(ap.modes.auto_yaw, ap.control, ap.params)
    yaw = ap.modes.auto_yaw
    assert (yaw.mode == auto_yaw.FIXED) == turns
    if turns:
        assert (yaw.yaw, yaw.offset) == pytest.approx((0.0, 1.2))
        assert yaw.slew == pytest.approx(math.radians(ap.params.ATC.SLEW_YAW * 0.01))


@pytest.mark.parametrize(("speed", "wanted"), ((0.0, 0.0), (400.0, 4.0), (-100.0, 0.0)))
def test_rtl_speed_replaces_that_of_waypoints(speed: float, wanted: float) -> None:
    v = away("RTL", SPEED=speed)
    nav = v.autopilot.modes.nav
    nav.speed_ne = nav.speed_up = nav.speed_down = 9.0
    rtl.start(v)
    assert (nav.speed_ne, nav.speed_up, nav.speed_down) == (wanted, 0.0, 0.0)


@pytest.mark.parametrize(
    ("armed", "home", "result"), ((1, 0, ModeResult.INIT_FAILED), (0, 0, ModeResult.ACCEPTED), (1, 1, 0))
)
def test_rtl_needs_a_home_when_it_is_armed(armed: int, home: int, result: int) -> None:
    v = away("RTL")
    v.autopilot.arming.armed, v.autopilot.home.is_set = armed, home
    assert rtl.start(v) == result


@pytest.mark.parametrize(("armed", "landed", "asks"), ((1, 0, 2), (1, 1, 0), (0, 1, 0), (0, 0, 0)))
def test_legs_are_asked_for_in_flight_only(armed: int, landed: int, asks: int) -> None:
    v = away("RTL")
    v.autopilot.arming.armed, v.autopilot.arming.landed = armed, landed
    rtl.start(v)
    assert v.autopilot.modes.nav.request_pending == asks


@pytest.mark.parametrize(
    ("height", "least", "distance", "slope", "climb", "wanted"),
    (
        (2.0, 0.0, 100.0, 0.0, 0.0, 3.0),  # RTL_ALT
        (2.0, 8.0, 100.0, 0.0, 0.0, 8.0),  # no lower than a rally point
        (2.0, 0.0, 100.0, 0.0, 5.0, 7.0),  # RTL_CLIMB_MIN
        (2.0, 0.0, 100.0, 0.0, -5.0, 3.0),
        (2.0, 0.0, 5.0, 0.5, 0.0, 2.5),  # a cone of that slope
        (2.0, 0.0, 5.0, 0.49, 0.0, 3.0),  # too flat for a cone
        (2.0, 0.0, 1.0, 0.5, 0.0, 2.0),
        (0.1, 0.0, 0.0, 0.5, 0.0, 0.3),  # at least 0.3 m
    ),
)
def test_the_height_of_the_way_home(
    height: float, least: float, distance: float, slope: float, climb: float, wanted: float
) -> None:
    p = away("RTL").autopilot.params.RTL
    p.ALT, p.CONE_SLOPE, p.CLIMB_MIN = 300.0, slope, climb * 100.0
    assert rtl.return_height(height, least, distance, p) == pytest.approx(wanted)


@pytest.mark.parametrize(
    ("planned", "top", "here", "kept"),
    ((-20.0, -15.0, -10.0, -15.0), (-20.0, -15.0, -18.0, -18.0), (-12.0, -15.0, -10.0, -12.0)),
)
def test_a_fence_lowers_the_way_home_but_not_the_vehicle(planned: float, top: float, here: float, kept: float) -> None:
    state = away("RTL").autopilot.modes.rtl
    state.return_d = planned
    rtl.keep_below(state, top, here)
    assert state.return_d == kept


def smart(points: int = 3) -> Any:
    """A vehicle at the end of a path that goes 3 m north and then 3 m east (1: home only)."""
    v = away("SMART_RTL")
    ap = v.autopilot
    where = (Vec3(0.0, 0.0, -2.0), Vec3(3.0, 0.0, -2.0), Vec3(3.0, 3.0, -2.0))[:points]
    smart_rtl_path.begin(ap.modes.path, where[0], True, v.time_us, ap.params.SRTL)
    for pos in where[1:]:
        assert smart_rtl_path.add(ap.modes.path, pos, ap.params.SRTL)
    ap.estimate.pos = where[-1]
    return v


def test_smart_rtl_flies_its_path_back_and_ends_over_its_first_point() -> None:
    v = smart()
    assert smart_rtl.start(v) == ModeResult.ACCEPTED
    seen = flown(v, "SMART_RTL", rtl.LANDING)
    states = list(dict.fromkeys(state for state, _ in seen))
    assert states == [smart_rtl.FOLLOW, smart_rtl.PRE_LAND, rtl.LANDING]
    assert min(math.dist(pos[:2], (3.0, 0.0)) for _, pos in seen) < 0.5, "round the corner, not across"
    assert seen[-1][1] == pytest.approx((0.0, 0.0, -4.0), abs=0.5), "2 m above the first point"
    assert v.autopilot.modes.path.points == 1
    assert v.autopilot.control.motors.desired_spool == DesiredSpoolState.THROTTLE_UNLIMITED


def test_at_the_first_point_already_it_climbs_above_it() -> None:
    v = smart(1)
    assert smart_rtl.start(v) == ModeResult.ACCEPTED
    ticks(v, MODE["SMART_RTL"].run)
    assert v.autopilot.modes.rtl.state == smart_rtl.PRE_LAND
    assert (v.autopilot.modes.nav.request, v.autopilot.modes.nav.request_pending) == ((0.0, 0.0, -4.0), 1)


def test_each_leg_is_flown_through_to_the_point_behind_it() -> None:
    v = smart()
    smart_rtl.start(v)
    ticks(v, MODE["SMART_RTL"].run)
    nav = v.autopilot.modes.nav
    assert (nav.request, nav.request_next, nav.request_pending) == ((3.0, 3.0, -2.0), (3.0, 0.0, -2.0), 2)
    assert v.autopilot.control.pos_ne.vel_desired == (0.0, 0.0), "it waits for the legs"


@pytest.mark.parametrize(("active", "points", "result"), ((1, 1, 0), (0, 1, 2), (1, 0, 2)))
def test_smart_rtl_needs_a_path(active: int, points: int, result: int) -> None:
    v = smart()
    v.autopilot.modes.path.active, v.autopilot.modes.path.points = active, points
    v.autopilot.home.pos, v.autopilot.params.RTL.ALT_FINAL = (0.0, 0.0, -1.0), 400.0
    assert smart_rtl.start(v) == (ModeResult.INIT_FAILED if result else ModeResult.ACCEPTED)
    if result == 0:
        assert (v.autopilot.modes.rtl.state, v.autopilot.modes.rtl.descent_d) == (smart_rtl.CLEAN_UP, -5.0)


@pytest.mark.parametrize(("options", "rate", "mode"), ((0, 0.5, auto_yaw.PILOT_RATE), (4, 0.5, HOLD), (0, 0.0, HOLD)))
@pytest.mark.parametrize("name", ("RTL", "SMART_RTL"))
def test_the_yaw_stick_may_be_forbidden(name: str, options: int, rate: float, mode: int) -> None:
    v = smart()
    ap = v.autopilot
    ap.params.SRTL.OPTIONS = ap.params.RTL.OPTIONS = float(options)
    MODE[name].start(v)
    ap.modes.auto_yaw.mode, ap.modes.pilot.yaw_rate = HOLD, rate
    ticks(v, MODE[name].run)
    assert ap.modes.auto_yaw.mode == mode


@pytest.mark.parametrize("name", ("RTL", "SMART_RTL"))
@pytest.mark.parametrize(("armed", "spool"), ((1, DesiredSpoolState.GROUND_IDLE), (0, DesiredSpoolState.SHUT_DOWN)))
def test_on_the_ground_it_rests(name: str, armed: int, spool: int) -> None:
    v = smart()
    v.autopilot.arming.armed, v.autopilot.arming.landed = armed, 1
    MODE[name].start(v)
    ticks(v, MODE[name].run)
    assert v.autopilot.control.motors.desired_spool == spool


def test_landed_and_idle_at_its_end_it_disarms() -> None:
    v = smart()
    throttle(v, 0.0)
    ap = v.autopilot
    ap.modes.rtl.state, ap.arming.landed, ap.control.motors.spool_state = rtl.LANDING, 1, 1
    ticks(v, MODE["SMART_RTL"].run)
    assert not ap.arming.armed


@pytest.mark.parametrize(
    ("known", "armed", "name", "saved", "points"),
    ((1, 1, "LOITER", 1, 2), (1, 0, "LOITER", 1, 1), (1, 1, "SMART_RTL", 1, 1), (0, 1, "LOITER", 0, 0)),
)
def test_the_path_begins_where_the_position_is_known_and_grows_while_armed(
    known: int, armed: int, name: str, saved: int, points: int
) -> None:
    v = away(name)
    ap = v.autopilot
    ap.arming.armed, ap.estimate.position_ok = armed, known
    smart_rtl.record(v)
    ap.estimate.pos = Vec3(8.0, 0.0, -2.0)
    smart_rtl.record(v)
    assert (ap.modes.path.home_saved, ap.modes.path.points) == (saved, points)
    if points:
        assert point(ap.modes.path, 0) == (3.0, 0.0, -2.0)
