# SPDX-License-Identifier: BSD-3-Clause
"""Square-root controllers and kinematic shaping: continuous, within limits, without overshoot."""

from __future__ import annotations

import math

import pytest
from hypothesis import example, given, settings
from hypothesis import strategies as st

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
    shape_accel,
    shape_angle,
    shape_pos_vel_accel,
    shape_pos_vel_accel_2d,
    shape_vel_accel,
    sqrt_controller,
    sqrt_controller_2d,
)
from sitl.core.algebra import norm2
from sitl.core.vectors import Vec2, Vec3

DT = 0.0025
REST = Vec2(0.0, 0.0)
gains = st.floats(0.1, 10.0)
limits = st.floats(0.1, 20.0)
errors = st.floats(-100.0, 100.0)


@given(errors, gains, limits)
def test_sqrt_controller_is_odd_and_never_faster_than_p(error, p, limit):
    rate = sqrt_controller(error, p, limit, 0.0)
    assert rate == -sqrt_controller(-error, p, limit, 0.0)
    assert abs(rate) <= p * abs(error) * (1 + 1e-12)
    assert rate * error >= 0.0


@given(gains, limits)
def test_sqrt_controller_is_smooth_where_its_halves_meet(p, limit):
    knee = limit / (p * p)
    h = 1e-6 * knee
    below, above = (sqrt_controller(knee + d, p, limit, 0.0) for d in (-h, h))
    assert above - below == pytest.approx(2 * h * p, rel=1e-3)


@given(errors, gains, limits)
def test_inverse_undoes_the_controller(error, p, limit):
    rate = sqrt_controller(error, p, limit, 0.0)
    assert inverse_sqrt_controller(rate, p, limit) == pytest.approx(error, rel=1e-9, abs=1e-9)


@given(errors, st.floats(0.1, 1000.0), limits)
def test_one_period_never_passes_the_goal(error, p, limit):
    assert abs(sqrt_controller(error, p, limit, DT)) * DT <= abs(error) * (1 + 1e-12)


@given(errors, errors, gains, limits)
def test_two_dimensions_agree_with_one_along_the_error(ex, ey, p, limit):
    size = math.hypot(ex, ey)
    rate = sqrt_controller_2d(Vec2(ex, ey), p, limit, 0.0)
    assert norm2(rate) == pytest.approx(abs(sqrt_controller(size, p, limit, 0.0)), rel=1e-9, abs=1e-12)


@given(errors, errors, errors, errors, limits)
def test_limit_accel_keeps_the_limit_and_what_lies_across(vx, vy, ax, ay, most):
    bx, by = limit_accel(Vec2(vx, vy), Vec2(ax, ay), most)
    assert math.hypot(bx, by) <= max(most, 0.0) * (1 + 1e-9)
    across = vx * ay - vy * ax
    if math.hypot(vx, vy) > 1e-3 and abs(across) < most * math.hypot(vx, vy):
        assert vx * by - vy * bx == pytest.approx(across, rel=1e-6, abs=1e-6)


@given(st.floats(-50.0, 50.0), st.floats(1.0, 10.0), st.floats(0.5, 5.0), st.floats(1.0, 20.0))
@example(37.0, 1.0, 4.0, 1.0)
@settings(max_examples=15, deadline=None)
def test_position_shaping_keeps_its_limits_and_hardly_overshoots(goal, v_max, a_max, jerk):
    now = Motion(0.0, 0.0, 0.0)
    limits = Limits(-v_max, v_max, -a_max, a_max, jerk)
    end = 0.0
    for _ in range(int(120 / 0.01)):  # a jerk of 1 m/s^3 takes up to 107 s until it rests within 2 cm
        dt = 0.01
        now = advance(now, dt, 0.0, 0.0, 0.0)
        new = shape_pos_vel_accel(Motion(goal, 0.0, 0.0), now, limits, dt)
        assert abs(new - now.acc) <= jerk * dt * (1 + 1e-9)
        assert abs(new) <= a_max * (1 + 1e-9)
        now = now._replace(acc=new)
        assert abs(now.vel) <= v_max * 1.01 + 0.5 * jerk * dt
        end = max(end, math.copysign(1.0, goal) * (now.pos - goal))
    assert now.pos == pytest.approx(goal, abs=0.02)
    assert abs(now.vel) < 0.02
    assert end <= 0.045 * abs(goal) + 0.02


@given(st.floats(-30, 30), st.floats(-30, 30), st.floats(-3, 3), st.floats(-3, 3))
@settings(max_examples=10, deadline=None)
def test_horizontal_shaping_reaches_a_point_from_any_motion(gx, gy, vx, vy):
    now, goal, limits = Motion2(REST, Vec2(vx, vy), REST), Vec2(gx, gy), Limits2(5.0, 2.5, 5.0)
    dt = 0.01
    for _ in range(4000):
        now = advance_2d(now, dt, REST, REST, REST)
        new = shape_pos_vel_accel_2d(Motion2(goal, REST, REST), now, limits, dt)
        assert norm2(new - now.acc) <= 5.0 * dt * (1 + 1e-9)
        now = now._replace(acc=new)
        assert norm2(new) <= 2.5 * (1 + 1e-9)
    assert norm2(now.pos - goal) < 0.02
    assert norm2(now.vel) < 0.02


@given(st.floats(-60, 60), st.floats(-60, 60), st.floats(-10, 10), st.floats(-10, 10))
@example(0.0, 20.0, 10.0, 0.0)  # the goal lies where a circle at full speed has its centre
@settings(max_examples=10, deadline=None)
def test_braking_first_reaches_a_point_from_any_motion(gx, gy, vx, vy):
    now, goal, limits = Motion2(REST, Vec2(vx, vy), REST), Vec2(gx, gy), Limits2(10.0, 2.5, 5.0)
    for _ in range(4000):
        now = advance_2d(now, 0.02, REST, REST, REST)
        now = now._replace(acc=shape_pos_vel_accel_2d(Motion2(goal, REST, REST), now, limits, 0.02))
        assert norm2(now.acc) <= limits.acc_max * (1 + 1e-9)
    assert norm2(now.pos - goal) < 0.05
    assert norm2(now.vel) < 0.05


def test_velocity_shaping_uses_the_limit_of_its_direction():
    limits = Limits(0.0, 0.0, -1.0, 3.0, 5.0)
    up = down = 0.0
    for _ in range(400):
        up = shape_vel_accel(100.0, 0.0, Motion(0.0, 0.0, up), limits, DT)
        down = shape_vel_accel(-100.0, 0.0, Motion(0.0, 0.0, down), limits, DT)
    assert (up, down) == (pytest.approx(3.0), pytest.approx(-1.0))


def test_without_jerk_limit_acceleration_jumps():
    assert shape_accel(2.0, 0.0, 0.0, DT) == 2.0


def test_target_waits_where_the_actuator_is_used_up():
    now = Motion(0.0, 1.0, 1.0)
    assert advance(now, DT, 1.0, 1.0, 1.0) == now
    moved = advance(now, DT, -1.0, 1.0, 1.0)
    assert moved.pos > 0.0 and moved.vel > 1.0


@given(st.floats(-3.0, 3.0))
@settings(max_examples=20, deadline=None)
def test_angle_shaping_stops_at_the_angle(goal):
    angle = rate = 0.0
    for _ in range(1600):
        new = shape_angle(goal - angle, rate, 0.15, 19.2, DT, 0.0, 0.0)
        assert abs(new - rate) <= 19.2 * DT * (1 + 1e-9)
        rate = new
        angle += rate * DT
    assert angle == pytest.approx(goal, abs=1e-3)


@given(st.floats(-1, 1), st.floats(-1, 1), st.floats(-1, 1))
def test_kinematic_limit_touches_one_limit_and_passes_none(x, y, z):
    n = math.sqrt(x * x + y * y + z * z)
    if n < 1e-3:
        return
    x, y, z = x / n, y / n, z / n
    k = kinematic_limit(Vec3(x, y, z), 5.0, 2.0, 1.0)
    ratios = (k * math.hypot(x, y) / 5.0, k * z / 1.0, -k * z / 2.0)
    assert max(ratios) == pytest.approx(1.0)
