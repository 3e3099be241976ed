# SPDX-License-Identifier: BSD-3-Clause
"""The target on legs, corners, path time and conditions, on the record of navigation alone."""

from __future__ import annotations

import math

import pytest
from hypothesis import given
from hypothesis import strategies as st

from sitl.autopilot.navigation import path
from sitl.autopilot.navigation.command import give, is_condition_met
from sitl.autopilot.navigation.leg import Limits, plan, write
from sitl.autopilot.navigation.state import (
    CONDITION_DELAY,
    CONDITION_DISTANCE,
    CONDITION_NONE,
    CONDITION_YAW,
    WAYPOINT,
    Leg,
    Nav,
)
from sitl.core.algebra import ZERO, norm
from sitl.core.vectors import Vec3

LIMITS = Limits(5.0, 2.0, 2.0)
number = st.floats(-100.0, 100.0)
vectors = st.builds(Vec3, number, number, number)


def put(leg: Leg, origin: Vec3, target: Vec3) -> None:
    """A leg from rest to rest."""
    line = target - origin
    write(leg, plan(norm(line), LIMITS), origin, line / norm(line), norm(line))


def corner() -> Nav:
    """20 m to the north, then 20 m to the east, without a stop."""
    nav = Nav()
    put(nav.current, ZERO, Vec3(20.0, 0.0, 0.0))
    put(nav.next, Vec3(20.0, 0.0, 0.0), Vec3(20.0, 20.0, 0.0))
    nav.current.fast = True
    return nav


def test_a_leg_is_followed_to_its_end() -> None:
    nav = Nav()
    put(nav.current, Vec3(1.0, 2.0, -3.0), Vec3(4.0, 6.0, -3.0))
    done, north = False, 0.0
    while not done:
        done = path.move(nav, 0.02, 2.0, 2.0)
        assert nav.pos.x >= north and norm(nav.vel) <= LIMITS.speed + 1e-9
        north = nav.pos.x
    assert tuple(nav.pos) == pytest.approx((4.0, 6.0, -3.0))
    assert tuple(nav.vel) == pytest.approx((0.0, 0.0, 0.0))


@given(st.floats(0.1, 5.0), st.floats(0.5, 5.0))
def test_a_corner_stays_within_its_radius(radius: float, accel_max: float) -> None:
    nav = corner()
    nearest, done = math.inf, False
    while not done:
        done = path.move(nav, 0.02, radius, accel_max)
        nearest = min(nearest, math.hypot(nav.pos.x - 20.0, nav.pos.y))
    assert nearest <= radius + 0.1
    assert nav.pos.x <= 20.0 + 1e-9


def test_a_corner_without_room_is_a_stop() -> None:
    nav = corner()
    while not path.move(nav, 0.02, 1e-6, 2.0):
        pass
    assert tuple(nav.pos) == pytest.approx((20.0, 0.0, 0.0), abs=0.01)


@given(vectors, vectors, vectors)
def test_path_time_runs_at_most_at_its_own_rate(pos: Vec3, vel: Vec3, target_vel: Vec3) -> None:
    nav = Nav()
    nav.vel = target_vel
    assert 0.0 <= path.feasible_time_scale(nav, pos, vel, 1.0) <= 1.0


def test_path_time_waits_for_a_vehicle_that_stands_and_runs_for_one_that_follows() -> None:
    nav = Nav()
    nav.pos, nav.vel = Vec3(10.0, 0.0, 0.0), Vec3(3.0, 0.0, 0.0)
    assert path.feasible_time_scale(nav, ZERO, ZERO, 1.0) == 0.0
    assert path.feasible_time_scale(nav, nav.pos, nav.vel, 1.0) == 1.0
    nav.time_scale = 1.0
    path.scale_time(nav, 0.0, 1.0, 0.02)
    assert nav.time_scale == pytest.approx(0.98)


def test_distance_and_bearing_are_horizontal() -> None:
    nav = Nav()
    nav.target = Vec3(3.0, 4.0, -50.0)
    assert path.distance(nav, ZERO) == 5.0
    assert path.bearing(nav, Vec3(3.0, 0.0, 0.0)) == pytest.approx(math.pi / 2)


def test_conditions() -> None:
    nav = Nav()
    nav.target = Vec3(10.0, 0.0, 0.0)
    nav.condition_until_us, nav.condition_distance = 1000, 4.0
    for kind, met in (
        (CONDITION_NONE, False),
        (CONDITION_DELAY, True),
        (CONDITION_DISTANCE, False),
        (CONDITION_YAW, False),
    ):
        nav.condition_kind = kind
        assert is_condition_met(nav, 1000, ZERO, False) == met
    assert is_condition_met(nav, 1000, ZERO, True)
    nav.condition_kind = CONDITION_DISTANCE
    assert is_condition_met(nav, 1000, Vec3(7.0, 0.0, 0.0), False)


def test_a_command_begins_with_clean_fields() -> None:
    nav = Nav()
    nav.completed = nav.has_target = True
    nav.delay = nav.turns = 2.0
    give(nav, WAYPOINT, 4)
    assert (nav.command_kind, nav.command_seq, nav.command_count) == (WAYPOINT, 4, 1)
    assert (nav.completed, nav.has_target, nav.delay, nav.turns) == (False, False, 0.0, 0.0)
