# SPDX-License-Identifier: BSD-3-Clause
"""Square-root controllers and shaping at the edges: limits that are off, gains of zero, goals that move, used-up
actuators."""

from __future__ import annotations

import math

import pytest

from sitl.autopilot.control.shaping import (
    Limits,
    Limits2,
    Motion,
    Motion2,
    advance,
    advance_2d,
    inverse_sqrt_controller,
    kinematic_limit,
    limit_accel,
    shape_accel_2d,
    shape_angle,
    shape_pos_vel_accel,
    shape_pos_vel_accel_2d,
    shape_rate,
    shape_vel_accel,
    shape_vel_accel_2d,
    sqrt_controller,
    sqrt_controller_2d,
)
from sitl.core.vectors import Vec2, Vec3

DT = 0.0025
REST = Vec2(0.0, 0.0)


@pytest.mark.parametrize("error", (4.0, -4.0))
@pytest.mark.parametrize(
    ("p", "limit", "size"),
    (
        (2.0, 0.0, 8.0),  # no limit: P alone
        (0.0, 2.0, 4.0),  # no gain: the square root alone, sqrt(2 x 2 x 4)
        (2.0, 8.0, 2.0 * math.sqrt(12.0)),  # sqrt(2 x 8 x (4 - 1))
        (1.0, 8.0, 4.0),  # below its knee at 8
        (0.0, 0.0, 0.0),
    ),
)
def test_each_half_of_the_controller_alone(error: float, p: float, limit: float, size: float) -> None:
    wanted = math.copysign(size, error)
    assert sqrt_controller(error, p, limit, 0.0) == pytest.approx(wanted)
    assert sqrt_controller_2d(Vec2(0.6 * error, 0.8 * error), p, limit, 0.0) == pytest.approx(
        (0.6 * wanted, 0.8 * wanted)
    )


@pytest.mark.parametrize("dt", (0.1, 1.0))
def test_a_gain_too_high_for_the_period_reaches_zero_in_one(dt: float) -> None:
    assert sqrt_controller(0.5, 1000.0, 0.0, dt) * dt == pytest.approx(0.5)
    assert sqrt_controller_2d(Vec2(0.3, -0.4), 1000.0, 0.0, dt) * dt == pytest.approx((0.3, -0.4))
    assert sqrt_controller(0.5, 0.5, 0.0, dt) == 0.25
    assert sqrt_controller_2d(Vec2(0.5, 0.0), 0.5, 0.0, dt) == (0.25, 0.0)


def test_no_error_asks_for_nothing_even_without_a_gain() -> None:
    assert sqrt_controller(0.0, 0.0, 5.0, 0.0) == 0.0
    assert sqrt_controller_2d(REST, 0.0, 5.0, 0.0) == REST


@pytest.mark.parametrize("rate", (3.0, -3.0))
@pytest.mark.parametrize(
    ("p", "limit", "size"),
    ((2.0, 0.0, 1.5), (0.0, 0.0, 0.0), (0.0, 1.5, 3.0), (2.0, 6.0, 1.5), (2.0, 4.0, 0.5 + 9.0 / 8.0)),
)
def test_the_distance_to_stop(rate: float, p: float, limit: float, size: float) -> None:
    assert inverse_sqrt_controller(rate, p, limit) == pytest.approx(math.copysign(size, rate))


@pytest.mark.parametrize(
    ("vel", "acc", "most", "wanted"),
    (
        (Vec2(1.0, 0.0), Vec2(3.0, 4.0), 0.0, (3.0, 4.0)),  # no limit
        (Vec2(1.0, 0.0), Vec2(3.0, 4.0), 5.0, (3.0, 4.0)),  # just within
        (REST, Vec2(6.0, 8.0), 5.0, (3.0, 4.0)),  # without a motion shortened
        (Vec2(1.0, 0.0), Vec2(9.0, 4.0), 5.0, (3.0, 4.0)),  # what lies along is given up
        (Vec2(1.0, 0.0), Vec2(-9.0, 4.0), 5.0, (-3.0, 4.0)),
        (Vec2(0.0, 2.0), Vec2(4.0, 9.0), 5.0, (4.0, 3.0)),
        (Vec2(1.0, 0.0), Vec2(1.0, 7.0), 5.0, (0.0, 5.0)),  # all of it goes across
        (Vec2(1.0, 0.0), Vec2(1.0, -7.0), 5.0, (0.0, -5.0)),
    ),
)
def test_a_bend_keeps_its_acceleration_across(vel: Vec2, acc: Vec2, most: float, wanted: tuple[float, float]) -> None:
    assert limit_accel(vel, acc, most) == pytest.approx(wanted)


def test_without_a_limit_of_jerk_accelerations_jump_in_the_plane_as_well() -> None:
    assert shape_accel_2d(Vec2(3.0, -4.0), REST, 0.0, DT) == (3.0, -4.0)
    assert shape_accel_2d(Vec2(3.0, -4.0), REST, 10.0, DT) == pytest.approx((0.6 * 10.0 * DT, -0.8 * 10.0 * DT))


@pytest.mark.parametrize(("goal", "braking"), ((1.0, 2.0), (-1.0, 4.0)))
def test_an_approach_uses_half_of_the_deceleration_of_its_direction(goal: float, braking: float) -> None:
    """Rising it brakes with the acceleration down, here 2; falling with that up, here 4: it may come as fast as it can
    stop. The gain near the goal is half of jerk over acceleration."""
    limits = Limits(-50.0, 50.0, -2.0, 4.0, 1000.0)
    vel = sqrt_controller(goal, 500.0 / braking, 0.5 * braking, 0.0)
    still = Motion(0.0, vel, 0.0)
    faster, slower = (
        shape_pos_vel_accel(Motion(goal, 0.0, 0.0), still._replace(vel=vel + d), limits, DT) for d in (1e-3, -1e-3)
    )
    assert faster < 0.0 < slower


@pytest.mark.parametrize(("goal", "speed"), ((100.0, 3.0), (-100.0, -2.0)))
def test_an_approach_keeps_the_speed_of_its_direction(goal: float, speed: float) -> None:
    limits = Limits(-2.0, 3.0, -5.0, 5.0, 50.0)
    assert shape_pos_vel_accel(Motion(goal, 0.0, 0.0), Motion(0.0, speed, 0.0), limits, DT) == pytest.approx(0.0)
    none = limits._replace(vel_min=0.0, vel_max=0.0)
    assert shape_pos_vel_accel(Motion(goal, 0.0, 0.0), Motion(0.0, speed, 0.0), none, DT) * goal > 0.0


@pytest.mark.parametrize("one", (Limits(-2.0, 0.0, -5.0, 5.0, 50.0), Limits(0.0, 2.0, -5.0, 5.0, 50.0)))
def test_one_limit_of_speed_counts_where_the_other_is_zero(one: Limits) -> None:
    for goal in (100.0, -100.0):
        blocked = (goal > 0.0) == (one.vel_max == 0.0)
        out = shape_pos_vel_accel(Motion(goal, 0.0, 0.0), Motion(0.0, 0.0, 0.0), one, DT)
        assert (out == 0.0) == blocked


def test_in_the_plane_a_speed_of_zero_is_no_limit() -> None:
    far, now = Motion2(Vec2(300.0, 400.0), REST, REST), Motion2(REST, Vec2(3.0, 4.0), REST)
    assert shape_pos_vel_accel_2d(far, now, Limits2(5.0, 2.0, 50.0), DT) == pytest.approx((0.0, 0.0), abs=1e-9)
    free = shape_pos_vel_accel_2d(far, now, Limits2(0.0, 2.0, 50.0), DT)
    assert free == pytest.approx((0.6 * 50.0 * DT, 0.8 * 50.0 * DT))


def test_a_goal_that_moves_is_met_with_its_own_motion() -> None:
    goal, limits = Motion(5.0, 2.0, 0.3), Limits(-9.0, 9.0, -5.0, 5.0, 50.0)
    assert shape_pos_vel_accel(goal, goal, limits, DT) == pytest.approx(0.3)
    assert shape_vel_accel(2.0, 0.3, goal, limits, DT) == pytest.approx(0.3)
    goal2, limits2 = Motion2(Vec2(5.0, 1.0), Vec2(2.0, 1.0), Vec2(0.3, -0.2)), Limits2(9.0, 5.0, 50.0)
    assert shape_pos_vel_accel_2d(goal2, goal2, limits2, DT) == pytest.approx((0.3, -0.2))
    assert shape_vel_accel_2d(goal2.vel, goal2.acc, goal2, limits2, DT) == pytest.approx((0.3, -0.2))


def test_motion_goes_on_at_constant_acceleration() -> None:
    assert advance(Motion(1.0, 2.0, 3.0), 2.0, 0.0, 0.0, 0.0) == (11.0, 8.0, 3.0)
    moved = advance_2d(Motion2(Vec2(1.0, -1.0), Vec2(2.0, -2.0), Vec2(3.0, -3.0)), 2.0, REST, REST, REST)
    assert moved == ((11.0, -11.0), (8.0, -8.0), (3.0, -3.0))


@pytest.mark.parametrize(
    ("limit", "pos_error", "vel_error", "waits"),
    (
        (1.0, 1.0, 1.0, (True, True)),
        (1.0, 0.0, 1.0, (False, True)),  # only what is behind waits
        (1.0, 1.0, 0.0, (True, False)),
        (1.0, -1.0, -1.0, (False, False)),
        (-1.0, 1.0, 1.0, (False, False)),
        (0.0, 1.0, 1.0, (False, False)),
    ),
)
def test_the_path_and_its_speed_wait_where_the_actuators_are_used_up(
    limit: float, pos_error: float, vel_error: float, waits: tuple[bool, bool]
) -> None:
    now = Motion(0.0, 1.0, 1.0)
    moved = advance(now, DT, limit, pos_error, vel_error)
    assert (moved.pos == 0.0, moved.vel == 1.0) == waits
    plane = Motion2(REST, Vec2(1.0, 0.0), Vec2(1.0, 0.0))
    moved2 = advance_2d(plane, DT, Vec2(limit, 0.0), Vec2(pos_error, 0.0), Vec2(vel_error, 0.0))
    assert (moved2.pos == REST, moved2.vel == plane.vel) == waits


@pytest.mark.parametrize(("speed", "waits"), ((0.0, True), (-1.0, False)))
def test_in_the_plane_a_speed_against_the_limit_may_shrink(speed: float, waits: bool) -> None:
    now = Motion2(REST, Vec2(speed, 0.0), Vec2(1.0, 0.0))
    moved = advance_2d(now, DT, Vec2(1.0, 0.0), REST, Vec2(1.0, 0.0))
    assert (moved.vel == now.vel) == waits


@pytest.mark.parametrize(
    ("time_constant", "limit", "wanted"),
    (
        (0.0, 0.0, 5.0),  # at once
        (0.25, 0.0, 1.0 + 4.0 * DT / 0.25),
        (0.001, 0.0, 1.0 + 4.0 * DT / 0.01),  # no shorter than 10 ms
        (0.0, 8.0, 1.0 + 8.0 * DT),
        (0.25, 8.0, 1.0 + 8.0 * DT),
        (0.25, 80.0, 1.0 + 4.0 * DT / 0.25),
    ),
)
def test_a_rate_follows_with_its_time_constant_and_acceleration(
    time_constant: float, limit: float, wanted: float
) -> None:
    assert shape_rate(1.0, 5.0, limit, time_constant, DT) == pytest.approx(wanted)
    assert shape_rate(-1.0, -5.0, limit, time_constant, DT) == pytest.approx(-wanted)


def test_a_rate_is_reached_within_a_period_longer_than_its_time_constant() -> None:
    assert shape_rate(1.0, 5.0, 0.0, 0.1, 0.2) == 5.0


@pytest.mark.parametrize(
    ("error", "ahead", "most", "wanted"),
    ((0.3, 0.0, 0.0, 3.0), (0.3, 0.5, 0.0, 3.5), (0.3, 0.0, 2.0, 2.0), (-0.3, 0.0, 2.0, -2.0), (0.0, 0.5, 0.0, 0.5)),
)
def test_the_rate_towards_an_angle(error: float, ahead: float, most: float, wanted: float) -> None:
    """Without a limit of acceleration it decays with its time constant of 0.1 s."""
    assert shape_angle(error, 0.0, 0.1, 0.0, DT, ahead, most) == pytest.approx(wanted)
    assert shape_angle(error, 0.0, 0.1, 1.0, DT, ahead, most) == pytest.approx(math.copysign(DT, wanted))


def test_a_time_constant_of_an_angle_is_ten_milliseconds_at_least() -> None:
    assert shape_angle(0.1, 0.0, 0.0, 0.0, DT, 0.0, 0.0) == pytest.approx(0.1 / 0.01)


@pytest.mark.parametrize(
    ("direction", "length"),
    (
        (Vec3(1.0, 0.0, 0.0), 5.0),
        (Vec3(0.0, 0.0, -1.0), 2.0),
        (Vec3(0.0, 0.0, 1.0), 1.0),
        (Vec3(0.6, 0.0, 0.8), 1.25),
        (Vec3(0.0, -0.6, -0.8), 2.5),
        (Vec3(0.96, 0.0, 0.28), 1.0 / 0.28),
        (Vec3(0.995, 0.0, -0.1), 5.0 / 0.995),
        (Vec3(0.0, 0.0, 0.0), 1e9),
    ),
)
def test_the_longest_vector_in_a_direction(direction: Vec3, length: float) -> None:
    assert kinematic_limit(direction, 5.0, 2.0, 1.0) == pytest.approx(length)
