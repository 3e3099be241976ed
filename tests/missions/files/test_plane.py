# SPDX-License-Identifier: BSD-3-Clause
"""The plane in which surveys and corridors are drawn: north and east in metres, clockwise is to the right."""

from __future__ import annotations

import math

import pytest

from sitl.core.geodesy import METRES_PER_DEGE7
from sitl.missions.files.plane import Plane, Point, along, area, moved, shifted

SQUARE = [(0.0, 0.0), (10.0, 0.0), (10.0, 10.0), (0.0, 10.0)]
"""Clockwise: north, then east."""


def test_points_are_metres_from_the_planes_origin_and_back() -> None:
    plane = Plane((47.0, 8.0))
    north, east = plane.point((47.001, 8.002))
    assert north == pytest.approx(1e4 * METRES_PER_DEGE7) and east == pytest.approx(
        2e4 * METRES_PER_DEGE7 * 0.682, rel=1e-3
    )
    assert plane.location((north, east)) == pytest.approx((47.001, 8.002), abs=1e-8)
    assert plane.point((47.0, 8.0)) == (0.0, 0.0)


@pytest.mark.parametrize(
    ("b", "unit"),
    [((5.0, 2.0), (1.0, 0.0)), ((1.0, -7.0), (0.0, -1.0)), ((4.0, 6.0), (0.6, 0.8)), ((1.0, 2.0), (0, 0))],
)
def test_directions_have_length_one_and_that_to_itself_none(b: Point, unit: Point) -> None:
    assert along((1.0, 2.0), b) == pytest.approx(unit)


def test_moving_along_a_direction() -> None:
    assert moved((1.0, 2.0), (0.6, -0.8), 5.0) == pytest.approx((4.0, -2.0))


def test_areas_are_positive_clockwise() -> None:
    assert area(SQUARE) == pytest.approx(100.0) and area(SQUARE[::-1]) == pytest.approx(-100.0)
    assert area([(0.0, 0.0), (4.0, 0.0), (0.0, 3.0)]) == pytest.approx(6.0)
    assert area(SQUARE[:2]) == 0.0


def test_a_line_is_moved_to_its_right() -> None:
    assert shifted([(0.0, 0.0), (10.0, 0.0)], 2.0) == [pytest.approx((0, 2)), pytest.approx((10, 2))]
    assert shifted([(0.0, 0.0), (10.0, 0.0)], -2.0) == [pytest.approx((0, -2)), pytest.approx((10, -2))]
    corner = shifted([(0.0, 0.0), (10.0, 0.0), (10.0, 10.0)], 2.0)
    assert corner == [pytest.approx((0, 2)), pytest.approx((8, 2)), pytest.approx((8, 10))]


def test_a_polygon_grows_and_shrinks_on_all_sides() -> None:
    inner = shifted(SQUARE, 1.0, closed=True)
    assert [pytest.approx(p) for p in ((1, 1), (9, 1), (9, 9), (1, 9))] == inner
    assert area(shifted(SQUARE, -1.0, closed=True)) == pytest.approx(144.0)


def test_corners_are_mitred_threefold_at_most() -> None:
    """A turn of 170 degrees would reach 11 times as far."""
    back = (10.0 - 10.0 * math.cos(math.radians(10.0)), 10.0 * math.sin(math.radians(10.0)))
    corner = shifted([(0.0, 0.0), (10.0, 0.0), back], 1.0)[1]
    assert math.dist(corner, (10.0, 0.0)) == pytest.approx(3.0)
    sharp = shifted([(0.0, 0.0), (10.0, 0.0), (10.0 + 10.0 * math.cos(2.0), 10.0 * math.sin(2.0))], 1.0)[1]
    assert math.dist(sharp, (10.0, 0.0)) == pytest.approx(1.0 / math.cos(1.0))


def test_a_line_that_turns_back_on_itself_keeps_its_corner() -> None:
    assert shifted([(0.0, 0.0), (10.0, 0.0), (0.0, 0.0)], 1.0)[1] == pytest.approx((10.0, 0.0))
