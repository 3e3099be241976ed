# SPDX-License-Identifier: BSD-3-Clause
"""Flights over a ridge whose heights a client tells. Values in comments: the same flights of ArduCopter 4.7."""

from __future__ import annotations

import math
from pathlib import Path
from typing import Any

import pytest

from sitl import Simulation
from sitl.autopilot.mission.item import MissionItem
from sitl.bridge.services.terrain_protocol import TerrainService
from sitl.client import Client
from sitl.client.terrain import TerrainAnswers
from sitl.run.runner import open_dataflash
from sitl.simulation import Core
from tests.logs.dataflash.conftest import read_log

LAT, LON, ALT = -35.363262, 149.165237, 584.0
ABOVE_GROUND, ABOVE_GROUND_INT = 10, 11
"""MAV_FRAMEs."""
POSITION, POSITION_AND_VELOCITY = 0x0DF8, 0x0DC0
"""Type masks."""
MISSING = "Failsafe: Terrain data missing"


def ridge(lat: float, lon: float) -> float:
    """30 m high, 150 m north of home, from west to east."""
    north = (lat - LAT) * 111318.845
    return ALT + 0.01 * north + 30.0 * math.exp(-(((north - 150.0) / 40.0) ** 2))


class Flight:
    """A copter whose client knows the ridge, or nothing of it."""

    def __init__(self, core: Core, *, answers: bool = True, terrain: str | None = None, **params: float) -> None:
        home = (LAT, LON, ALT, 0.0)
        self.simulation = Simulation("ardupilot_quad", core=core, seed=1, home=home, params=params, terrain=terrain)
        self.client = Client(self.simulation)
        self.terrain = self.simulation.v.autopilot.terrain
        self.answers = TerrainAnswers(self.client, ridge).start() if answers else None
        self.client.wait_ready()
        if answers:
            self.client.wait(lambda t: self.terrain.pending == 0, 40.0, "all heights")

    @property
    def over_ground(self) -> float:
        """True height over the simulated ground [m]."""
        p = self.simulation.v.physics
        return float(p.downward.ground_d - p.body.pos.z)

    def item(self, north: float, east: float, altitude: float, frame: int = ABOVE_GROUND) -> MissionItem:
        return self.client.item("NAV_WAYPOINT", north, east, altitude=altitude)._replace(frame=frame)

    def begin(self, *items: MissionItem) -> None:
        """Fly a mission behind a take-off to 20 m."""
        c = self.client
        c.upload([c.item("NAV_WAYPOINT"), c.item("NAV_TAKEOFF", altitude=20), *items])
        c.params["AUTO_OPTIONS"] = 3
        c.set_mode("AUTO")
        c.arm()
        c.wait_current_waypoint(2)

    def target(self, north: float, altitude: float, mask: int = POSITION, **more: Any) -> None:
        """Set a target over the ground."""
        lat, lon = self.client.location_of(north, 0.0)
        frame = ABOVE_GROUND_INT
        self.client.send(
            "SET_POSITION_TARGET_GLOBAL_INT", coordinate_frame=frame, type_mask=mask, lat_int=lat, lon_int=lon,
            alt=altitude, **more,
        )  # fmt: skip

    def said(self, text: str) -> bool:
        return any(text in said.text for said in self.client.texts)

    def heights(self, done: Any, timeout: float) -> list[tuple[float, float]]:
        """(North, true height over the ground) [m], ten times a second until it is ``done``."""
        seen: list[tuple[float, float]] = []

        def look(t: Any) -> bool:
            seen.append((self.client.position.north, self.over_ground))
            return bool(done())

        self.client.wait(look, timeout, "the end")
        return seen


def test_a_mission_follows_the_ground(core: Core) -> None:
    """Over the ridge at 20 m: never lower than 16.9 m on the way up (17.2), nor higher than 22.4 m on the way down
    (22.3); without heights it would be 6 m over the top."""
    f = Flight(core)
    assert f.answers is not None
    assert f.answers.answers == f.terrain.loaded == 9 * 56
    assert f.terrain.home == pytest.approx(ALT, abs=0.5)
    f.begin(f.item(150, 0, 20), f.item(300, 0, 20), f.item(300, 40, 20, frame=3))
    seen = f.heights(lambda: f.client.reached[-1:] == [3], 60.0)
    assert 16.5 < min(height for _, height in seen) < 17.5
    assert 21.5 < max(height for _, height in seen) < 23.0
    assert max(north for north, _ in seen) > 297.0
    assert f.over_ground == pytest.approx(20.0, abs=0.2)
    assert f.client.altitude == pytest.approx(23.4, abs=0.3)  # 23.2
    f.client.wait_waypoint(4)
    assert f.client.altitude == pytest.approx(20.0, abs=0.2)  # above home again
    assert not f.said(MISSING)


def test_without_heights_the_mission_cannot_begin(core: Core) -> None:
    f = Flight(core, answers=False)
    c = f.client
    c.set_rate("TERRAIN_REPORT", 1)  # who gets this is asked
    c.delay(3.0)
    c.upload([c.item("NAV_WAYPOINT"), c.item("NAV_TAKEOFF", altitude=20), f.item(50, 0, 20)])
    assert c.request("COMPONENT_ARM_DISARM", 1) == 4
    assert f.said("Arm: waiting for terrain data")
    c.params["TERRAIN_ENABLE"] = 0
    assert c.request("COMPONENT_ARM_DISARM", 1) == 4
    assert f.said("Arm: terrain disabled")
    c.upload([c.item("NAV_WAYPOINT"), c.item("NAV_TAKEOFF", altitude=20), c.item("NAV_WAYPOINT", 50, 0, altitude=20)])
    c.params["RTL_ALT_TYPE"] = 1
    assert c.request("COMPONENT_ARM_DISARM", 1) == 4
    assert f.said("Arm: RTL_ALT_TYPE is above-terrain but no terrain data")
    c.params["RTL_ALT_TYPE"] = 0
    c.arm()


def test_missing_heights_in_flight_bring_the_vehicle_home(core: Core) -> None:
    """It stops at once, and after 5 s (5.25) it is a failsafe: RTL. Heights are kept while they are only not told."""
    f = Flight(core)
    f.begin(f.item(600, 0, 20))
    f.client.wait(lambda t: f.client.position.north > 60.0, 30.0, "the slope")
    with f.client.fork():  # another spacing: nothing of what is known is of use, but for the last height
        f.answers = None
        f.client.companions.clear()
        f.client.params["TERRAIN_SPACING"] = 50
        f.client.delay(15.0)
        assert f.client.mode == "AUTO"
        assert f.terrain.loaded == 0
        assert f.client.position.north > 200.0
        assert f.client.altitude == pytest.approx(20.0 + f.terrain.difference, abs=0.3)
        assert not f.said(MISSING)
    f.client.params["TERRAIN_ENABLE"] = 0
    since = f.client.now
    f.client.wait_mode("RTL", timeout=7.0)
    assert f.client.now - since == pytest.approx(5.1, abs=0.4)
    assert f.said(MISSING)
    assert f.client.groundspeed < 1.0
    assert f.client.position.north < 110.0
    f.client.wait(lambda t: math.hypot(*f.client.position[:2]) < 2.0, 60.0, "home")
    assert f.client.altitude > 20.0


def test_guided_targets_over_the_ground(core: Core) -> None:
    f = Flight(core)
    f.client.take_off(15.0)
    f.target(150.0, 20.0)
    seen = f.heights(lambda: f.client.position.north > 149.0 and f.client.groundspeed < 0.3, 40.0)
    assert 13.5 < min(height for _, height in seen) < 15.5
    f.client.delay(8.0)
    assert f.over_ground == pytest.approx(20.0, abs=0.2)
    assert f.client.altitude == pytest.approx(33.9, abs=0.3)
    f.target(150.0, 10.0, POSITION_AND_VELOCITY)  # cannot be flown
    f.client.delay(3.0)
    assert f.over_ground == pytest.approx(20.0, abs=0.2)
    f.target(250.0, 15.0)
    f.client.delay(16.0)
    assert f.over_ground == pytest.approx(15.0, abs=0.3)
    f.client.params["TERRAIN_ENABLE"] = 0
    f.client.wait_mode("RTL", timeout=2.0)  # at once
    assert f.said(MISSING)
    with f.client.fork():
        f.client.set_mode("GUIDED")
        f.client.delay(3.0)
        before = f.client.position
        f.target(0.0, 40.0)
        f.client.delay(3.0)
        assert f.client.position == pytest.approx(before, abs=0.3)  # nothing is known: nothing follows


@pytest.mark.parametrize("cut", [False, True])
def test_rtl_over_the_ground(core: Core, cut: bool) -> None:
    """From 36 m over the ground it goes home as high over the ridge (34.9 .. 40.7 m); when heights are missing, at the
    height that it has then, begun anew after 5 s (5.3)."""
    f = Flight(core, RTL_ALT_TYPE=1, RTL_ALT=2500)
    f.client.take_off(40.0)
    f.client.goto(250, 0, 40)
    f.client.set_mode("RTL")
    begin = f.over_ground
    if not cut:
        seen = f.heights(lambda: f.client.position.north < 1.0 and f.client.groundspeed < 0.3, 60.0)
        heights = [height for _, height in seen]
        assert min(heights) > begin - 3.0
        assert max(heights) < begin + 6.0
        assert f.over_ground == pytest.approx(begin, abs=0.3)
        return
    f.client.wait(lambda t: f.client.position.north < 170.0, 20.0, "the slope")
    f.client.params["TERRAIN_ENABLE"] = 0
    since = f.client.now
    f.client.wait_statustext("Restarting RTL - Terrain data missing", timeout=8.0)
    assert f.client.now - since == pytest.approx(5.1, abs=0.4)
    assert f.client.mode == "RTL"
    height = f.client.altitude
    f.client.wait(lambda t: math.hypot(*f.client.position[:2]) < 1.0, 60.0, "home")
    assert f.client.altitude == pytest.approx(height, abs=0.5)


def test_rtl_without_heights_says_so(core: Core) -> None:
    f = Flight(core, answers=False, TERRAIN_ENABLE=0)
    f.client.take_off(10.0)
    f.client.goto(20, 0, 10)
    f.client.params["RTL_ALT_TYPE"] = 1
    f.client.set_mode("RTL")
    f.client.wait_statustext("RTL: no terrain data, using alt-above-home", timeout=1.0)
    f.client.wait_altitude(14.5, 15.5, timeout=20.0)  # RTL_ALT
    assert f.client.mode == "RTL" and f.client.position.north > 5.0, "it climbs before it returns"


def test_it_lands_on_the_ground_that_was_told(core: Core) -> None:
    """Arming there moves home to that height."""
    f = Flight(core)
    f.client.take_off(30.0)
    f.client.goto(150, 0, 60)
    f.client.set_mode("LAND")
    f.client.wait_altitude(20.0, 22.0, timeout=60.0)
    assert f.client.climb_rate > -0.7  # slowly from LAND_ALT_LOW over the ground on
    f.client.wait_disarmed(timeout=60.0)
    assert f.client.altitude == pytest.approx(13.8, abs=0.5)
    assert f.over_ground == pytest.approx(0.0, abs=1e-6)
    f.client.set_mode("GUIDED")
    f.client.arm()
    assert f.client.home()[2] == pytest.approx(ALT + 13.8, abs=0.7)


def test_sim_terrain_0_leaves_the_ground_flat(core: Core) -> None:
    f = Flight(core, SIM_TERRAIN=0)
    f.client.take_off(30.0)
    f.client.goto(150, 0, 60)
    assert f.terrain.is_known
    f.client.land()
    assert f.client.altitude == pytest.approx(0.0, abs=0.3)


def test_a_range_finder_tells_the_ground(core: Core) -> None:
    """WPNAV_RFND_USE: it comes before the grid; where it sees nothing the height is missing."""
    f = Flight(core, RNGFND1_TYPE=100, RNGFND1_MAX=40)
    f.begin(f.item(150, 0, 20), f.item(300, 0, 60))
    f.client.params["TERRAIN_ENABLE"] = 0
    f.client.wait_waypoint(2)
    f.client.delay(1.0)
    f.client.wait_mode("RTL", timeout=60.0)  # higher than it sees
    assert f.said(MISSING)


def test_without_anybody_to_ask_the_ground_is_flat(core: Core) -> None:
    f = Flight(core, answers=False)
    f.begin(f.item(60, 0, 15))
    f.client.wait_waypoint(2)
    assert f.client.altitude == pytest.approx(15.0, abs=0.3)
    assert not f.terrain.asked


def test_bad_answers_change_nothing(core: Core) -> None:
    f = Flight(core)
    f.client.delay(2.0)
    blocks, loaded = f.simulation.bridge.get(TerrainService).snapshot()[0], f.terrain.loaded
    good = {"lat": -353747689, "lon": 1491548424, "grid_spacing": 100, "gridbit": 0, "data": (9,) * 16}
    for bad in (
        {"lat": 1_000_000_000}, {"lat": -2_147_483_648, "lon": 2_147_483_647}, {"lon": 1_491_000_000},
        {"grid_spacing": 0}, {"grid_spacing": 65535}, {"gridbit": 56}, {"gridbit": 255},
    ):  # fmt: skip
        f.client.send("TERRAIN_DATA", **{**good, **bad})
    for lat, lon in ((1_000_000_000, 0), (900_000_000, 1_800_000_000), (-900_000_000, -1_800_000_000)):
        f.client.send("TERRAIN_CHECK", lat=lat, lon=lon)
    f.client.companions.clear()
    f.client.delay(20.0)
    assert f.simulation.bridge.get(TerrainService).snapshot()[0] == blocks
    assert f.terrain.loaded == loaded
    f.client.send("TERRAIN_DATA", **good)
    f.client.delay(0.1)
    assert f.simulation.bridge.get(TerrainService).snapshot()[0] != blocks


def test_terrain_check_is_answered(core: Core) -> None:
    f = Flight(core)
    with f.client.messages("TERRAIN_REPORT") as seen:
        lat, lon = f.client.location_of(150.0, 0.0)
        f.client.send("TERRAIN_CHECK", lat=lat, lon=lon)
        f.client.send("TERRAIN_CHECK", lat=lat + 10_000_000, lon=lon)
        f.client.delay(0.05)
        here, there = (m for m in seen if m.lat != f.client.telemetry.lat)
    assert here.terrain_height == pytest.approx(598.0, abs=1.0)
    assert (here.spacing, there.spacing) == (100, 0)
    assert there.pending > 0
    assert f.answers is not None
    before = f.answers.answers
    f.client.delay(8.0)
    assert f.answers.answers > before  # what was not known has been asked for


def test_a_flight_over_the_ground_repeats_from_a_snapshot(core: Core) -> None:
    f = Flight(core)
    f.begin(f.item(300, 0, 20))
    f.client.delay(4.0)
    moment = f.client.snapshot()
    records = []
    for _ in range(2):
        f.client.delay(12.0)
        records.append(f.simulation.v.autopilot.terrain.asked and f.simulation.snapshot())
        f.client.restore(moment)
    first, second = records
    assert first.record == second.record
    assert first.bridge.services == second.bridge.services


def test_heights_from_a_file(core: Core, tmp_path: Any) -> None:
    """Nobody needs to answer; a reboot forgets nothing."""
    import numpy as np

    north = 10.0 * np.arange(-200, 201)
    rows = np.array([ridge(LAT + n / 111318.845, LON) for n in north])[:, None].repeat(401, axis=1)
    np.save(tmp_path / "ridge.npy", rows)
    f = Flight(core, answers=False, terrain=f"{tmp_path / 'ridge.npy'}:10")
    f.begin(f.item(150, 0, 20))
    f.client.wait_waypoint(2)
    f.client.delay(5.0)
    assert f.over_ground == pytest.approx(20.0, abs=0.3)
    assert f.client.altitude == pytest.approx(33.9, abs=0.5)


def test_the_log_has_the_ground_and_that_it_is_missing(core: Core, tmp_path: Path) -> None:
    f = Flight(core)
    log = open_dataflash(f.simulation, tmp_path / "flight.bin")
    f.client.take_off(15.0)
    f.target(150.0, 20.0)
    f.client.delay(30.0)
    f.client.params["TERRAIN_ENABLE"] = 0
    f.client.wait_mode("RTL", timeout=2.0)
    log.close()
    rows = read_log(tmp_path / "flight.bin")
    last = rows["TERR"][-1]
    assert (last.Spacing, last.Pending, last.Loaded) == (100, 0, 504)
    assert last.TerrH == pytest.approx(ALT + 13.9, abs=0.5)
    assert last.CHeight == pytest.approx(20.0, abs=0.5)
    assert [(row.Subsys, row.ECode) for row in rows["ERR"]][-1:] == [(23, 1)]
