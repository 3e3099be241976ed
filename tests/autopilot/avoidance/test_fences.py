# SPDX-License-Identifier: BSD-3-Clause
"""Velocities before fences, and what a simulated sensor sees of them."""

from __future__ import annotations

import math

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from sitl.autopilot.avoidance import fences, proximity
from sitl.autopilot.avoidance.proximity import Proximity
from sitl.autopilot.avoidance.state import Avoidance
from sitl.autopilot.avoidance.velocity import Braking
from sitl.autopilot.fence.shapes import clearance, is_within
from sitl.autopilot.fence.state import CIRCLE_IN, CIRCLE_OUT, STAY_IN, STAY_OUT
from sitl.autopilot.params.avoidance import ProximitySensor
from sitl.core.vectors import Vec2
from tests.autopilot.avoidance.test_shortest_path import box, fence

STOP, SLIDE = Braking(1.0, 1.0, 0.0025, True), Braking(1.0, 1.0, 0.0025, False)
MARGIN = 2.0
AREAS = fence(
    box(STAY_IN, 0.0, 0.0, 40.0, 30.0),
    (STAY_OUT, [(10.0, 5.0), (25.0, 8.0), (12.0, 20.0)], 0.0),
    (CIRCLE_OUT, [(-20.0, -10.0)], 6.0),
    (CIRCLE_IN, [(0.0, 0.0)], 38.0),
)


@pytest.mark.slow
@settings(max_examples=60, deadline=None)
@given(st.floats(0.0, 2.0 * math.pi), st.floats(0.5, 8.0), st.sampled_from([STOP, SLIDE]))
def test_no_fence_is_crossed(course: float, speed: float, how: Braking) -> None:
    avoid, at = Avoidance(), Vec2(0.0, 0.0)
    asked = Vec2(math.cos(course), math.sin(course)) * speed
    for _ in range(600):
        at += fences.avoid_areas(avoid, AREAS, asked, at, fences.Margin(MARGIN, how)) * 0.05
    for s in range(AREAS.shapes):
        assert clearance(AREAS, s, at) >= (MARGIN - 0.1 if how is SLIDE else 0.1)


def test_who_is_on_the_wrong_side_is_left_alone() -> None:
    avoid = Avoidance()
    outside = Vec2(60.0, 0.0)
    assert not is_within(AREAS, 0, outside)
    assert fences.avoid_areas(avoid, AREAS, Vec2(-3.0, 0.0), outside, fences.Margin(MARGIN, SLIDE)) == Vec2(-3.0, 0.0)


def test_a_breached_margin_asks_for_backing_out() -> None:
    avoid, square = Avoidance(), fence(box(STAY_IN, 0.0, 0.0, 20.0, 20.0))
    for at, backs in ((Vec2(17.0, 0.0), False), (Vec2(18.05, 0.0), False), (Vec2(19.0, 0.0), True)):
        avoid.back_max = avoid.back_min = Vec2(0.0, 0.0)
        fences.avoid_areas(avoid, square, Vec2(0.0, 0.0), at, fences.Margin(MARGIN, SLIDE))
        assert (avoid.back_min.x < 0.0) == backs and avoid.back_max.x == 0.0


def test_areas_without_a_place_mean_nothing() -> None:
    unplaced = fence(box(STAY_IN, 0.0, 0.0, 5.0, 5.0))
    unplaced.is_placed = False
    assert fences.avoid_areas(
        Avoidance(), unplaced, Vec2(9.0, 0.0), Vec2(0.0, 0.0), fences.Margin(MARGIN, SLIDE)
    ) == Vec2(9.0, 0.0)


def test_a_simulated_sensor_sees_the_edges_of_areas() -> None:
    seen, areas = Proximity(), fence(box(STAY_IN, 0.0, 0.0, 40.0, 30.0), (CIRCLE_OUT, [(0.0, -20.0)], 4.0))
    seen.kind = proximity.SIMULATED
    fences.look(seen, areas, Vec2(10.0, 0.0), 0.5 * math.pi, ProximitySensor())
    proximity.end_scan(seen, 1_000_000, 0.0)
    distances = [float(seen.distance[k]) for k in range(proximity.SECTORS)]
    assert distances[0] == pytest.approx(30.0)  # it looks east
    assert distances[2] == pytest.approx(50.0)  # south
    assert distances[6] == pytest.approx(30.0)  # north
    assert distances[4] == pytest.approx(30.0)  # west: past the circle
    assert distances[1] == pytest.approx(math.hypot(30.0, 30.0))
    fences.look(seen, areas, Vec2(0.0, 0.0), 0.5 * math.pi, ProximitySensor())
    proximity.end_scan(seen, 1_100_000, 0.0)
    assert float(seen.distance[4]) == pytest.approx(16.0)  # the circle
