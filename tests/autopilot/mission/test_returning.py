# SPDX-License-Identifier: BSD-3-Clause
"""The parts of a mission that bring a vehicle back, and where items are: nearest landings and legs, marks, frames."""

from __future__ import annotations

from typing import Any

import pytest

from sitl.autopilot.mission import location, returning
from sitl.autopilot.mission.item import MissionItem, home_item
from sitl.autopilot.mission.mission import Mission
from sitl.autopilot.navigation.state import BEST, BY_LANDING, BY_PATH, COMPLETE, LANDING, RETURN_PATH, RUNNING, STOPPED
from sitl.core.geodesy import add_offset, offset_ne
from sitl.core.mavlink import MavCmd, MavFrame
from sitl.core.vectors import Vec3
from tests.autopilot.mission.test_sequencer import ALT, LAT, LON, TAKEOFF, WP, Vehicle, jump

LAND = MissionItem(MavCmd.NAV_LAND)
HOME = MissionItem(MavCmd.NAV_RETURN_TO_LAUNCH)
PATH, LANDINGS = MavCmd.DO_RETURN_PATH_START, MavCmd.DO_LAND_START


def at(command: int, north: float, east: float = 0.0, z: float = 10.0) -> MissionItem:
    """An item so far from the origin [m], above home."""
    lat, lon = add_offset(LAT, LON, north, east)
    return MissionItem(command, MavFrame.GLOBAL_RELATIVE_ALT, x=round(lat), y=round(lon), z=z)


def to(north: float, east: float = 0.0, z: float = 10.0) -> MissionItem:
    return at(MavCmd.NAV_WAYPOINT, north, east, z)


def mark(command: int) -> MissionItem:
    """Without a location."""
    return MissionItem(command)


def mission(*items: MissionItem) -> Mission:
    return Mission((home_item(LAT, LON, ALT), *items))


def here(north: float, east: float = 0.0, up: float = 10.0) -> Any:
    """The autopilot of a vehicle there."""
    ap = Vehicle(TAKEOFF).v.autopilot
    ap.estimate.pos = Vec3(north, east, -up)
    return ap


def test_a_mark_has_a_navigation_command_behind_it() -> None:
    found = mission(mark(LANDINGS), LAND, mark(LANDINGS), mark(PATH), mark(LANDINGS))
    assert returning.marks(found, LANDINGS) == [1]
    assert returning.marks(found, PATH) == [] == returning.marks(mission(), PATH)
    assert returning.marks(mission(mark(PATH), WP), PATH) == [1]


@pytest.mark.parametrize(
    ("items", "there"),
    [
        ((mark(PATH), to(10)), True),
        ((mark(PATH), LAND), False),  # a landing where it is: no location
        ((mark(PATH), HOME, to(10)), True),
        ((mark(PATH), mark(LANDINGS), to(10)), False),  # it ends where a landing sequence begins
        ((to(10), mark(PATH)), False),
        ((to(10), mark(LANDINGS), to(20)), False),
    ],
)
def test_a_return_path_has_a_location(items: Any, there: bool) -> None:
    assert returning.has_path(mission(*items)) == there


@pytest.mark.parametrize(
    ("north", "found"),
    [(0.0, 2), (49.0, 2), (51.0, 5), (200.0, 5)],
)
def test_the_nearest_landing_sequence_by_its_own_location(north: float, found: int) -> None:
    items = mission(to(5), at(LANDINGS, 0), to(1000), LAND, at(LANDINGS, 100), to(-1000), LAND)
    assert returning.nearest_landing(items, here(north)) == found


def test_a_landing_sequence_without_a_location_is_where_its_first_command_is() -> None:
    items = mission(to(5), mark(LANDINGS), to(0, 300), LAND, mark(LANDINGS), to(100), LAND)
    assert returning.nearest_landing(items, here(90)) == 5
    assert returning.nearest_landing(items, here(0, 290)) == 2
    assert returning.nearest_landing(mission(to(5), LAND), here(0)) == 0


def test_height_does_not_count_for_landings() -> None:
    items = mission(to(5), at(LANDINGS, 0, z=500.0), LAND, at(LANDINGS, 40, z=0.0), LAND)
    assert returning.nearest_landing(items, here(10, up=0.0)) == 2


@pytest.mark.parametrize(
    ("north", "east", "found"),
    [(0, 0, 2), (90, 0, 3), (200, 10, 4), (100, 60, 4), (500, 500, 4), (50, 0, 3)],
)
def test_the_nearest_leg_of_a_return_path(north: float, east: float, found: int) -> None:
    """Its number is that of the item at its end; before the first one is the location of the mark, if it has one."""
    items = mission(mark(PATH), to(0), to(100), to(100, 100), LAND)
    assert returning.nearest_leg(items, here(north, east)) == found


def test_a_mark_with_a_location_begins_a_leg() -> None:
    assert returning.nearest_leg(mission(at(PATH, 0), to(100), to(200), LAND), here(50)) == 2
    assert returning.nearest_leg(mission(mark(PATH), to(100), to(200), LAND), here(120)) == 3
    assert returning.nearest_leg(mission(to(0), to(10), LAND), here(5)) == 0


def test_of_several_return_paths_the_nearest_counts_in_height_too() -> None:
    items = mission(mark(PATH), to(0, z=100.0), to(100, z=100.0), LAND, mark(PATH), to(0, 50), to(100, 50), LAND)
    assert returning.nearest_leg(items, here(60, up=10.0)) == 7
    assert returning.nearest_leg(items, here(60, up=90.0)) == 3


def test_a_leg_of_no_length_is_a_point() -> None:
    assert returning.nearest_leg(mission(mark(PATH), to(50), to(50), to(90), LAND), here(20)) == 2


def test_a_return_path_follows_jumps_and_ends() -> None:
    items = mission(mark(PATH), to(0), jump(5, 1), to(500), to(10), LAND, to(900))
    assert returning.nearest_leg(items, here(500)) == 5, "what is jumped over is no part of it"
    assert returning.nearest_leg(items, here(900)) == 5, "nor what is behind a landing"
    endless = mission(mark(PATH), to(0), to(10), jump(2, -1))
    assert returning.nearest_leg(endless, here(8)) == 3


# ---------------------------------------------------------------- the sequencer goes there


def told(vehicle: Vehicle, how: int, at_once: bool) -> list[str]:
    notes = vehicle.sequencer.go_back(vehicle.v, how, at_once)
    return [note.text for note in notes if hasattr(note, "text")]


def flown(*items: MissionItem) -> Vehicle:
    """One that flies its first leg."""
    vehicle = Vehicle(TAKEOFF, *items).start()
    vehicle.complete()
    return vehicle


def test_a_running_mission_goes_to_its_way_back_at_once() -> None:
    vehicle = flown(to(300), mark(PATH), to(100), to(0), LAND)
    assert told(vehicle, BY_PATH, True)[-1] == "Return path started"
    assert (vehicle.nav.mission_state, vehicle.nav.command_seq, vehicle.nav.mission_part) == (RUNNING, 5, RETURN_PATH)


def test_a_landing_sequence_is_gone_to_past_a_return_path() -> None:
    vehicle = flown(to(300), mark(PATH), to(100), mark(LANDINGS), to(20), LAND)
    assert told(vehicle, BY_LANDING, True)[-1] == "Landing sequence start"
    assert vehicle.nav.mission_part == LANDING and vehicle.nav.command_seq == 6


def test_without_a_return_path_the_best_is_a_landing_sequence() -> None:
    vehicle = flown(to(300), mark(LANDINGS), to(20), LAND)
    assert told(vehicle, BEST, True)[-1] == "Landing sequence start" and vehicle.nav.command_seq == 4


def test_a_mission_that_does_not_run_goes_there_when_it_does() -> None:
    vehicle = Vehicle(TAKEOFF, to(300), mark(LANDINGS), to(20), LAND)
    words = told(vehicle, BY_LANDING, True)
    assert vehicle.nav.mission_state == STOPPED and words[-1] == "Landing sequence start"
    assert words[:2] == ["Mission: 3 DoLandStart", "Mission: 4 WP"] or len(words) == 3
    vehicle.start()
    assert (vehicle.nav.mission_state, vehicle.nav.command_seq) == (RUNNING, 4)


def test_one_that_is_complete_goes_there_at_once_or_waits() -> None:
    for at_once, state in ((True, RUNNING), (False, STOPPED)):
        vehicle = Vehicle(TAKEOFF, to(300), mark(LANDINGS), to(20), LAND).start()
        vehicle.order()
        assert vehicle.nav.mission_state == COMPLETE
        told(vehicle, BY_LANDING, at_once)
        assert vehicle.nav.mission_state == state


# ---------------------------------------------------------------- where items are


@pytest.fixture
def ap() -> Any:
    """Home is 4 m above the origin of the estimate."""
    found = here(30.0, 40.0, 12.0)
    found.home.pos = Vec3(1.0, 2.0, -4.0)
    return found


@pytest.mark.parametrize(
    ("frame", "z", "down"),
    [
        (MavFrame.GLOBAL_RELATIVE_ALT, 10.0, -14.0), (MavFrame.GLOBAL_RELATIVE_ALT_INT, 10.0, -14.0),
        (MavFrame.GLOBAL_TERRAIN_ALT, 10.0, -14.0), (MavFrame.GLOBAL, ALT + 10.0, -10.0),
        (MavFrame.GLOBAL_INT, ALT - 3.0, 3.0),
    ],
)  # fmt: skip
def test_altitudes_count_from_home_or_from_the_sea(ap: Any, frame: int, z: float, down: float) -> None:
    assert location.down(ap, MissionItem(16, frame, z=z)) == pytest.approx(down)


def test_what_an_item_does_not_say_is_the_defaults(ap: Any) -> None:
    default = Vec3(7.0, 8.0, -9.0)
    item = to(100.0, -50.0, 10.0)
    assert location.point(ap, item, default) == pytest.approx((100.0, -50.0, -14.0), abs=0.01)
    assert location.point(ap, item._replace(x=0, y=0), default) == pytest.approx((7.0, 8.0, -14.0))
    assert location.point(ap, item._replace(z=0.0), default) == pytest.approx((100.0, -50.0, -9.0), abs=0.01)
    assert location.point(ap, item._replace(x=0), default).x != pytest.approx(7.0), "on the equator there are places"


def set_home(ap: Any, item: MissionItem) -> tuple[Any, float]:
    location.set_home(ap, item)
    home = ap.home
    north, east = offset_ne(LAT, LON, home.lat, home.lon)
    assert (north, east) == pytest.approx((float(home.pos.x), float(home.pos.y)), abs=0.02)
    assert bool(home.is_set)
    return home.pos, float(home.alt)


@pytest.mark.parametrize("item", [to(100.0)._replace(command=179, p1=1.0), MissionItem(179)])
def test_home_is_set_to_where_the_vehicle_is(ap: Any, item: MissionItem) -> None:
    pos, alt = set_home(ap, item)
    assert pos == pytest.approx((30.0, 40.0, -12.0)) and alt == pytest.approx(ALT + 12.0)


def test_home_is_set_to_a_location(ap: Any) -> None:
    pos, alt = set_home(ap, to(100.0, -50.0, 10.0)._replace(command=179))
    assert pos == pytest.approx((100.0, -50.0, -14.0), abs=0.01) and alt == pytest.approx(ALT + 14.0)
    pos, alt = set_home(ap, MissionItem(179, MavFrame.GLOBAL, z=ALT + 5.0))
    assert (int(ap.home.lat), int(ap.home.lon), alt) == (0, 0, pytest.approx(ALT + 5.0)), (
        "ArduPilot takes it at its word"
    )


@pytest.mark.parametrize("locked", [False, True])
def test_a_mission_neither_locks_home_nor_unlocks_it(ap: Any, locked: bool) -> None:
    ap.home.locked = locked
    for item in (to(100.0)._replace(command=179), MissionItem(179, p1=1.0)):
        location.set_home(ap, item)
        assert bool(ap.home.locked) == locked


def test_without_an_origin_home_stays(ap: Any) -> None:
    ap.estimate.origin_set = False
    location.set_home(ap, to(100.0)._replace(command=179))
    assert ap.home.pos == pytest.approx((1.0, 2.0, -4.0)) and not ap.home.locked
