# SPDX-License-Identifier: BSD-3-Clause
"""The shortest way around fences: it keeps its margin, is no longer than it must be, and is not found where none is."""

from __future__ import annotations

import itertools
import math

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from sitl.autopilot.avoidance.shortest_path import Map, a_star
from sitl.autopilot.fence.state import CIRCLE_IN, CIRCLE_OUT, STAY_IN, STAY_OUT, FenceState
from sitl.core.vectors import Vec2

Area = tuple[int, list[tuple[float, float]], float]
MARGIN = 3.0


def box(kind: int, north: float, east: float, half_north: float, half_east: float) -> Area:
    corners = [(-1, -1), (1, -1), (1, 1), (-1, 1)]
    return kind, [(north + a * half_north, east + b * half_east) for a, b in corners], 0.0


def fence(*areas: Area) -> FenceState:
    made = FenceState()
    for kind, corners, radius in areas:
        s = made.shapes
        made.kind[s], made.first[s], made.count[s], made.radius[s] = kind, made.corners, len(corners), radius
        for north, east in corners:
            made.north[made.corners], made.east[made.corners] = north, east
            made.corners += 1
        made.shapes += 1
    made.is_placed = True
    return made


def samples(way: list[Vec2]) -> np.ndarray[tuple[int, ...], np.dtype[np.float64]]:
    """Places along a way, 0.1 m apart."""
    found = [np.empty((0, 2))]
    for a, b in itertools.pairwise(way):
        count = max(int(math.dist(a, b) / 0.1), 1)
        found.append(np.linspace(a, b, count + 1))
    return np.concatenate(found)


def length(way: list[Vec2]) -> float:
    return sum(math.dist(a, b) for a, b in itertools.pairwise(way))


def test_a_free_way_is_straight() -> None:
    assert a_star(fence(box(STAY_OUT, 50.0, 50.0, 5.0, 5.0)), Vec2(0.0, 0.0), Vec2(40.0, 0.0), MARGIN) == [
        Vec2(40.0, 0.0)
    ]


def test_a_wall_is_gone_round_on_its_shorter_side_with_the_margin() -> None:
    walls = fence(box(STAY_OUT, 20.0, 5.0, 2.0, 15.0))
    start, end = Vec2(0.0, 0.0), Vec2(40.0, 0.0)
    way = a_star(walls, start, end, MARGIN)
    assert way is not None and way[-1] == end
    places = samples([start, *way])
    assert places[:, 1].min() < -10.0 and places[:, 1].max() < 1.0
    assert Map(walls, MARGIN).clearance(places).min() == pytest.approx(MARGIN, abs=0.1)
    assert length([start, *way]) < 2.0 * math.hypot(18.0, 13.5) + 4.0 + 2.0


def test_there_is_no_way_out_of_a_closed_area_nor_into_one() -> None:
    closed = fence(box(STAY_IN, 0.0, 0.0, 20.0, 20.0), box(STAY_OUT, 100.0, 0.0, 5.0, 5.0))
    assert a_star(closed, Vec2(0.0, 0.0), Vec2(40.0, 0.0), MARGIN) is None
    assert a_star(fence(box(STAY_OUT, 100.0, 0.0, 5.0, 5.0)), Vec2(0.0, 0.0), Vec2(100.0, 0.0), MARGIN) is None
    assert a_star(fence((CIRCLE_IN, [(0.0, 0.0)], 20.0)), Vec2(0.0, 0.0), Vec2(40.0, 0.0), MARGIN) is None


def test_a_gap_narrower_than_two_margins_is_closed() -> None:
    def gap(width: float) -> FenceState:
        half = 0.5 * width
        return fence(
            box(STAY_IN, 20.0, 0.0, 40.0, 30.0),
            box(STAY_OUT, 20.0, -15.5 - half, 2.0, 15.5),
            box(STAY_OUT, 20.0, 15.5 + half, 2.0, 15.5),
        )

    start, end = Vec2(0.0, 5.0), Vec2(40.0, -5.0)
    way = a_star(gap(7.0), start, end, MARGIN)
    assert way is not None and np.abs(samples([start, *way])[:, 1]).max() < 10.0
    assert a_star(gap(5.0), start, end, MARGIN) is None


def test_who_begins_within_a_margin_leaves_it() -> None:
    walls = fence(box(STAY_OUT, 20.0, 0.0, 2.0, 10.0))
    start, end = Vec2(17.0, 0.0), Vec2(23.0, 0.0)  # both a metre from the wall
    way = a_star(walls, start, end, MARGIN)
    assert way is not None and Map(walls, MARGIN).clearance(samples([start, *way])).min() > 0.9


circles = st.lists(
    st.tuples(st.floats(10.0, 90.0), st.floats(-20.0, 20.0), st.floats(1.0, 12.0)), min_size=1, max_size=8
)


@settings(max_examples=60)
@given(circles)
def test_a_way_through_a_forest_keeps_its_margin(trees: list[tuple[float, float, float]]) -> None:
    forest = fence(*((CIRCLE_OUT, [(north, east)], radius) for north, east, radius in trees))
    start, end = Vec2(-10.0, 0.0), Vec2(110.0, 0.0)
    way = a_star(forest, start, end, MARGIN)
    assert way is not None  # one can always go round all of them
    assert Map(forest, MARGIN).clearance(samples([start, *way])).min() >= MARGIN - 0.02
    assert length([start, *way]) >= 120.0 - 1e-9
