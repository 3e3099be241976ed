# SPDX-License-Identifier: BSD-3-Clause
"""How much higher the ground is than at home, by what is known of it; who gives an answer that was not asked for."""

from __future__ import annotations

from typing import Any

import pytest

from sitl.autopilot.terrain.grid import PARTS, block_of
from sitl.bridge.services.terrain_protocol import TerrainService
from tests.bridge.fakes import HOME, Bench, mavlink
from tests.bridge.test_terrain import Ground

FAR = (HOME[0] + 300_000, HOME[1])


def service(bench: Bench) -> TerrainService:
    return bench.bridge.get(TerrainService)


def learn(bench: Ground, seconds: float = 18.0, height: int = 600) -> None:
    """Answer all that is asked for."""
    for m in bench.requests(seconds):
        bench.answer(m, height)


def test_where_nobody_knows_the_ground_it_is_a_plain() -> None:
    bench = Bench()
    bench.vehicle.locate()
    assert service(bench).rise(*HOME[:2]) == 0.0 == service(bench).rise(*FAR)
    assert service(bench).height(*HOME[:2]) is None


def test_what_is_asked_for_and_not_known_is_no_plain() -> None:
    bench = Ground()
    bench.run(2.0)
    assert service(bench).rise(*HOME[:2]) is None is service(bench).rise(*FAR)


def test_rises_are_from_the_ground_at_home() -> None:
    bench = Ground()
    here = block_of(HOME[0], HOME[1], 100.0)
    for m in bench.requests(18.0):
        bench.answer(m, height=600 if (m.lat, m.lon) == (here.lat, here.lon) else 650)
    bench.run(1.0)
    assert service(bench).height(*HOME[:2]) == 600.0 and service(bench).rise(*HOME[:2]) == 0.0
    assert service(bench).rise(*FAR) == 50.0
    assert service(bench).rise(HOME[0] + 20_000_000, HOME[1]) is None, "too far to be known"
    for nowhere in ((900_000_001, 0), (0, 1_800_000_001), (-900_000_001, 0)):
        assert service(bench).height(*nowhere) is None
    bench.vehicle.v.autopilot.terrain.was_known = False
    assert service(bench).rise(*FAR) is None, "home's own ground is not known"


@pytest.mark.parametrize(("most", "offset"), [(15.0, 15.0), (100.0, 64.0), (-15.0, 15.0), (0.0, 0.0)])
def test_a_check_tells_the_ground_there_and_how_high_the_vehicle_is_above_the_ground_below(
    most: float, offset: float
) -> None:
    """From arming on all ground is higher by what home is higher than the ground there, up to TERRAIN_OFS_MAX."""
    bench = Ground()
    learn(bench, height=520)
    bench.vehicle.parameters["TERRAIN_OFS_MAX"] = most
    service(bench).armed()
    bench.vehicle.v.autopilot.estimate.pos = (0.0, 0.0, -30.0)
    (answer,) = bench.ask(mavlink.MAVLink_terrain_check_message(*FAR), "TERRAIN_REPORT")
    assert HOME[2] == 584.0
    assert (answer.lat, answer.lon, answer.spacing, answer.terrain_height) == (*FAR, 100, 520.0 + offset)
    assert (answer.current_height, answer.pending, answer.loaded) == (30.0, 0, 9 * PARTS)


def test_switched_off_nothing_is_known() -> None:
    bench = Ground()
    learn(bench)
    bench.run(1.0)
    assert service(bench).rise(*HOME[:2]) == 0.0
    bench.vehicle.parameters["TERRAIN_ENABLE"] = 0.0
    assert service(bench).rise(*HOME[:2]) is None


def data(bench: Ground, m: Any, **changes: Any) -> int:
    """Parts that are known after a part of a block came."""
    fields = {"lat": m.lat, "lon": m.lon, "grid_spacing": m.grid_spacing, "gridbit": 3, "data": [600] * 16, **changes}
    bench.client.send(mavlink.MAVLink_terrain_data_message(**fields))
    bench.bridge.receive()
    return int(bench.terrain.loaded)


@pytest.mark.parametrize(
    ("changes", "taken"),
    [({}, True), ({"grid_spacing": 101}, False), ({"gridbit": PARTS - 1}, True), ({"gridbit": PARTS}, False)],
)
def test_only_parts_that_were_asked_for_are_taken(changes: Any, taken: bool) -> None:
    bench = Ground()
    (m,) = bench.requests(2.0)
    assert data(bench, m, **changes) == int(taken)


@pytest.mark.parametrize(("by", "taken"), [(0, True), (400, True), (-400, True), (5000, False), (-5000, False)])
def test_a_part_may_be_some_centimetres_aside(by: int, taken: bool) -> None:
    """Ground stations round latitudes: TERRAIN_MARGIN, 0.05 m, here 5 m."""
    bench = Ground()
    bench.vehicle.parameters["TERRAIN_MARGIN"] = 5.0
    (m,) = bench.requests(2.0)
    assert data(bench, m, lat=m.lat + by) == int(taken) == data(bench, m, lon=m.lon + by)
    assert data(bench, m, lat=900_000_001) == int(taken)


def test_a_part_that_comes_twice_counts_once() -> None:
    bench = Ground()
    (m,) = bench.requests(2.0)
    missing = int(bench.terrain.pending)
    assert data(bench, m) == data(bench, m) == 1 and bench.terrain.pending == missing - 1
    assert data(bench, m, gridbit=4) == 2


@pytest.mark.parametrize(
    ("most", "home_above", "offset"), [(30.0, 12.0, 12.0), (10.0, 12.0, 10.0), (-10.0, -12.0, -10.0)]
)
def test_arming_sets_home_on_the_ground(most: float, home_above: float, offset: float) -> None:
    """TERRAIN_OFS_MAX limits what is made good."""
    bench = Ground()
    bench.vehicle.parameters["TERRAIN_OFS_MAX"] = most
    t = bench.vehicle.v.autopilot.terrain
    t.was_known, t.home = True, HOME[2] - home_above
    service(bench).armed()
    assert t.offset == pytest.approx(offset)
    t.was_known, t.offset = False, 1.0
    service(bench).armed()
    assert t.offset == 1.0


def test_a_snapshot_keeps_what_was_known() -> None:
    bench = Ground()
    learn(bench)
    bench.run(1.0)
    state = service(bench).snapshot()
    bench.vehicle.parameters["TERRAIN_SPACING"] = 50.0
    service(bench).look()
    assert service(bench).height(*HOME[:2]) is None, "heights of another grid are of no use"
    bench.vehicle.parameters["TERRAIN_SPACING"] = 100.0
    service(bench).restore(state)
    assert service(bench).height(*HOME[:2]) == 600.0
    assert service(bench).snapshot() == state


def test_a_snapshot_of_before_knows_nothing() -> None:
    bench = Ground()
    state = service(bench).snapshot()
    learn(bench)
    bench.run(1.0)
    assert service(bench).height(*HOME[:2]) == 600.0
    service(bench).restore(state)
    assert service(bench).height(*HOME[:2]) is None
