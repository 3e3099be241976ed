# SPDX-License-Identifier: BSD-3-Clause
"""Areas of the fence: what items become, on which side of them a point is, and how far from their edges."""

from __future__ import annotations

import math

import pytest

from sitl.autopilot.fence import items, shapes
from sitl.autopilot.fence.state import CORNERS, SHAPES, FenceState
from sitl.autopilot.mission.item import MissionItem
from sitl.autopilot.state import Estimate
from sitl.core.geodesy import add_offset
from sitl.core.mavlink import MavCmd
from sitl.core.vectors import Vec2

LAT, LON = 473000000, 85000000


def at(command: int, p1: float, north: float, east: float) -> MissionItem:
    place = add_offset(LAT, LON, north, east)
    return MissionItem(command, 0, p1, x=round(place.lat), y=round(place.lon))


def polygon(command: int, *corners: tuple[float, float]) -> list[MissionItem]:
    return [at(command, len(corners), *corner) for corner in corners]


def placed(*listed: MissionItem) -> FenceState:
    """A fence of items, with the estimator's origin at LAT, LON."""
    fence, estimate = FenceState(), Estimate()
    items.load(fence, list(items.shapes(listed)))
    assert not fence.is_placed
    shapes.use_origin(fence, estimate)
    assert not fence.is_placed  # without an origin no place means anything
    estimate.origin_set, estimate.origin_lat, estimate.origin_lon = True, LAT, LON
    shapes.use_origin(fence, estimate)
    assert fence.is_placed
    return fence


SQUARE = ((100.0, 100.0), (100.0, 200.0), (200.0, 200.0), (200.0, 100.0))
DART = ((0.0, 0.0), (40.0, 20.0), (0.0, 40.0), (10.0, 20.0))
"""It has a corner that points inwards."""


def test_corners_are_where_the_items_say() -> None:
    fence = placed(
        *polygon(MavCmd.NAV_FENCE_POLYGON_VERTEX_INCLUSION, *SQUARE),
        at(MavCmd.NAV_FENCE_CIRCLE_EXCLUSION, 7.5, -2000.0, 3000.0),
    )
    assert fence.shapes == 2
    for k, corner in enumerate(SQUARE):
        assert shapes.corner_of(fence, 0, k) == pytest.approx(corner, abs=0.02)  # 1e-7 degree is 11 mm
    assert shapes.corner_of(fence, 0, 4) == shapes.corner_of(fence, 0, 0)
    assert shapes.centre(fence, 1) == pytest.approx((-2000.0, 3000.0), abs=0.02)
    assert [shapes.is_circle(fence, s) for s in range(2)] == [False, True]
    assert [shapes.is_inclusion(fence, s) for s in range(2)] == [True, False]


@pytest.mark.parametrize(
    "point, inside",
    [((150.0, 150.0), True), ((99.0, 150.0), False), ((201.0, 150.0), False), ((150.0, 99.0), False),
     ((150.0, 201.0), False), ((300.0, 300.0), False)],
)  # fmt: skip
def test_a_point_is_in_a_square_or_not(point: tuple[float, float], inside: bool) -> None:
    fence = placed(*polygon(MavCmd.NAV_FENCE_POLYGON_VERTEX_INCLUSION, *SQUARE))
    assert shapes.is_within(fence, 0, Vec2(*point)) == inside


def test_the_notch_of_a_polygon_is_outside() -> None:
    fence = placed(*polygon(MavCmd.NAV_FENCE_POLYGON_VERTEX_EXCLUSION, *DART))
    assert shapes.is_within(fence, 0, Vec2(12.0, 20.0))
    assert not shapes.is_within(fence, 0, Vec2(8.0, 20.0))


def test_room_is_the_distance_to_the_edge_on_the_allowed_side() -> None:
    fence = placed(
        *polygon(MavCmd.NAV_FENCE_POLYGON_VERTEX_INCLUSION, *SQUARE),
        *polygon(MavCmd.NAV_FENCE_POLYGON_VERTEX_EXCLUSION, *SQUARE),
        at(MavCmd.NAV_FENCE_CIRCLE_INCLUSION, 50.0, 0.0, 0.0),
        at(MavCmd.NAV_FENCE_CIRCLE_EXCLUSION, 50.0, 0.0, 0.0),
    )
    inside, outside = Vec2(150.0, 190.0), Vec2(203.0, 204.0)
    assert shapes.clearance(fence, 0, inside) == pytest.approx(10.0, abs=0.02)
    assert shapes.clearance(fence, 0, outside) == pytest.approx(-5.0, abs=0.02)  # to the corner
    assert shapes.clearance(fence, 1, inside) == pytest.approx(-10.0, abs=0.02)
    assert shapes.clearance(fence, 1, outside) == pytest.approx(5.0, abs=0.02)
    assert shapes.nearest_on_edge(fence, 0, outside) == pytest.approx((200.0, 200.0), abs=0.02)
    for s, sign in ((2, 1.0), (3, -1.0)):
        assert shapes.clearance(fence, s, Vec2(30.0, 0.0)) == pytest.approx(sign * 20.0, abs=0.02)
        assert shapes.clearance(fence, s, Vec2(0.0, 60.0)) == pytest.approx(-sign * 10.0, abs=0.02)
    assert shapes.distance_to_edge(fence, 2, shapes.centre(fence, 2)) == pytest.approx(50.0)


def test_another_origin_moves_no_corner_on_the_globe() -> None:
    fence, estimate = placed(*polygon(MavCmd.NAV_FENCE_POLYGON_VERTEX_INCLUSION, *SQUARE)), Estimate()
    place = add_offset(LAT, LON, -5000.0, 400.0)
    estimate.origin_set, estimate.origin_lat, estimate.origin_lon = True, round(place.lat), round(place.lon)
    shapes.use_origin(fence, estimate)
    for k, (north, _) in enumerate(SQUARE):
        place = add_offset(estimate.origin_lat, estimate.origin_lon, *shapes.corner_of(fence, 0, k))
        want = add_offset(LAT, LON, *SQUARE[k])
        assert (place.lat, place.lon) == pytest.approx((want.lat, want.lon), abs=2.0)
        assert shapes.corner_of(fence, 0, k).x == pytest.approx(north + 5000.0, abs=0.02)


@pytest.mark.parametrize(
    "listed, text",
    [
        (polygon(MavCmd.NAV_FENCE_POLYGON_VERTEX_INCLUSION, *SQUARE[:2]), "Invalid vertex count (2)"),
        ([at(MavCmd.NAV_FENCE_POLYGON_VERTEX_INCLUSION, 0, 0.0, 0.0)], "Invalid vertex count (0)"),
        (polygon(MavCmd.NAV_FENCE_POLYGON_VERTEX_INCLUSION, *SQUARE)[:3], "Incorrect item count"),
        (
            polygon(MavCmd.NAV_FENCE_POLYGON_VERTEX_INCLUSION, *SQUARE)[:2]
            + polygon(MavCmd.NAV_FENCE_POLYGON_VERTEX_EXCLUSION, *SQUARE)[:2],
            "Received incorrect vertex type (want=98 got=97)",
        ),
        ([at(MavCmd.NAV_FENCE_CIRCLE_INCLUSION, 0.0, 0.0, 0.0)], "Non-positive circle radius"),
        ([at(MavCmd.NAV_FENCE_CIRCLE_INCLUSION, math.nan, 0.0, 0.0)], "Non-positive circle radius"),
        (2 * [at(MavCmd.NAV_FENCE_RETURN_POINT, 0.0, 0.0, 0.0)], "Multiple return points"),
    ],
)
def test_items_that_make_no_fence_are_named(listed: list[MissionItem], text: str) -> None:
    with pytest.raises(items.FenceError) as error:
        list(items.shapes(listed))
    assert str(error.value) == text


def test_a_fence_that_has_no_room_leaves_the_one_of_before() -> None:
    fence = placed(*polygon(MavCmd.NAV_FENCE_POLYGON_VERTEX_INCLUSION, *SQUARE))
    circles = (SHAPES + 1) * [at(MavCmd.NAV_FENCE_CIRCLE_INCLUSION, 5.0, 0.0, 0.0)]
    corners = polygon(MavCmd.NAV_FENCE_POLYGON_VERTEX_INCLUSION, *((CORNERS + 1) * [(0.0, 0.0)]))
    for listed in (circles, corners):
        with pytest.raises(items.FenceError):
            items.load(fence, list(items.shapes(listed)))
        assert fence.shapes == 1 and fence.is_placed
    items.load(fence, [])
    assert fence.shapes == 0
