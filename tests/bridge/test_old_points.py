# SPDX-License-Identifier: BSD-3-Clause
"""FENCE_POINT and RALLY_POINT: points one by one, beside the lists of the mission protocol."""

from __future__ import annotations

from typing import Any

import pytest
from pymavlink.dialects.v20 import ardupilotmega as mavlink

from sitl.autopilot.mission.item import MissionItem
from sitl.bridge.services.mission_protocol import MissionService
from sitl.core.mavlink import MavCmd
from tests.bridge.fakes import Bench

PLACES = ((1.0, 2.0), (1.1, 2.0), (1.1, 2.2), (1.0, 2.2))


def put(bench: Bench, k: int, count: int, lat: float, lng: float) -> list[Any]:
    return bench.ask(mavlink.MAVLink_fence_point_message(1, 1, k, count, lat, lng), "STATUSTEXT")


def fetch(bench: Bench, k: int) -> Any:
    (point,) = bench.ask(mavlink.MAVLink_fence_fetch_point_message(1, 1, k), "FENCE_POINT")
    assert point.idx == k
    return point


def fence(bench: Bench) -> tuple[MissionItem, ...]:
    return bench.bridge.get(MissionService).lists[0]


@pytest.mark.parametrize("order", [(0, 1, 2, 3, 4, 5), (1, 2, 3, 0, 4, 5), (4, 3, 2, 1, 0, 5), (0, 1, 2, 5, 3, 4)])
def test_points_may_come_in_any_order(bench: Bench, order: tuple[int, ...]) -> None:
    points = ((1.05, 2.1), *PLACES, PLACES[0])
    bench.vehicle.parameters["FENCE_TOTAL"] = 6
    for k in order:
        put(bench, k, 6, *points[k])
        got = fetch(bench, k)
        assert (got.lat, got.lng, got.count) == (*(pytest.approx(x, abs=1e-6) for x in points[k]), 6)
    assert [item.command for item in fence(bench)] == [MavCmd.NAV_FENCE_RETURN_POINT] + 4 * [
        MavCmd.NAV_FENCE_POLYGON_VERTEX_INCLUSION
    ]
    assert [(item.x, item.y) for item in fence(bench)][1:] == [
        (pytest.approx(lat * 1e7, abs=2), pytest.approx(lon * 1e7, abs=2)) for lat, lon in PLACES
    ]
    assert bench.vehicle.v.autopilot.fence.shapes == 1


def test_another_count_begins_another_area(bench: Bench) -> None:
    for total in (6, 5):
        bench.vehicle.parameters["FENCE_TOTAL"] = total
        for k in range(1, total - 1):
            put(bench, k, total, *PLACES[k - 1])
        assert len(fence(bench)) == total - 2


def test_without_a_point_of_return_the_middle_is_told(bench: Bench) -> None:
    bench.vehicle.parameters["FENCE_TOTAL"] = 6
    point = fetch(bench, 0)
    assert (point.lat, point.lng) == (0.0, 0.0)
    for k in range(4):
        put(bench, k + 1, 6, *PLACES[k])
    point = fetch(bench, 0)
    assert (point.lat, point.lng) == (pytest.approx(1.05, abs=1e-6), pytest.approx(2.1, abs=1e-6))


@pytest.mark.parametrize(
    ("total", "k", "count", "lat", "text"),
    [
        (0, 0, 0, 1.0, "Invalid fence point, index past total (0 >= 0)"),
        (0, 0, 1, 1.0, "Invalid fence point, bad count (1 vs 0)"),
        (1, 0, 1, 1.0, "Invalid FENCE_TOTAL, must be at least 5"),
        (5, 0, 5, 91.0, "Invalid fence point, bad lat or lng"),
        (5, 0, 5, float("nan"), "Invalid fence point, bad lat or lng"),
    ],
)
def test_what_is_refused(bench: Bench, total: int, k: int, count: int, lat: float, text: str) -> None:
    bench.vehicle.parameters["FENCE_TOTAL"] = total
    assert text in [m.text for m in put(bench, k, count, lat, 2.0)]
    assert fence(bench) == ()
    (said,) = bench.ask(mavlink.MAVLink_fence_fetch_point_message(1, 1, 7), "STATUSTEXT")[-1:]
    assert said.text == f"Invalid fence point, index past total(7 >= {total})"


def test_rally_points_one_by_one(bench: Bench) -> None:
    bench.vehicle.parameters["RALLY_TOTAL"] = 2
    bench.ask(mavlink.MAVLink_rally_point_message(1, 1, 1, 2, 10, 20, 30, 0, 0, 0))
    (point,) = bench.ask(mavlink.MAVLink_rally_fetch_point_message(1, 1, 1), "RALLY_POINT")
    assert (point.idx, point.count, point.lat, point.lng, point.alt) == (1, 2, 10, 20, 30)
    (n,) = bench.ask(mavlink.MAVLink_mission_request_list_message(1, 1, 2))
    assert n.count == 2
    bench.vehicle.parameters["RALLY_TOTAL"] = 1
    (n,) = bench.ask(mavlink.MAVLink_mission_request_list_message(1, 1, 2))
    assert n.count == 1
    for k, count, text in ((1, 1, "Bad rally point ID"), (0, 2, "Bad rally point count")):
        said = bench.ask(mavlink.MAVLink_rally_point_message(1, 1, k, count, 10, 20, 30, 0, 0, 0), "STATUSTEXT")
        assert said[-1].text == text
    said = bench.ask(mavlink.MAVLink_rally_fetch_point_message(1, 1, 1), "STATUSTEXT")
    assert said[-1].text == "Bad rally point ID"
