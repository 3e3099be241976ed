# SPDX-License-Identifier: BSD-3-Clause
"""How far a vehicle is from the lines of its mission, how long its path was, how fast and high it was."""

from __future__ import annotations

from types import SimpleNamespace
from typing import Any

import pytest

from sitl.autopilot.mission.item import MissionItem, home_item
from sitl.autopilot.mission.mission import Mission
from sitl.core.geodesy import add_offset
from sitl.core.mavlink import MavCmd, MavFrame
from sitl.core.vectors import Vec3
from sitl.missions.path import PathWatch
from sitl.vehicle.copter import Copter

LAT, LON, ALT = 473977000, 85456000, 488.0


def item(command: int, north: float = 0.0, east: float = 0.0, up: float = 10.0) -> MissionItem:
    lat, lon = add_offset(LAT, LON, north, east)
    return MissionItem(command, MavFrame.GLOBAL_RELATIVE_ALT, x=round(lat), y=round(lon), z=up)


TAKE_OFF, DELAY = MissionItem(MavCmd.NAV_TAKEOFF, 3, z=10.0), MissionItem(MavCmd.NAV_DELAY, p1=5.0)


class Flown:
    """A vehicle that is where the test says, and the watch that looks at it."""

    def __init__(self, *items: MissionItem, flies: bool = True) -> None:
        v: Any = Copter()
        estimate = v.autopilot.estimate
        estimate.origin_set, estimate.origin_lat, estimate.origin_lon, estimate.origin_alt = True, LAT, LON, ALT
        v.autopilot.home.pos = Vec3(0.0, 0.0, 0.0)
        mission = Mission((home_item(LAT, LON, ALT), *items))
        kind = SimpleNamespace(flies=flies)
        simulation: Any = SimpleNamespace(v=v, mission=mission, kind=kind, time_us=0)
        self.simulation, self.watch = simulation, PathWatch(simulation)

    def at(self, seq: int, north: float, east: float = 0.0, up: float = 10.0, vel: Any = (0.0, 0.0, 0.0)) -> Flown:
        """Look at it there, a second later, with this item under way."""
        self.simulation.time_us += 1_000_000
        ap = self.simulation.v.autopilot
        ap.estimate.pos, ap.estimate.vel, ap.modes.nav.command_seq = Vec3(north, east, -up), Vec3(*vel), seq
        self.watch.look()
        return self

    @property
    def deviation(self) -> tuple[float, int, float]:
        found = self.watch.deviation
        return round(found.distance, 2), found.seq, found.time


def test_a_path_has_its_length_in_space_and_a_rovers_in_the_plane() -> None:
    for flies, length in ((True, 5.0 + 12.0), (False, 4.0 + 12.0)):
        flown = Flown(TAKE_OFF, flies=flies).at(0, 0.0, up=0.0).at(0, 4.0, up=3.0).at(0, 4.0, 12.0, up=3.0)
        assert flown.watch.distance == pytest.approx(length)


def test_the_greatest_speed_is_over_the_ground_and_height_above_home() -> None:
    flown = Flown(TAKE_OFF)
    flown.simulation.v.autopilot.home.pos = Vec3(0.0, 0.0, -2.0)
    flown.at(0, 0.0, up=7.0, vel=(3.0, 4.0, 9.0)).at(0, 0.0, up=5.0, vel=(-4.0, 0.0, 0.0)).at(0, 0.0, up=1.0)
    assert flown.watch.top_speed == pytest.approx(5.0) and flown.watch.top_height == pytest.approx(5.0)


def test_before_the_first_line_nothing_is_off_it() -> None:
    flown = Flown(TAKE_OFF, item(16, 50)).at(0, 9.0, 9.0).at(1, 7.0, 7.0, up=0.0).at(1, 9.0, 7.0, up=5.0)
    assert flown.deviation == (0.0, 0, 0.0)


def test_a_leg_begins_where_the_take_off_ended_and_goes_to_the_waypoint() -> None:
    flown = Flown(TAKE_OFF, item(16, 50)).at(1, 2.0, 0.0, up=0.0).at(1, 3.0, 0.0, up=11.0)
    flown.at(2, 3.0, 0.0, up=10.0)
    assert flown.deviation == (0.0, 0, 0.0), "from (2, 0, 10) on, not from where it was then"
    flown.at(2, 30.0, 2.0).at(2, 40.0, 1.5)
    assert flown.deviation == (2.0, 2, 4.0)
    flown.at(2, 45.0, 0.0, up=12.5)
    assert flown.deviation == (2.5, 2, 6.0), "in height, too"
    flown.at(2, 53.0)
    assert flown.deviation == (3.0, 2, 7.0), "beyond the waypoint"


def test_of_two_lines_the_nearer_counts_at_a_corner() -> None:
    flown = Flown(TAKE_OFF, item(16, 50), item(16, 50, 50), item(16, 0, 50)).at(1, 0.0).at(2, 0.0).at(2, 48.0)
    flown.at(3, 47.0, 0.5)
    assert flown.deviation[0] == 0.5, "on the line that it came from"
    flown.at(4, 46.0, 46.0)
    assert flown.deviation[0] == 4.0, "the line before the last one counts no more"


def test_a_wait_is_a_point() -> None:
    flown = Flown(TAKE_OFF, item(16, 50), DELAY).at(1, 0.0).at(2, 20.0).at(2, 50.0).at(3, 50.0).at(3, 50.0, 1.25)
    assert flown.deviation == (1.25, 3, 5.0)
    flown = Flown(TAKE_OFF, item(16, 50), DELAY, item(16, 50, 50)).at(1, 0.0).at(2, 50.0).at(3, 50.0).at(4, 50.0, 30.0)
    assert flown.deviation[0] == 0.0, "the next line begins there"


def test_without_an_end_the_next_line_begins_where_the_vehicle_is() -> None:
    flown = Flown(TAKE_OFF, MissionItem(MavCmd.NAV_LAND), item(16, 50)).at(1, 0.0).at(2, 5.0, 9.0)
    flown.at(3, 5.0, 9.0).at(3, 27.5, 4.5)
    assert flown.deviation[0] == pytest.approx(0.0, abs=0.05)


def test_an_item_that_is_not_there_has_no_line() -> None:
    flown = Flown(TAKE_OFF, item(16, 50)).at(1, 0.0).at(2, 10.0).at(9, 10.0, 20.0)
    assert flown.deviation == (0.0, 0, 0.0)


def test_rovers_are_judged_in_the_plane() -> None:
    flown = Flown(item(16, 50, up=0.0), item(16, 50, 50, up=0.0), flies=False)
    flown.at(1, 0.0, up=0.0).at(1, 20.0, 0.75, up=30.0)
    assert flown.deviation == (0.75, 1, 2.0)
