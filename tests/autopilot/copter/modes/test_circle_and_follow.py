# SPDX-License-Identifier: BSD-3-Clause
"""CIRCLE, FOLLOW and AUTO's LOITER_TO_ALT: where they fly, where the nose points, what the sticks change."""

from __future__ import annotations

import math
from typing import Any

import pytest

from sitl.autopilot import followed_vehicle as lead_motion
from sitl.autopilot.copter.control.spool import DesiredSpoolState
from sitl.autopilot.copter.modes import auto_yaw, circle, follow, loiter_to_alt
from sitl.autopilot.copter.navigation.planner import PLANNER
from sitl.autopilot.followed_vehicle import FOLLOW_OFF, FOLLOW_OFFSET, Report
from sitl.autopilot.modes import ModeResult
from sitl.core.algebra import ZERO
from sitl.core.scalars import wrap_pi
from sitl.core.vectors import Vec3
from tests.autopilot.copter.modes.obedient_copter import MODE, hovering, move, throttle, ticks, turn_body
from tests.autopilot.copter.steady_copter import codes, told

CIRCLE_OPTIONS = {"sticks": 1.0, "face travel": 2.0, "around here": 4.0}


def circling(yaw: float = 0.0, start: bool = True, **params: float) -> Any:
    """A vehicle that has entered CIRCLE; ``params``: CIRCLE_*."""
    v = hovering("CIRCLE")
    turn_body(v, 0.0, 0.0, yaw)
    v.autopilot.params.CIRCLE.RADIUS, v.autopilot.params.CIRCLE.RATE = 500.0, 20.0
    for name, value in params.items():
        v.autopilot.params.CIRCLE[name] = value
    if start:
        assert circle.start(v) == ModeResult.ACCEPTED
    return v


@pytest.mark.parametrize(
    ("yaw", "options", "centre"),
    ((0.0, 0.0, (5.0, 0.0)), (math.pi / 2, 0.0, (0.0, 5.0)), (0.7, 4.0, (0.0, 0.0))),
)
def test_the_centre_is_ahead_or_here(yaw: float, options: float, centre: tuple[float, float]) -> None:
    v = circling(yaw, OPTIONS=options)
    assert v.autopilot.modes.nav.circle_centre == pytest.approx((*centre, -10.0), abs=1e-6)


def test_the_centre_is_ahead_of_where_it_can_stop() -> None:
    v = circling(start=False)
    move(v, 3.0, 0.0, 0.0)
    circle.start(v)
    assert v.autopilot.modes.nav.circle_centre.x > 6.0
    assert v.autopilot.control.pos_ne.vel_desired == (0.0, 0.0)


@pytest.mark.parametrize(("rate", "east"), ((20.0, -1), (-20.0, 1)))
def test_it_flies_clockwise_and_with_a_negative_rate_the_other_way(rate: float, east: int) -> None:
    """The centre is north of it: clockwise is to the west."""
    v = circling(RATE=rate)
    ticks(v, MODE["CIRCLE"].run, 400)
    assert v.autopilot.modes.nav.pos.y * east > 0.1
    assert v.autopilot.estimate.pos.y * east > 0.0
    assert v.autopilot.modes.nav.circle_rate == pytest.approx(math.radians(rate))


@pytest.mark.parametrize(("option", "rate", "heading"), ((0.0, 20.0, 0.0), (2.0, 20.0, -90.0), (2.0, -20.0, 90.0)))
def test_the_nose_points_to_the_centre_or_along_the_circle(option: float, rate: float, heading: float) -> None:
    v = circling(RATE=rate, OPTIONS=option)
    ticks(v, MODE["CIRCLE"].run, 4)
    yaw = v.autopilot.modes.auto_yaw
    assert (yaw.mode, yaw.rate) == (auto_yaw.CIRCLE, 0.0)
    assert math.degrees(yaw.yaw) == pytest.approx(heading, abs=1.0)
    assert math.degrees(v.autopilot.control.attitude.target_euler.yaw) == pytest.approx(heading, abs=1.0)


@pytest.mark.parametrize("angle", (0.0, 2.0, -2.0, 3.1))
def test_the_nose_points_inwards_from_all_sides(angle: float) -> None:
    nav = circling().autopilot.modes.nav
    pos = nav.circle_centre + Vec3(math.cos(angle), math.sin(angle), 0.0)
    assert wrap_pi(circle.heading(nav, pos, False) - angle - math.pi) == pytest.approx(0.0, abs=1e-9)
    assert wrap_pi(circle.heading(nav, pos, True) - angle - math.pi / 2) == pytest.approx(0.0, abs=1e-9)


@pytest.mark.parametrize(("changed", "radius"), ((500.0, 9.0), (700.0, 7.0)))
def test_a_new_circle_radius_replaces_the_pilots(changed: float, radius: float) -> None:
    v = circling()
    v.autopilot.modes.circle.radius = 9.0
    v.autopilot.params.CIRCLE.RADIUS = changed
    ticks(v, MODE["CIRCLE"].run)
    assert v.autopilot.modes.circle.radius == v.autopilot.modes.nav.circle_radius == radius


@pytest.mark.parametrize(("options", "changes"), ((0.0, False), (1.0, True)))
def test_sticks_change_the_radius_and_the_rate_with_the_option(options: float, changes: bool) -> None:
    v = circling(OPTIONS=options)
    p, sticks, state = v.autopilot.params, v.autopilot.modes.pilot, v.autopilot.modes.circle
    p.WPNAV.SPEED, sticks.pitch, sticks.roll = 200.0, 1.0, 1.0
    ticks(v, MODE["CIRCLE"].run, 40)
    assert state.radius == pytest.approx(5.2 if changes else 5.0), "WPNAV_SPEED"
    assert math.degrees(state.rate) == pytest.approx(20.1 if changes else 20.0), "1 deg/s each second"


def test_the_rate_of_a_circle_that_stands_goes_either_way_after_the_stick_was_centred() -> None:
    v = circling(RATE=0.0)
    state, sticks = v.autopilot.modes.circle, v.autopilot.modes.pilot
    sticks.roll = -1.0
    circle.steer(state, sticks, 0.0, 1.0)
    assert state.rate == 0.0 and not state.may_turn_back
    sticks.roll = 0.0
    circle.steer(state, sticks, 0.0, 1.0)
    assert state.may_turn_back
    sticks.roll = -1.0
    circle.steer(state, sticks, 0.0, 1.0)
    assert state.rate < 0.0 and not state.may_turn_back
    sticks.roll = 1.0
    for _ in range(10):
        circle.steer(state, sticks, state.rate, 1.0)
    assert state.rate == 0.0, "the stick was not centred"


@pytest.mark.parametrize(("rate", "stick", "kept"), ((1.5, 1.0, 90.0), (-1.5, -1.0, -90.0), (1.5, -1.0, 0.0)))
def test_the_rate_of_a_circle_ends_at_ninety_degrees_a_second_and_at_zero(
    rate: float, stick: float, kept: float
) -> None:
    v = circling()
    state, sticks = v.autopilot.modes.circle, v.autopilot.modes.pilot
    state.rate, sticks.roll = rate, stick
    reached = rate
    for _ in range(400 * 95):
        circle.steer(state, sticks, reached, 1.0)
        if state.rate == reached:
            break
        reached = float(state.rate)
    assert math.degrees(reached) == pytest.approx(kept)


@pytest.mark.parametrize(("stick", "radius"), ((-1.0, 0.0), (1.0, 0.0125)))
def test_a_radius_is_not_negative(stick: float, radius: float) -> None:
    v = circling()
    state, sticks = v.autopilot.modes.circle, v.autopilot.modes.pilot
    state.radius, sticks.pitch = 0.0, stick
    circle.steer(state, sticks, 0.0, 5.0)
    assert state.radius == radius


@pytest.mark.parametrize(("stick", "climbs"), ((1.0, -1), (0.0, 1), (0.5, 0)))
def test_the_throttle_stick_climbs_on_the_circle(stick: float, climbs: int) -> None:
    v = circling()
    throttle(v, stick)
    ticks(v, MODE["CIRCLE"].run, 40)
    speed = v.autopilot.control.pos_d.vel_desired
    assert speed == 0.0 if climbs == 0 else speed * climbs > 0.0


def test_the_yaw_stick_takes_the_heading_over_for_good() -> None:
    v = circling()
    yaw, sticks = v.autopilot.modes.auto_yaw, v.autopilot.modes.pilot
    sticks.yaw_rate = 0.3
    ticks(v, MODE["CIRCLE"].run)
    assert (yaw.mode, yaw.rate) == (auto_yaw.PILOT_RATE, 0.3)
    sticks.yaw_rate = 0.0
    ticks(v, MODE["CIRCLE"].run, 3)
    assert yaw.mode == auto_yaw.HOLD


def test_the_speed_of_a_circle_is_that_of_waypoints_at_most() -> None:
    v = circling(RATE=90.0)
    p, nav = v.autopilot.params.WPNAV, v.autopilot.modes.nav
    p.SPEED, p.ACCEL = 100.0, 900.0
    circle.apply(nav, v.autopilot.modes.circle, v.autopilot.params)
    assert nav.circle_top_rate * 5.0 == pytest.approx(1.0)
    p.SPEED = 0.0
    circle.apply(nav, v.autopilot.modes.circle, v.autopilot.params)
    assert nav.circle_top_rate * 5.0 == pytest.approx(0.1)


def led(**params: float) -> Any:
    """A vehicle in FOLLOW whose lead is 20 m north of it and flies east; ``params``: FOLL_*."""
    v = hovering("FOLLOW")
    p = v.autopilot.params.FOLL
    p.ENABLE, p.OFS_TYPE, p.DIST_MAX = 1.0, 0.0, 100.0
    p.OFS_X, p.OFS_Y, p.OFS_Z = -5.0, 0.0, 0.0
    for name, value in params.items():
        p[name] = value
    assert follow.start(v) == ModeResult.ACCEPTED
    report(v)
    return v


def report(v: Any, north: float = 20.0) -> None:
    """What the lead says of itself now."""
    said = Report(Vec3(north, 0.0, -12.0), Vec3(0.0, 3.0, 0.0), ZERO, True, 1.0, 0.2)
    lead_motion.take(v.autopilot.modes.follow, v.autopilot.params.FOLL, 7, said, v.time_us)


def test_it_flies_to_its_offset_from_the_lead_and_as_high_as_it() -> None:
    v = led()
    ticks(v, MODE["FOLLOW"].run, 40)
    path, height = v.autopilot.control.pos_ne, v.autopilot.control.pos_d
    assert path.vel_desired.x > 0.0 and path.vel_desired.y > 0.0 and height.vel_desired < 0.0
    assert v.autopilot.control.motors.desired_spool == DesiredSpoolState.THROTTLE_UNLIMITED


def test_without_a_report_it_holds_its_position() -> None:
    v = led(TIMEOUT=1.0)
    v.time_us += 1_100_000
    move(v, 2.0, 0.0, 0.5)
    v.autopilot.control.pos_ne.last_tick = v.autopilot.control.pos_d.last_tick = 0
    ticks(v, MODE["FOLLOW"].run, 40)
    assert 0.0 < v.autopilot.control.pos_ne.vel_desired.x < 2.0
    assert 0.0 < v.autopilot.control.pos_d.vel_desired < 0.5
    assert v.autopilot.modes.auto_yaw.mode == auto_yaw.ANGLE_RATE


@pytest.mark.parametrize(
    ("behaviour", "heading", "rate"),
    ((0, 0.5, 0.0), (1, 0.0, 0.0), (2, 1.0, 0.2), (3, math.pi / 2, 0.0), (9, 0.5, 0.0)),
)
def test_the_nose_points_as_foll_yaw_behave_says(behaviour: int, heading: float, rate: float) -> None:
    """Stays, faces the lead, as the lead's nose, along its flight."""
    v = led(YAW_BEHAVE=float(behaviour))
    turn_body(v, 0.0, 0.0, 0.5)
    ticks(v, MODE["FOLLOW"].run)
    yaw = v.autopilot.modes.auto_yaw
    assert (yaw.yaw, yaw.rate) == pytest.approx((heading, rate), abs=2e-3)


@pytest.mark.parametrize(("away", "speed", "turns"), ((0.9, 5.0, (0, 1)), (1.1, 0.9, (1, 0))))
def test_near_the_lead_and_behind_a_slow_one_the_nose_stays(away: float, speed: float, turns: tuple[int, int]) -> None:
    v = led()
    ap = v.autopilot
    lead = ap.modes.follow
    lead.pos, lead.vel = Vec3(0.0, away, 0.0), Vec3(0.0, speed, 0.0)
    for behaviour, does in zip((1, 3), turns, strict=True):
        ap.modes.auto_yaw.yaw = 0.3
        follow.look(ap.modes.auto_yaw, lead, Vec3(0.0, 0.0, -10.0), behaviour)
        assert (ap.modes.auto_yaw.yaw == pytest.approx(math.pi / 2)) == bool(does)


def test_without_an_offset_the_distance_at_the_first_report_is_kept_and_said() -> None:
    v = led(OFS_X=0.0)
    ticks(v, MODE["FOLLOW"].run, 3)
    assert told(v, FOLLOW_OFFSET) == [(0.0, 0.0)]
    assert v.autopilot.control.pos_ne.accel_desired.x == pytest.approx(0.0, abs=0.01)


def test_follow_says_that_it_is_not_enabled() -> None:
    v = hovering("FOLLOW")
    v.autopilot.params.FOLL.ENABLE = 0.0
    assert follow.start(v) == ModeResult.INIT_FAILED and codes(v) == [FOLLOW_OFF]


@pytest.mark.parametrize("name", ("CIRCLE", "FOLLOW"))
@pytest.mark.parametrize(("armed", "commanded", "landed", "spool"), ((0, 0, 1, 0), (1, 0, 1, 1), (1, 1, 1, 1)))
def test_on_the_ground_it_rests(name: str, armed: int, commanded: int, landed: int, spool: int) -> None:
    v = circling() if name == "CIRCLE" else led()
    state = v.autopilot.arming
    state.armed, state.auto_armed, state.landed = armed, commanded, landed
    ticks(v, MODE[name].run)
    assert v.autopilot.control.motors.desired_spool == spool
    assert v.autopilot.control.pos_ne.vel_desired == (0.0, 0.0)


def to_height(north: float = 0.0, height: float = 12.0) -> Any:
    """A vehicle at 10 m that is to come to a height over a position."""
    v = hovering("AUTO")
    ap, nav = v.autopilot, v.autopilot.modes.nav
    ap.params.WPNAV.RADIUS = 200.0
    PLANNER.begin(ap, v.time_us, Vec3(north, 0.0, -10.0))
    PLANNER.start(ap, v.time_us)
    nav.target, nav.since_us = Vec3(north, 0.0, -height), 0
    return v


def test_far_away_it_flies_to_the_position_first() -> None:
    v = to_height(5.0)
    assert ticks(v, loiter_to_alt.run, 60) is False
    assert v.autopilot.estimate.pos.x > 0.0 and v.autopilot.modes.nav.since_us == 0
    assert v.autopilot.estimate.pos.z == pytest.approx(-10.0, abs=1e-3)


@pytest.mark.parametrize(("height", "way"), ((12.0, -1), (8.0, 1)))
def test_there_it_climbs_or_sinks_to_its_height(height: float, way: int) -> None:
    v = to_height(1.0, height)
    assert ticks(v, loiter_to_alt.run) is False
    first = v.time_us
    assert ticks(v, loiter_to_alt.run, 100) is False
    assert v.autopilot.modes.nav.since_us == first, "where it began to"
    assert v.autopilot.control.pos_d.vel_desired * way > 0.1


@pytest.mark.parametrize(
    ("left", "before", "done"), ((0.06, 0.07, False), (-0.06, -0.07, False), (0.04, 0.5, True), (-0.06, 0.06, True))
)
def test_the_height_is_reached_within_five_centimetres_or_when_it_is_passed(
    left: float, before: float, done: bool
) -> None:
    v = to_height()
    nav = v.autopilot.modes.nav
    nav.since_us, nav.height_error = 1, before
    nav.target = nav.target.replace(z=-10.0 + left)
    assert ticks(v, loiter_to_alt.run) is done
    assert nav.height_error == pytest.approx(left)


def test_its_climb_and_descent_keep_their_limits() -> None:
    for height, speed in ((100.0, -2.5), (-100.0, 1.5)):
        v = to_height(0.0, height)
        path = v.autopilot.control.pos_d
        path.speed_up, path.speed_down, path.accel_max, path.jerk_max = 2.5, 1.5, 5.0, 50.0
        ticks(v, loiter_to_alt.run, 400)
        assert path.vel_desired == pytest.approx(speed, abs=0.01)


def test_the_sticks_move_it_over_its_position() -> None:
    v = to_height()
    v.autopilot.modes.pilot.roll = 1.0
    ticks(v, loiter_to_alt.run, 200)
    assert v.autopilot.estimate.vel.y > 0.1


@pytest.mark.parametrize(("armed", "landed", "spool"), ((1, 1, 1), (0, 1, 0)))
def test_on_the_ground_it_waits_for_a_take_off(armed: int, landed: int, spool: int) -> None:
    v = to_height()
    v.autopilot.arming.armed, v.autopilot.arming.landed = armed, landed
    assert ticks(v, loiter_to_alt.run) is False
    assert v.autopilot.control.motors.desired_spool == spool
