# SPDX-License-Identifier: BSD-3-Clause
"""Who is asked for heights of the ground, for what, and how often."""

from __future__ import annotations

from typing import Any

import pytest

from sitl.autopilot.mission.item import MissionItem, home_item
from sitl.autopilot.terrain.grid import PARTS, Block, around, block_of
from sitl.bridge.dialect import message
from sitl.bridge.services.terrain_protocol import TerrainService
from sitl.core.mavlink import MavCmd
from tests.bridge.fakes import HOME, Bench, FakeRover, mavlink

REPORT, INTERVAL = message("TERRAIN_REPORT").id, 511
ALL = (1 << PARTS) - 1


class Ground(Bench):
    """A vehicle that knows where it is, and asks."""

    def __init__(self) -> None:
        super().__init__()
        self.vehicle.locate()
        self.command(INTERVAL, REPORT, 1e6)
        self.terrain = self.vehicle.v.autopilot.terrain

    def requests(self, seconds: float) -> list[Any]:
        """What the first client is asked for meanwhile."""
        self.run(seconds)
        return list(self.client.receive("TERRAIN_REQUEST"))

    def answer(self, request: Any, height: int = 600, parts: int = ALL) -> None:
        """Tell the parts of a block."""
        for bit in range(PARTS):
            if (parts & request.mask) >> bit & 1:
                place = request.lat, request.lon, request.grid_spacing
                self.client.send(mavlink.MAVLink_terrain_data_message(*place, bit, [height] * 16))
        self.bridge.receive()


def test_a_block_is_asked_for_every_two_seconds_in_turn() -> None:
    bench = Ground()
    found = bench.requests(18.0)
    assert [(m.lat, m.lon) for m in found] == list(around(HOME[0], HOME[1], 100.0))
    assert {(m.grid_spacing, m.mask) for m in found} == {(100, ALL)}
    again = bench.requests(4.0)
    assert [(m.lat, m.lon) for m in again] == [(m.lat, m.lon) for m in found[:2]]
    assert bench.terrain.pending == 9 * PARTS


def test_what_is_known_is_not_asked_for_again() -> None:
    bench = Ground()
    first = bench.requests(2.0)[0]
    bench.answer(first, parts=0b1111)
    assert (bench.terrain.loaded, bench.terrain.pending) == (4, 9 * PARTS - 4)
    (again,) = [m for m in bench.requests(18.0) if (m.lat, m.lon) == (first.lat, first.lon)]
    assert again.mask == ALL & ~0b1111
    bench.answer(again)
    assert (first.lat, first.lon) not in [(m.lat, m.lon) for m in bench.requests(20.0)]
    assert bench.terrain.is_known and bench.terrain.was_known
    assert bench.terrain.home == 600.0


def test_only_who_gets_reports_is_asked() -> None:
    bench = Bench()
    bench.vehicle.locate()
    other = bench.connect()
    bench.run(6.0)
    assert not bench.client.receive("TERRAIN_REQUEST") and not bench.vehicle.v.autopilot.terrain.asked
    bench.command(INTERVAL, REPORT, 1e6)
    bench.run(6.0)
    assert len(bench.client.receive("TERRAIN_REQUEST")) == 3
    assert not other.receive("TERRAIN_REQUEST")
    bench.command(INTERVAL, REPORT, -1)
    bench.run(6.0)
    assert not bench.client.receive("TERRAIN_REQUEST") and not bench.vehicle.v.autopilot.terrain.asked


def test_parameters_say_whether_and_how_densely() -> None:
    bench = Ground()
    bench.answer(bench.requests(2.0)[0])
    for name in ("TERRAIN_ENABLE", "TERRAIN_OPTIONS"):
        before = bench.vehicle.parameters[name]
        bench.client.send(mavlink.MAVLink_param_set_message(1, 1, name.encode(), 1.0 - before, 9))
        assert not bench.requests(6.0) and not bench.terrain.asked
        bench.client.send(mavlink.MAVLink_param_set_message(1, 1, name.encode(), before, 9))
        assert bench.requests(2.0)
    assert bench.terrain.loaded == PARTS
    bench.client.send(mavlink.MAVLink_param_set_message(1, 1, b"TERRAIN_SPACING", 30.0, 9))
    request = bench.requests(2.0)[-1]
    assert (request.lat, request.lon, request.grid_spacing) == (*block_of(HOME[0], HOME[1], 30.0), 30)
    assert bench.terrain.loaded == 0 and not bench.terrain.is_known
    for spacing in (0.0, -5.0, 1e9):
        bench.client.send(mavlink.MAVLink_param_set_message(1, 1, b"TERRAIN_SPACING", spacing, 9))
        assert bench.requests(2.0)[-1].grid_spacing == min(max(spacing, 1.0), 10000.0)


def test_the_way_of_the_mission_is_asked_for() -> None:
    bench = Ground()
    far = HOME[0] + 900_000, HOME[1]  # 10 km
    bench.autopilot.items = (
        home_item(HOME[0], HOME[1], 0.0),
        MissionItem(MavCmd.NAV_WAYPOINT, x=HOME[0], y=HOME[1], z=10.0),
        MissionItem(MavCmd.NAV_WAYPOINT, x=far[0], y=far[1], z=10.0),
    )
    blocks = {(m.lat, m.lon) for m in bench.requests(40.0)}
    assert {block_of(HOME[0] + k * 100_000, HOME[1], 100.0) for k in range(10)} <= blocks


def test_a_snapshot_goes_on_with_the_same_requests() -> None:
    bench = Ground()
    bench.answer(bench.requests(2.0)[0])
    bench.requests(4.0)
    service: TerrainService = bench.bridge.get(TerrainService)
    state, record, time_us = service.snapshot(), bytes(bench.vehicle.v._bytes), bench.vehicle.time_us
    first = [(m.lat, m.lon, m.mask) for m in bench.requests(10.0)]
    bench.vehicle.v._bytes[:] = record
    assert bench.vehicle.time_us == time_us
    service.restore(state)
    assert [(m.lat, m.lon, m.mask) for m in bench.requests(10.0)] == first


def test_a_check_is_answered_though_nobody_is_asked() -> None:
    bench = Bench()
    for place in (HOME[:2], (0, 0), (1_000_000_000, 0), (-900_000_000, 1_800_000_000), (900_000_000, -1_800_000_000)):
        (answer,) = bench.ask(mavlink.MAVLink_terrain_check_message(*place), "TERRAIN_REPORT")
        assert (answer.lat, answer.lon, answer.spacing, answer.terrain_height) == (*place, 0, 0.0)


def test_a_rover_asks_nobody() -> None:
    bench = Bench(FakeRover())
    bench.vehicle.locate()
    bench.command(INTERVAL, REPORT, 1e6)
    bench.client.send(mavlink.MAVLink_terrain_check_message(*HOME[:2]))
    bench.run(6.0)
    assert not bench.client.receive("TERRAIN_REQUEST", "TERRAIN_REPORT")


def test_a_home_above_the_ground_needs_the_ground_there() -> None:
    bench = Ground()

    def set_home() -> int:
        place = (HOME[0] + 300_000, HOME[1], 5.0)
        bench.client.receive()
        bench.client.send(mavlink.MAVLink_command_int_message(1, 1, 10, 179, 0, 0, 0, 0, 0, 0, *place))
        bench.bridge.receive()
        return int(bench.client.receive("COMMAND_ACK")[-1].result)

    bench.run(2.0)
    assert set_home() == 4, "nothing is known of it"
    here = block_of(HOME[0], HOME[1], 100.0)
    for m in bench.requests(18.0):
        bench.answer(m, height=600 if (m.lat, m.lon) == (here.lat, here.lon) else 650)
    bench.run(1.0)
    assert set_home() == 0
    lat, lon, alt = next(call for call in bench.autopilot.calls if call[0] == "set_home")[1:]
    ground = bench.bridge.get(TerrainService).rise(lat, lon)
    assert ground == 50.0
    assert alt == bench.bridge.locations.home_alt() + ground + 5.0


FAR = HOME[0] + 900_000, HOME[1] + 500_000


@pytest.mark.parametrize(
    ("item", "is_asked_for"),
    [
        (MissionItem(MavCmd.NAV_WAYPOINT, x=FAR[0], y=FAR[1], z=10.0), True),
        (MissionItem(MavCmd.NAV_LAND, x=FAR[0], y=FAR[1]), True),
        (MissionItem(MavCmd.DO_SET_ROI_LOCATION, x=FAR[0], y=FAR[1]), True),
        (MissionItem(MavCmd.NAV_LAND), False),
        (MissionItem(MavCmd.DO_DIGICAM_CONTROL, x=FAR[0], y=FAR[1]), False),
        (MissionItem(MavCmd.DO_CHANGE_SPEED, x=FAR[0], y=FAR[1]), False),
    ],
)
def test_the_ground_at_a_single_item_is_asked_for(item: MissionItem, is_asked_for: bool) -> None:
    bench = Ground()
    bench.autopilot.items = (home_item(HOME[0], HOME[1], 0.0), item)
    asked = {(m.lat, m.lon) for m in bench.requests(24.0)}
    there = block_of(item.x, item.y, 100.0)
    assert there not in around(HOME[0], HOME[1], 100.0)
    assert (there in asked) == is_asked_for
    assert len(asked) == 9 + is_asked_for


def test_neither_home_nor_the_way_from_it_is_of_the_mission() -> None:
    bench = Ground()
    bench.vehicle.v.autopilot.home.is_set = 0
    bench.autopilot.items = (
        home_item(FAR[0], FAR[1], 0.0),
        MissionItem(MavCmd.NAV_WAYPOINT, x=HOME[0], y=HOME[1], z=10.0),
    )
    assert {(m.lat, m.lon) for m in bench.requests(24.0)} == set(around(HOME[0], HOME[1], 100.0))


# ---------------------------------------------------------------- a source of the simulator's own


def test_what_the_simulator_knows_is_not_asked_for() -> None:
    bench = Ground()
    service: TerrainService = bench.bridge.get(TerrainService)
    asked: list[tuple[float, float]] = []

    def height(lat: float, lon: float) -> float:
        asked.append((lat, lon))
        return 612.0 if lat < 1e-7 * HOME[0] + 0.5 else 700.0

    service.use(height)
    assert not bench.requests(6.0)
    assert bench.terrain.loaded == 9 * PARTS and bench.terrain.pending == 0
    assert bench.terrain.is_known and bench.terrain.home == 612.0 and service.height(*HOME[:2]) == 612.0
    count = len(asked)
    bench.run(10.0)
    assert len(asked) == count, "what is known is not looked up again"
    assert all(abs(lat - 1e-7 * HOME[0]) < 0.1 and abs(lon - 1e-7 * HOME[1]) < 0.1 for lat, lon in asked)


def test_what_the_simulator_does_not_know_is_asked_for_of_clients() -> None:
    bench = Ground()
    service: TerrainService = bench.bridge.get(TerrainService)
    tries: list[float] = []

    def height(lat: float, lon: float) -> float | None:
        tries.append(lat)
        return 612.0 if lat <= 1e-7 * HOME[0] else None

    service.use(height)
    found = bench.requests(20.0)
    assert found and all(m.lat + 300_000 > HOME[0] for m in found), "blocks are 2.8 km, and end north of home"
    assert service.height(HOME[0] - 60_000, HOME[1]) == 612.0 and service.height(HOME[0] + 30_000, HOME[1]) is None
    assert bench.terrain.pending > 0
    count = len(tries)
    bench.run(20.0)
    assert len(tries) == count, "it knows no more later"


def test_where_nobody_else_is_there_nothing_is_pending_but_what_was_not_tried() -> None:
    bench = Bench()
    bench.vehicle.locate()
    terrain, service = bench.vehicle.v.autopilot.terrain, bench.bridge.get(TerrainService)
    service.use(lambda lat, lon: None)
    assert terrain.asked and terrain.pending == 9 * PARTS
    bench.run(2.0)
    assert terrain.asked and (terrain.pending, terrain.loaded) == (0, 0) and not terrain.is_known
    bench.vehicle.parameters["TERRAIN_ENABLE"] = 0.0
    service.look()
    assert not terrain.asked and terrain.pending == 0


def test_without_a_location_a_part_is_pending() -> None:
    bench = Bench()
    bench.bridge.get(TerrainService).use(lambda lat, lon: 1.0)
    assert (bench.vehicle.v.autopilot.terrain.pending, bench.vehicle.v.autopilot.terrain.loaded) == (PARTS, 0)


def test_the_oldest_blocks_are_forgotten() -> None:
    bench = Ground()
    service: TerrainService = bench.bridge.get(TerrainService)
    whole = [(1,) * 16] * PARTS
    for k in range(258):
        service._keep(Block(k, 0), whole)
    assert list(service._blocks) == [Block(k, 0) for k in range(2, 258)]
    service._keep(Block(2, 0), whole)
    assert list(service._blocks)[-1] == Block(2, 0) and len(service._blocks) == 256, "what is told again is new"


# ---------------------------------------------------------------- what is heard, known and told


def check(bench: Bench, lat: int, lon: int) -> Any:
    (answer,) = bench.ask(mavlink.MAVLink_terrain_check_message(lat, lon), "TERRAIN_REPORT")
    return answer


def test_the_last_eight_places_that_were_checked_are_asked_for() -> None:
    bench = Ground()
    places = [(HOME[0] + 1_000_000 * k, HOME[1]) for k in range(1, 11)]
    for place in (*places[:3], *places):
        check(bench, *place)
    asked = {(m.lat, m.lon) for m in bench.requests(2.0 * 17)}
    assert asked == {*around(HOME[0], HOME[1], 100.0), *(block_of(*place, 100.0) for place in places[2:])}


def test_a_check_tells_heights_and_counts() -> None:
    bench = Ground()
    t, ap = bench.terrain, bench.vehicle.v.autopilot
    for m in bench.requests(18.0):
        bench.answer(m, height=650)
    t.offset, t.difference = 2.0, 4.0
    ap.home.pos, ap.estimate.pos = (0.0, 0.0, -1.0), (0.0, 0.0, -31.0)
    answer = check(bench, *HOME[:2])
    assert (answer.spacing, answer.terrain_height, answer.current_height) == (100, 652.0, 26.0)
    assert (answer.pending, answer.loaded) == (0, 9 * PARTS)
    t.pending = t.loaded = 70_000
    answer = check(bench, 900_000_001, 0)
    assert (answer.spacing, answer.pending, answer.loaded) == (0, 65_535, 65_535)


@pytest.mark.parametrize(
    ("change", "taken"),
    [
        ({}, True), ({"grid_spacing": 99}, False), ({"gridbit": 55}, True), ({"gridbit": 56}, False),
        ({"lat": 40}, True), ({"lat": 60}, False), ({"lon": -45}, True), ({"lon": -70}, False),
    ],
)  # fmt: skip
def test_parts_that_are_taken(change: dict[str, int], taken: bool) -> None:
    """Of what was asked for, to TERRAIN_MARGIN: 0.5 m."""
    bench = Ground()
    bench.vehicle.parameters["TERRAIN_MARGIN"] = 0.5
    (m,) = bench.requests(2.0)
    place = m.lat + change.get("lat", 0), m.lon + change.get("lon", 0), change.get("grid_spacing", 100)
    for _ in range(2):
        bench.client.send(mavlink.MAVLink_terrain_data_message(*place, change.get("gridbit", 3), [600] * 16))
        bench.bridge.receive()
        assert (bench.terrain.loaded, bench.terrain.pending) == (taken, 9 * PARTS - taken)


def test_answers_are_left_out_while_nobody_is_asked() -> None:
    bench = Ground()
    (m,) = bench.requests(2.0)
    bench.command(INTERVAL, REPORT, -1)
    bench.answer(m)
    assert bench.terrain.loaded == 0


@pytest.mark.parametrize(
    ("asked", "was_known", "enabled", "rise"),
    [
        (False, False, 1.0, 0.0), (False, False, 0.0, None), (True, False, 1.0, None), (True, True, 1.0, 50.0),
        (False, True, 1.0, 50.0), (True, True, 0.0, None),
    ],
)  # fmt: skip
def test_how_much_higher_the_ground_is_than_at_home(asked: bool, was_known: bool, enabled: float, rise: Any) -> None:
    bench = Ground()
    service: TerrainService = bench.bridge.get(TerrainService)
    service._blocks = dict.fromkeys(around(HOME[0], HOME[1], 100.0), ((650,) * 16,) * PARTS)
    bench.terrain.asked, bench.terrain.was_known, bench.terrain.home = asked, was_known, 600.0
    bench.vehicle.v.autopilot.params.TERRAIN.ENABLE = enabled
    assert service.rise(*HOME[:2]) == rise


@pytest.mark.parametrize(("alt", "was_known", "offset"), [(603.0, True, 3.0), (650.0, True, 15.0), (500.0, True, -15.0),
                                                         (603.0, False, 0.0)])  # fmt: skip
def test_home_is_as_high_as_the_ground_from_arming_on(alt: float, was_known: bool, offset: float) -> None:
    """By TERRAIN_OFS_MAX, 15 m."""
    bench = Ground()
    bench.vehicle.parameters["TERRAIN_OFS_MAX"] = 15.0
    bench.terrain.home, bench.terrain.was_known, bench.terrain.offset = 600.0, was_known, 0.0
    bench.vehicle.v.autopilot.home.alt = alt
    bench.bridge.get(TerrainService).armed()
    assert bench.terrain.offset == offset


@pytest.mark.parametrize(
    ("north_m", "plain", "truth", "wanted", "shapes"),
    [
        (99.0, True, True, 1.0, True), (-99.0, True, True, 1.0, True), (101.0, True, True, 1.0, False),
        (0.0, False, True, 1.0, False), (0.0, True, False, 1.0, False), (0.0, True, True, 0.0, False),
    ],
)  # fmt: skip
def test_the_simulated_ground_follows_the_heights_where_it_is_a_plain(
    north_m: float, plain: bool, truth: bool, wanted: float, shapes: bool
) -> None:
    """And where the estimate begins near to where the vehicle was switched on."""
    bench = Ground()
    origin = bench.vehicle.v.physics.origin
    origin.lat, origin.lon = HOME[0] + round(north_m / 0.0111319), HOME[1]
    bench.vehicle.has_plain_ground, bench.vehicle.has_truth_in_record = plain, truth
    bench.vehicle.parameters["SIM_TERRAIN"] = wanted
    assert not bench.terrain.shapes
    for m in bench.requests(18.0):
        bench.answer(m, height=650)
    assert bool(bench.terrain.shapes) == shapes
    if shapes:
        assert bench.terrain.start == 650.0


def test_heights_outlive_a_reboot() -> None:
    bench = Ground()
    bench.answer(bench.requests(2.0)[0], height=650)
    bench.bridge = bench.bridge.successor()
    assert bench.bridge.get(TerrainService).height(*HOME[:2]) == 650.0
    assert bench.bridge.get(TerrainService).height(900_000_001, 0) is None
