# SPDX-License-Identifier: BSD-3-Clause
"""Where horizontal position control starts from, its limits of jerk and lean, and how it lets go on the ground."""

from __future__ import annotations

import math
from typing import Any

import pytest

from sitl.autopilot.control.shaping import Motion2
from sitl.autopilot.copter.control import altitude, altitude_start, position, position_ned, position_start
from sitl.autopilot.copter.control.state import DT, AltitudeState, PositionState
from sitl.core.constants import GRAVITY
from sitl.core.vectors import Vec2, Vec3
from tests.autopilot.copter.control.level_autopilot import moving, parts

REST = Vec2(0.0, 0.0)
CDEG = math.radians(0.01)


@pytest.mark.parametrize(
    ("jerk", "feed_forward", "rate", "accel", "wanted"),
    (
        (5.0, 1.0, 0.0, 0.0, 5.0),  # PSC_JERK_XY
        (0.0, 1.0, 0.0, 0.0, 0.01),
        (50.0, 1.0, 30.0, 0.0, math.radians(30.0) * GRAVITY),  # as fast as it may turn
        (50.0, 1.0, 0.0, 36000.0, 0.5 * math.sqrt(2.5 * math.radians(360.0) * GRAVITY)),  # as soon
        (1.0, 1.0, 30.0, 36000.0, 1.0),
        (50.0, 0.0, 30.0, 36000.0, 50.0),  # shaping is off
    ),
)
def test_jerk_is_what_the_airframe_can(
    ap: Any, jerk: float, feed_forward: float, rate: float, accel: float, wanted: float
) -> None:
    p = ap.params
    p.PSC.JERK_XY, p.ATC.RATE_FF_ENAB = jerk, feed_forward
    for less, more in ((0, 1), (1, 0)):  # the weaker of roll and pitch counts
        p.ATC.RATE_R_MAX, p.ATC.RATE_P_MAX = rate * (1 + less), rate * (1 + more)
        p.ATC.ACCEL_R_MAX, p.ATC.ACCEL_P_MAX = accel * (1 + more), accel * (1 + less)
        position_start.set_max_speed_accel_ne(ap.control.pos_ne, p, 7.0, 2.5)
        assert ap.control.pos_ne.jerk_max == pytest.approx(wanted)
    c = ap.control.pos_ne
    assert (c.speed_max, c.accel_max, c.correction_speed, c.correction_accel) == (7.0, 2.5, 7.0, 2.5)
    position_start.set_max_speed_accel_ne(c, p, 7.0, 0.0)
    assert c.accel_max == 0.01


@pytest.mark.parametrize(("own", "wanted"), ((0.0, 30.0), (20.0, 20.0), (45.0, 45.0)))
def test_the_greatest_lean_is_psc_angle_max_or_angle_max(ap: Any, own: float, wanted: float) -> None:
    ap.params.PSC.ANGLE_MAX, ap.params.ANGLE_MAX = own, 3000.0
    assert math.degrees(position_start.lean_max_ne(ap.params)) == pytest.approx(wanted)


@pytest.mark.parametrize(("lean_max", "wanted"), ((1.2, 30.0), (math.radians(20.0), 20.0), (0.0, 10.0)))
def test_the_acceleration_is_that_of_the_lean_which_the_thrust_allows(ap: Any, lean_max: float, wanted: float) -> None:
    ap.control.attitude.lean_max = lean_max
    limit = GRAVITY * math.tan(math.radians(wanted))
    assert position_start.renew_accel_limit(ap.control, ap.params) == pytest.approx(limit)
    assert ap.control.pos_ne.accel_limit == pytest.approx(limit)


@pytest.mark.parametrize(("tick", "renewed"), ((0, True), (1, False), (7, False), (8, True), (16, True)))
def test_the_limit_is_renewed_in_every_eighth_tick(ap: Any, tick: int, renewed: bool) -> None:
    ap.control.tick, ap.control.pos_ne.accel_limit = tick, 77.0
    assert (position_start.accel_limit_ne(ap.control, ap.params) != 77.0) == renewed


@pytest.mark.parametrize(("tick", "last", "active"), ((0, 0, False), (5, 5, True), (6, 5, True), (7, 5, False)))
def test_a_controller_is_active_that_ran_in_this_tick_or_the_last(ap: Any, tick: int, last: int, active: bool) -> None:
    ap.control.tick = tick
    ap.control.pos_ne.last_tick = ap.control.pos_d.last_tick = last
    assert position_start.is_active_ne(ap.control) == altitude_start.is_active_d(ap.control) == active


@pytest.mark.parametrize("lean", (1.5, -1.5))
def test_the_acceleration_of_a_lean_near_the_horizontal_is_limited(lean: float) -> None:
    most = GRAVITY * math.tan(1.4)
    assert position_start.lean_accel(0.0, lean, 0.0).x == pytest.approx(math.copysign(most, -lean))
    assert position_start.lean_accel(lean, 0.0, 0.0).y == pytest.approx(math.copysign(most, lean))
    assert position_start.lean_accel(0.3, lean, 0.0).y == pytest.approx(GRAVITY * math.tan(0.3) / math.cos(1.4))


def test_it_starts_from_the_present_motion_and_lean(ap: Any) -> None:
    control = moving(ap)
    c = control.pos_ne
    c.pos_error, c.accel_desired, c.limit, c.started = Vec2(1.0, 1.0), Vec2(1.0, 1.0), Vec2(1.0, 1.0), True
    position_start.init_ne(*parts(ap))
    assert (c.pos_desired, c.vel_desired, c.vel_target) == ((1.0, -2.0), (3.0, 4.0), (3.0, 4.0))
    assert c.accel_target == pytest.approx((0.0, GRAVITY * math.tan(0.2))) == c.vel_integrator
    assert (c.pos_error, c.accel_desired, c.limit, c.started) == (REST, REST, REST, 0)
    assert (c.reset_count, c.last_tick) == (3, 100)


def test_a_controller_that_runs_keeps_its_acceleration_within_the_limit(ap: Any) -> None:
    control = moving(ap)
    c = control.pos_ne
    c.last_tick, c.accel_target = 99, Vec2(-30.0, 40.0)
    position_start.init_ne(*parts(ap))
    limit = GRAVITY * math.tan(math.radians(30.0))
    assert c.accel_target == pytest.approx((-0.6 * limit, 0.8 * limit))


def test_it_starts_from_where_it_can_stop(ap: Any) -> None:
    control = moving(ap)
    position_start.init_ne_stopping_point(*parts(ap))
    altitude_start.init_d_stopping_point(*parts(ap))
    ne, d = control.pos_ne, control.pos_d
    assert ne.pos_desired == position_start.stopping_point_ne(ne, ap.estimate, ap.params.PSC)
    assert ne.pos_desired.x > 3.0 and ne.pos_desired.y > 0.0 and ne.vel_desired == REST
    assert d.pos_desired == altitude_start.stopping_point_d(d, ap.estimate, ap.params.PSC) < -30.0
    assert (d.vel_desired, d.vel_target, d.accel_desired) == (0.0, 0.0, 0.0)


@pytest.mark.parametrize(
    ("vel", "wanted"),
    (((0.0, 0.0), (1.0, 2.0)), ((1e-7, 0.0), (1.0, 2.0)), ((0.5, 0.0), (1.5, 2.0)), ((0.0, -99.0), (1.0, -4.25))),
)
def test_the_stopping_point_is_no_farther_than_that_of_the_greatest_speed(
    vel: tuple[float, float], wanted: tuple[float, float]
) -> None:
    """A gain of 1, 5 m/s and 2.5 m/s^2: 0.5 x 2.5 + 25 / 5 m at the most."""
    assert position_start.stopping_point(Vec2(1.0, 2.0), Vec2(*vel), 1.0, 5.0, 2.5) == pytest.approx(wanted)


def test_on_the_ground_the_lean_decays(ap: Any) -> None:
    control = moving(ap)
    control.pos_ne.last_tick, control.pos_ne.accel_target = 100, Vec2(1.0, -2.0)
    position_start.relax_ne(*parts(ap))
    share = 1.0 - DT / (DT + 0.16)
    assert control.pos_ne.accel_target == pytest.approx((share, -2.0 * share))
    assert control.pos_ne.pos_desired == (1.0, -2.0), "at the present position"


def test_a_vehicle_that_may_stand_lets_its_position_error_decay_and_its_integrator_rest() -> None:
    c = PositionState()
    c.pos_desired, c.accel_target = Vec2(2.0, 1.0), Vec2(0.3, -0.1)
    position_start.soften_for_landing_ne(c, Vec3(1.0, 3.0, 0.0))
    share = DT / (DT + 0.16)
    assert c.pos_desired == pytest.approx((2.0 - share, 1.0 + 2.0 * share)) and c.limit == (0.3, -0.1)


def test_a_path_given_outright_is_taken_as_it_is() -> None:
    c = PositionState()
    position.set_pos_vel_accel_ne(c, Motion2(Vec2(1.0, 2.0), Vec2(3.0, 4.0), Vec2(5.0, 6.0)))
    assert (c.pos_desired, c.vel_desired, c.accel_desired) == ((1.0, 2.0), (3.0, 4.0), (5.0, 6.0))


def test_an_acceleration_is_followed_with_the_jerk_that_is_allowed() -> None:
    c = PositionState()
    c.jerk_max = 4.0
    position.input_accel_ne(c, Vec2(0.0, -3.0))
    assert c.accel_desired == pytest.approx((0.0, -4.0 * DT))
    position.input_accel_ne(c, Vec2(math.nan, 0.0))
    assert c.accel_desired == REST


@pytest.mark.parametrize(("disturbed", "off"), ((1, 0.5), (0, 0.0)))
def test_a_test_of_the_controllers_adds_to_what_is_measured_for_one_tick(ap: Any, disturbed: int, off: float) -> None:
    """SYSTEMID."""
    moving(ap)
    c = ap.control.pos_ne
    c.last_tick = 99
    position_start.init_ne(*parts(ap))
    c.disturbed, c.disturbance_pos, c.disturbance_vel = disturbed, Vec2(0.5, 0.0), Vec2(0.0, 0.25)
    position.update_ne(*parts(ap))
    assert c.pos_error == pytest.approx((-off, 0.0)) and c.vel_error.y == pytest.approx(-0.5 * off)
    assert not c.disturbed


def test_when_the_estimate_jumps_the_paths_jump_with_it_in_speed_as_well(ap: Any) -> None:
    moving(ap)
    position_start.init_ne(*parts(ap))
    altitude_start.init_d(*parts(ap))
    ap.control.tick += 1
    est = ap.estimate
    est.vel, est.reset_vel = Vec3(3.5, 4.0, -1.0), Vec3(0.5, 0.0, 0.5)
    est.reset_ne_count, est.reset_d_count = 4, 5
    position.update_ne(*parts(ap))
    altitude.update_d(*parts(ap))
    assert ap.control.pos_ne.vel_desired == pytest.approx((3.5, 4.0)) and ap.control.pos_d.vel_desired == -1.0
    assert (ap.control.pos_ne.reset_count, ap.control.pos_d.reset_count) == (4, 5)


def test_a_controller_that_did_not_run_starts_from_the_present_motion(ap: Any) -> None:
    moving(ap)
    ap.control.pos_ne.pos_desired, ap.control.pos_d.pos_desired = Vec2(500.0, 0.0), 500.0
    position.update_ne(*parts(ap))
    altitude.update_d(*parts(ap))
    assert ap.control.pos_ne.pos_desired == (1.0, -2.0) and ap.control.pos_d.pos_desired == -30.0


@pytest.mark.parametrize("bad", (math.nan, math.inf))
@pytest.mark.parametrize("axis", (0, 1, 2))
def test_a_point_that_is_no_number_stops_all_axes(axis: int, bad: float) -> None:
    ne, d = PositionState(), AltitudeState()
    ne.accel_max, ne.jerk_max, d.accel_max, d.jerk_max = 5.0, 50.0, 5.0, 50.0
    ne.vel_desired, d.vel_desired = Vec2(0.5, -0.5), 0.5
    point = [1.0, 2.0, 3.0]
    point[axis] = bad
    for _ in range(400):
        position_ned.input_pos_ned(ne, d, Vec3(*point))
    assert ne.vel_desired == pytest.approx((0.0, 0.0), abs=1e-3) and d.vel_desired == pytest.approx(0.0, abs=1e-3)


@pytest.mark.parametrize(
    ("point", "fastest"),
    (
        (Vec3(30.0, 40.0, 0.0), (3.0, 4.0, 0.0)),
        (Vec3(0.0, 0.0, -50.0), (0.0, 0.0, -2.0)),
        (Vec3(0.0, 0.0, 50.0), (0.0, 0.0, 1.0)),
        (Vec3(30.0, 0.0, -40.0), (1.5, 0.0, -2.0)),  # as steep as the line, as fast as the climb
        (Vec3(30.0, 0.0, 40.0), (0.75, 0.0, 1.0)),
    ),
)
def test_a_straight_line_is_flown_as_fast_as_its_slowest_axis_may(
    point: Vec3, fastest: tuple[float, float, float]
) -> None:
    ne, d = PositionState(), AltitudeState()
    ne.accel_max, ne.jerk_max, d.accel_max, d.jerk_max = 5.0, 50.0, 5.0, 50.0
    ne.speed_max, d.speed_up, d.speed_down = 5.0, 2.0, 1.0
    for _ in range(500):
        position_ned.input_pos_ned(ne, d, point)
    assert (*ne.vel_desired, d.vel_desired) == pytest.approx(fastest, abs=0.02)
