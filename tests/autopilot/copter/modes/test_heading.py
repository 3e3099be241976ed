# SPDX-License-Identifier: BSD-3-Clause
"""Headings of modes that fly by themselves: along the way, to a point, by a turn, by the yaw stick."""

from __future__ import annotations

import math

import pytest

from sitl.autopilot.copter.modes import auto_yaw
from sitl.core.vectors import Vec2, Vec3
from tests.autopilot.copter.modes.obedient_copter import hovering, move, turn_body


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
        (1e-4, 0, auto_yaw.FIXED),
        (-1e-4, 0, auto_yaw.FIXED),
        (0.5, 1, auto_yaw.FIXED),
    ),
)
def test_the_yaw_stick_takes_over_while_there_is_a_radio(rate: float, lost: int, mode: int) -> None:
    v = hovering("GUIDED")
    modes = v.autopilot.modes
    modes.auto_yaw.mode, modes.pilot.yaw_rate, modes.failsafe.radio = auto_yaw.FIXED, rate, lost
    auto_yaw.follow_pilot(modes, v.autopilot.control.attitude, v.autopilot.estimate)
    assert modes.auto_yaw.mode == mode


@pytest.mark.parametrize(
    ("mode", "rate", "turns"),
    (
        (auto_yaw.HOLD, 0.0, 0.0),
        (auto_yaw.RATE, 0.4, 0.4),
        (auto_yaw.PILOT_RATE, -0.4, -0.4),
        (auto_yaw.RATE, 9.0, math.radians(60.0)),  # ATC_SLEW_YAW
        (auto_yaw.ANGLE_RATE, 0.0, 0.0),
        (auto_yaw.CIRCLE, 0.0, 0.0),
    ),
)
def test_whatever_the_heading_the_thrust_points_where_the_position_controller_wants_it(
    mode: int, rate: float, turns: float
) -> None:
    v = hovering("GUIDED")
    ap = v.autopilot
    ap.params.ATC.SLEW_YAW = 6000.0
    yaw = ap.modes.auto_yaw
    yaw.mode, yaw.yaw, yaw.rate = mode, 0.0, rate
    auto_yaw.point(yaw, Vec3(2.0, 0.0, -9.80665), ap.control, ap.estimate, ap.params)
    target = ap.control.attitude.target_euler
    assert target.pitch == pytest.approx(-math.atan(2.0 / 9.80665), abs=1e-5) and target.roll == pytest.approx(
        0.0, abs=1e-3
    )
    assert target.yaw / 0.0025 == pytest.approx(turns, rel=0.05, abs=1e-6)
