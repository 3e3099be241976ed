# SPDX-License-Identifier: BSD-3-Clause
"""``sitl mission fly`` without a flight: what it takes from file and library, and how it sums up."""

from __future__ import annotations

import argparse
import math
from types import SimpleNamespace
from typing import Any

import pytest

from sitl.errors import OptionError
from sitl.missions import library
from sitl.missions.cli.fly import prepare, print_fence_and_rally, print_step, summary
from sitl.missions.fly import Outcome
from sitl.missions.path import Deviation


def options(**given: Any) -> argparse.Namespace:
    names = dict.fromkeys(("vehicle", "frame", "world", "start", "home"))
    return argparse.Namespace(**{**names, "physics": "native", **given})


def file(**given: Any) -> Any:
    """As much of a mission file as is looked at."""
    return SimpleNamespace(**{"name": "x.plan", "kind": None, "vehicle_type": None, "home": None, **given})


@pytest.mark.parametrize(
    ("given", "found", "vehicle"),
    [
        ({}, {}, "copter"),
        ({}, {"kind": "rover", "vehicle_type": 10}, "rover"),
        ({}, {"vehicle_type": 0}, "copter"),  # MAV_TYPE_GENERIC says nothing
        ({"frame": "erle_rover"}, {}, "rover"),
        ({"frame": "erle_rover"}, {"kind": "rover", "vehicle_type": 10}, "rover"),
        ({"vehicle": "rover"}, {}, "rover"),
        ({"vehicle": "rover"}, {"vehicle_type": 1}, "rover"),  # an aeroplane's, flown by what was said
    ],
)
def test_what_flies_it(given: Any, found: Any, vehicle: str) -> None:
    chosen = options(**given)
    assert prepare(chosen, file(**found), None) == {}
    assert chosen.vehicle == vehicle and chosen.frame == given.get("frame")


@pytest.mark.parametrize(
    ("given", "found", "error"),
    [
        ({}, {"vehicle_type": 1}, r"x.plan: vehicleType 1 \(MAV_TYPE\) is none of copter, rover; --vehicle says what"),
        ({"vehicle": "copter"}, {"kind": "rover", "vehicle_type": 10}, "vehicleType 10 is a rover, not a copter"),
        ({"frame": "erle_copter"}, {"kind": "rover", "vehicle_type": 10}, "vehicleType 10 is a rover, not a copter"),
    ],
)
def test_what_does_not_fly_it_is_named(given: Any, found: Any, error: str) -> None:
    with pytest.raises(OptionError, match=error):
        prepare(options(**given), file(**found), None)


@pytest.mark.parametrize(
    ("given", "home"),
    [
        ({}, (1.0, 2.0, 3.0, 0.0)),
        ({"home": (4.0, 5.0, 6.0, 7.0)}, (4.0, 5.0, 6.0, 7.0)),
        ({"physics": "json:0.0.0.0:9002"}, None),  # physics elsewhere says where it is
    ],
)
def test_home_is_the_files_unless_it_is_given(given: Any, home: Any) -> None:
    chosen = options(**given)
    prepare(chosen, file(home=(1.0, 2.0, 3.0)), None)
    assert chosen.home == home


def test_an_entry_of_the_library_brings_frame_world_and_parameters() -> None:
    entry = library.find("copter/office_route")
    chosen = options()
    assert prepare(chosen, file(kind="copter"), entry) == dict(entry.params)
    assert (chosen.vehicle, chosen.frame, chosen.world) == ("copter", entry.frame, "office_erlecopter")
    assert chosen.start == entry.start
    chosen = options(frame="ardupilot_quad", world="maze", start="here")
    prepare(chosen, file(kind="copter"), entry)
    assert (chosen.frame, chosen.world, chosen.start) == ("ardupilot_quad", "maze", "here")


def outcome(**given: Any) -> Outcome:
    found = Outcome(**{"completed": True, "started": 30.0, "ended": 72.5, "ready": 25.0, **given})
    found.distance, found.energy, found.items = 61.26, 1.234, [(40.0, 1), (50.0, 2)]
    found.top_speed, found.top_height = 5.678, 12.346
    found.deviation = Deviation(0.456, 2, 45.67)
    return found


def test_a_completed_mission_in_five_lines() -> None:
    assert summary(outcome()).splitlines() == [
        "mission completed",
        "  time 42.5 s, distance 61.3 m, energy 1.23 Wh, items reached 2",
        "  top speed 5.68 m/s, top height 12.35 m",
        "  farthest from the lines of the mission 0.46 m (item 2, at 45.7 s)",
    ]
    assert summary(outcome(reason="ends in the air")).startswith("mission completed: ends in the air\n")


def test_solids_that_were_hit_are_told() -> None:
    assert summary(outcome(hits=3)).splitlines()[-1] == "  hit solids 3 times"


def test_one_that_never_began_is_told_in_a_line() -> None:
    found = outcome(completed=False, started=math.nan, reason="not ready")
    assert summary(found) == "mission NOT COMPLETED: not ready"
    assert summary(outcome(completed=False, reason="crashed")).startswith("mission NOT COMPLETED: crashed\n  time")


@pytest.mark.parametrize(
    ("areas", "enabled", "text"),
    [
        ((1, 1), True, "  geofence of 2 areas, 1 rally points\n"),
        ((1, 0), False, "  geofence of 1 areas (without effect: FENCE_ENABLE is 0), 1 rally points\n"),
        ((0, 0), False, "  geofence of 0 areas, 1 rally points\n"),
    ],
)
def test_what_is_uploaded_besides(
    areas: tuple[int, int], enabled: bool, text: str, capsys: pytest.CaptureFixture[str]
) -> None:
    found: Any = SimpleNamespace(circles=[1] * areas[0], polygons=[1] * areas[1], rally=[1])
    print_fence_and_rally(found, enabled)
    assert capsys.readouterr().out == text


def test_a_step_has_its_time(capsys: pytest.CaptureFixture[str]) -> None:
    print_step(12.34, "armed")
    assert capsys.readouterr().out == "    12.3 s  armed\n"
