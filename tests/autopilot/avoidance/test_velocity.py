# SPDX-License-Identifier: BSD-3-Clause
"""Velocities before walls and circles: they stop before them, slide along them, and leave margins."""

from __future__ import annotations

import math

import pytest
from hypothesis import assume, given
from hypothesis import strategies as st

from sitl.autopilot.avoidance import velocity
from sitl.autopilot.avoidance.state import Avoidance
from sitl.autopilot.avoidance.velocity import Braking, Wall
from sitl.core.algebra import dot2, norm2
from sitl.core.vectors import Vec2

STOP, SLIDE = Braking(1.0, 1.0, 0.0025, True), Braking(1.0, 1.0, 0.0025, False)
EAST_WALL = Wall(Vec2(-50.0, 10.0), Vec2(50.0, 10.0))
"""It runs north, 10 m to the east."""
speeds = st.floats(-8.0, 8.0)


@given(speeds, speeds, st.floats(2.5, 30.0), st.sampled_from([STOP, SLIDE]))
def test_no_velocity_leads_into_a_margin(north: float, east: float, away: float, how: Braking) -> None:
    wall = Wall(Vec2(-500.0, away), Vec2(500.0, away))
    at, vel = Vec2(0.0, 0.0), Vec2(north, east)
    for _ in range(4000):
        here = Wall(wall.a - at, wall.b - at)
        at += velocity.before_wall(vel, here, 2.0, how) * 0.01
    slant = (
        east / norm2(vel) if how.stops and norm2(vel) > 0.0 < east else 1.0
    )  # who stops keeps the margin along the way
    assert at.y <= away - 2.0 * slant + 0.03


def test_sliding_keeps_the_speed_along_the_wall_and_stopping_does_not() -> None:
    vel = Vec2(3.0, 6.0)
    along, straight = velocity.before_wall(vel, EAST_WALL, 2.0, SLIDE), velocity.before_wall(vel, EAST_WALL, 2.0, STOP)
    assert along.x == 3.0 and 0.0 < along.y < 6.0
    assert straight.x / straight.y == pytest.approx(0.5) and straight.y < 6.0
    assert velocity.before_wall(Vec2(3.0, -6.0), EAST_WALL, 2.0, STOP) == Vec2(3.0, -6.0)


@given(speeds, speeds, st.floats(0.0, 2.0 * math.pi), st.sampled_from([STOP, SLIDE]))
def test_a_circle_is_not_left(north: float, east: float, bearing: float, how: Braking) -> None:
    at = Vec2(math.cos(bearing), math.sin(bearing)) * 5.0
    for _ in range(3000):
        at += velocity.within_circle(Vec2(north, east), -at, 12.0, how) * 0.01
    assert norm2(at) <= 12.0 + 0.05


@given(speeds, speeds, st.floats(0.0, 2.0 * math.pi), st.sampled_from([STOP, SLIDE]))
def test_a_circle_is_not_entered(north: float, east: float, bearing: float, how: Braking) -> None:
    at = Vec2(math.cos(bearing), math.sin(bearing)) * 15.0
    for _ in range(3000):
        at += velocity.outside_circle(Vec2(north, east), -at, 6.0, how) * 0.01
        assert norm2(at) >= 6.0 - 0.05


@given(st.floats(-5.0, 5.0), st.floats(-5.0, 5.0), st.floats(0.05, 3.0))
def test_a_breached_margin_is_left_no_faster_than_asked(north: float, east: float, breach: float) -> None:
    towards = Vec2(north, east)
    assume(norm2(towards) > 0.01)
    avoid = Avoidance()
    velocity.begin(avoid)
    velocity.back_out(avoid, towards, breach, SLIDE)
    back = velocity.with_backing(avoid, Vec2(0.0, 0.0), 0.75)
    assert dot2(back, towards) < 0.0 and norm2(back) <= 0.75 + 1e-9
    assert velocity.with_backing(avoid, Vec2(0.0, 0.0), 0.0) == Vec2(0.0, 0.0)
    assert velocity.with_backing(avoid, back * 3.0, 0.75) == back * 3.0  # who leaves faster may


def test_a_limit_comes_with_no_more_than_the_acceleration() -> None:
    avoid, asked = Avoidance(), Vec2(5.0, 0.0)
    vel = velocity.changed_slowly(avoid, asked, Vec2(0.0, 0.0), 1_000_000, 3.0, 0.1)
    assert vel.x == pytest.approx(4.7)
    vel = velocity.changed_slowly(avoid, asked, Vec2(0.0, 0.0), 1_100_000, 3.0, 0.1)
    assert vel.x == pytest.approx(4.4)
    assert velocity.changed_slowly(avoid, asked, Vec2(0.0, 0.0), 1_100_000, 0.0, 0.1).x == 0.0
    assert velocity.changed_slowly(avoid, asked, asked, 1_200_000, 3.0, 0.1) == asked


def test_a_climb_stops_below_its_limit_and_sinks_from_above_it() -> None:
    assert velocity.climb_below(5.0, 10.0, 0.75, SLIDE) == pytest.approx(math.sqrt(2.0 * 9.5))
    assert velocity.climb_below(-2.0, 10.0, 0.75, SLIDE) == -2.0
    assert velocity.climb_below(5.0, 0.0, 0.75, SLIDE) == 0.0
    assert velocity.climb_below(5.0, -20.0, 0.75, SLIDE) == -0.75
    assert velocity.climb_below(-2.0, -20.0, 0.75, SLIDE) == -2.0
