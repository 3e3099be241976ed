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
        (4, 0, 4, 1.0, "Invalid FENCE_TOTAL, must be at least 5"),
        (5, 5, 5, 1.0, "Invalid fence point, index past total (5 >= 5)"),
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


def test_old_messages_are_named_once_each(bench: Bench) -> None:
    bench.vehicle.parameters.update({"FENCE_TOTAL": 5.0, "RALLY_TOTAL": 1.0})
    messages = {
        "FENCE_POINT": mavlink.MAVLink_fence_point_message(1, 1, 0, 5, 1.0, 2.0),
        "FENCE_FETCH_POINT": mavlink.MAVLink_fence_fetch_point_message(1, 1, 0),
        "RALLY_POINT": mavlink.MAVLink_rally_point_message(1, 1, 0, 1, 10, 20, 30, 0, 0, 0),
        "RALLY_FETCH_POINT": mavlink.MAVLink_rally_fetch_point_message(1, 1, 0),
    }
    for name, sent in messages.items():
        for first in (True, False):
            said = [(m.severity, m.text) for m in bench.ask(sent, "STATUSTEXT")]
            assert ((6, f"Received message ({name}) is deprecated") in said) == first
            assert len(said) == first, said


def test_a_corner_at_the_ends_of_the_earth(bench: Bench) -> None:
    bench.vehicle.parameters["FENCE_TOTAL"] = 5
    for lat, lon, taken in ((90.0, 180.0, True), (-90.0, -180.0, True), (1.0, 180.1, False), (1.0, -180.1, False)):
        said = [m.text for m in put(bench, 1, 5, lat, lon)]
        assert ("Invalid fence point, bad lat or lng" in said) == (not taken)


def test_answers_are_for_who_asks_and_a_fence_is_there_before_all_corners_are(bench: Bench) -> None:
    bench.vehicle.parameters["FENCE_TOTAL"] = 5
    put(bench, 2, 5, 1.5, 2.5)
    point = fetch(bench, 2)
    assert (point.lat, point.lng) == (pytest.approx(1.5, abs=1e-6), pytest.approx(2.5, abs=1e-6))
    assert (point.target_system, point.target_component) == (255, 190)
    assert [(fetch(bench, k).lat, fetch(bench, k).lng) for k in (1, 3, 4)] == [(0.0, 0.0)] * 3
