# SPDX-License-Identifier: BSD-3-Clause
"""Missions flown from power-on to their end, and why some are not completed."""

from __future__ import annotations

from pathlib import Path

import pytest

from sitl import vehicles, worlds
from sitl.core.mavlink import MavCmd
from sitl.errors import OptionError
from sitl.missions import library
from sitl.missions.files import for_vehicle, load
from sitl.missions.fly import MissionRefused, Outcome, fly
from sitl.missions.library import make
from sitl.missions.library.draft import Draft
from sitl.simulation import Simulation
from sitl.vehicle.kinds import KINDS


def flown(draft: Draft, frame: str = "erle_copter", limit_s: float = 300.0, **options: object) -> Outcome:
    """A mission flown without words."""
    simulation = Simulation(frame, **options)  # type: ignore[arg-type]
    try:
        return fly(simulation, draft.file().mission, limit_s=limit_s)
    finally:
        simulation.close()


def copter() -> Draft:
    return Draft("copter", "").take_off(5)


def rover() -> Draft:
    return Draft("rover", "")


def test_a_copter_flies_its_mission_and_lands() -> None:
    outcome = flown(copter().to((10, 0), (10, 10), z=5.0).land())
    assert outcome.completed, outcome.reason
    assert [seq for _, seq in outcome.items] == [1, 2, 3]
    assert outcome.distance == pytest.approx(5 + 10 + 10 + 5, abs=3.0)
    assert 20.0 < outcome.duration < 60.0
    assert 0.3 < outcome.energy < 3.0
    assert outcome.top_height == pytest.approx(5.0, abs=0.3)
    assert 0.05 < outcome.deviation.distance < 2.0
    assert outcome.hits == 0


def test_twice_is_the_same_to_the_bit() -> None:
    first, second = (flown(rover().to((5, 0), (5, 5)), "skid_rover", seed=3) for _ in range(2))
    assert first == second
    assert first.completed


def test_a_rover_stops_and_is_disarmed() -> None:
    outcome = flown(rover().to((8, 0)), "erle_rover")
    assert outcome.completed
    assert outcome.texts[-1][2] == "Throttle disarmed"
    assert outcome.deviation.distance < 0.5


def test_a_mission_without_landing_ends_in_the_air() -> None:
    outcome = flown(copter().to((5, 0), z=5.0))
    assert outcome.completed
    assert outcome.reason == "ends in the air: the mission has no landing"


def test_a_stay_without_end_runs_into_the_limit() -> None:
    outcome = flown(copter().add(MavCmd.NAV_LOITER_UNLIM, at=(5, 0), z=5.0).land(), limit_s=40.0)
    assert not outcome.completed
    assert outcome.reason == "not ended after 40 s, at item 2 of 3"


def test_a_last_item_in_a_loop_is_not_the_end() -> None:
    """A rover that loses its way back and is disarmed in its second round."""
    endless = rover().to((4, 0), (0, 0)).jump(1, -1)
    outcome = flown(endless, "skid_rover", limit_s=40.0)
    assert [seq for _, seq in outcome.items].count(2) > 1
    assert not outcome.completed
    assert outcome.reason == "not ended after 40 s, at item 1 of 3"


def test_a_landing_in_between_is_not_the_end() -> None:
    outcome = flown(copter().land().to((5, 0), z=5.0))
    assert not outcome.completed
    assert outcome.reason.startswith("disarmed at item 2 Land of 3")


def test_no_take_off_is_the_vehicles_own_refusal() -> None:
    outcome = flown(Draft("copter", "").to((5, 0), z=5.0))
    assert not outcome.completed
    assert outcome.reason.startswith("mode AUTO was refused (MAV_RESULT 4): ")
    assert "Missing Takeoff Cmd" in outcome.reason


def test_a_fault_says_why_the_vehicle_is_not_ready() -> None:
    outcome = flown(copter().land(), params={"ARMING_CHECK": 1, "BATT_ARM_VOLT": 100.0})
    assert not outcome.completed
    assert outcome.reason.startswith("not ready to arm after 120 s: ")


def test_a_failsafe_on_the_way_is_told() -> None:
    low = {"BATT_CAPACITY": 5000.0, "BATT_LOW_MAH": 4950.0, "BATT_FS_LOW_ACT": 1}
    outcome = flown(copter().to((300, 0), z=5.0).land(), params=low)
    assert not outcome.completed
    assert outcome.reason.startswith("left AUTO for LAND at item 2 WP of 3: ")
    assert "Battery 1 is low" in outcome.reason


def test_what_a_vehicle_does_not_fly_is_refused_before_the_flight() -> None:
    with pytest.raises(MissionRefused, match="item 1: a rover does not fly command 22 Takeoff; it flies 16 WP, "):
        flown(copter().land(), "erle_rover")
    with pytest.raises(MissionRefused, match="item 1: a rover does not fly command 82 SplineWP"):
        flown(rover().curve((5, 0), z=5.0), "erle_rover")
    with pytest.raises(MissionRefused, match=r"item 2: 1\d+ km from home \(47.0, 8.0\); it is within 20 km"):
        flown(copter().to((5, 0), z=5.0), home=(47.0, 8.0, 400.0, 0.0))
    with pytest.raises(MissionRefused, match="no items"):
        flown(Draft("copter", ""))


def test_a_new_speed_holds_on_a_leg_that_was_planned_ahead() -> None:
    """A rover goes round the corner without a stop, and faster behind it."""
    outcome = flown(rover().pace(0.5).to((8, 0)).pace(1.2).to((8, 20)), "erle_rover")
    assert outcome.completed
    assert outcome.top_speed > 1.15


@pytest.mark.parametrize("name", library.entries())
def test_every_mission_of_the_library_is_completed(name: str) -> None:
    entry = library.find(name)
    file = for_vehicle(load(entry.path), KINDS[entry.kind].firmware.commands.taken)
    assert file.home is not None
    assert file.kind in (entry.kind, None)
    simulation = Simulation(entry.frame, home=(*file.home, 0.0), world=entry.world, params=entry.params)
    try:
        outcome = fly(simulation, file.mission)
    finally:
        simulation.close()
    assert outcome.completed, outcome.reason
    assert outcome.hits == 0
    assert outcome.deviation.distance < 2.5


@pytest.mark.parametrize("radius", [80.0, 10.0])
def test_the_fence_of_a_plan_is_uploaded_and_heeded(radius: float) -> None:
    """Within the plan's own circle the mission is flown; a smaller one ends it on the way out, and it returns."""
    file = load(library.find("copter/fence_and_rally").path)
    assert file.home is not None
    fence = tuple(
        item._replace(p1=radius) if item.command == MavCmd.NAV_FENCE_CIRCLE_INCLUSION else item
        for item in file.fence_items
    )
    simulation = Simulation("erle_copter", home=(*file.home, 0.0), params={"FENCE_ENABLE": 1})
    try:
        outcome = fly(simulation, file.mission, fence=fence, rally=file.rally_items)
        autopilot = simulation.v.autopilot
    finally:
        simulation.close()
    assert (autopilot.fence.shapes, autopilot.params.RALLY.TOTAL) == (3, 1)
    assert outcome.completed == (radius > 50.0)
    breached = [time for time, _, text in outcome.texts if text == "Polygon fence breached"]
    assert len(breached) == (0 if radius > 50.0 else 1)


def test_the_files_are_what_the_drafts_make(tmp_path: Path) -> None:
    """Else: python -m sitl.missions.library.make."""
    make.write(tmp_path)
    made = {path.relative_to(tmp_path): path.read_text() for path in tmp_path.rglob("*") if path.is_file()}
    for path, text in made.items():
        assert (library.FOLDER / path).read_text() == text, path
    kept = {p.relative_to(library.FOLDER) for p in library.FOLDER.glob("*/*") if p.parent.name in ("copter", "rover")}
    assert kept == {path for path in made if len(path.parts) == 2}


def test_every_entry_has_its_vehicle_and_world() -> None:
    assert len(library.entries()) > 25
    for entry in library.entries().values():
        assert vehicles.load(entry.frame).kind == entry.kind
        assert entry.world is None or entry.world in worlds.names()
        assert entry.description and "\n" not in entry.description
        assert load(entry.path).mission.present


def test_an_unknown_name_is_told() -> None:
    with pytest.raises(OptionError, match=r"no mission 'copter/loop'.*sitl mission library lists all"):
        library.find("copter/loop")
