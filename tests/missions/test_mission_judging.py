# SPDX-License-Identifier: BSD-3-Clause
"""Whether a mission was completed, and why not, of a vehicle that does what the test says."""

from __future__ import annotations

from types import SimpleNamespace
from typing import Any

import pytest

from sitl.autopilot.mission.item import MissionItem, home_item
from sitl.autopilot.navigation.state import COMPLETE
from sitl.core.mavlink import MavCmd
from sitl.missions import fly
from sitl.missions.fly import Outcome, _Flight

ITEMS = (home_item(0, 0, 0.0), MissionItem(MavCmd.NAV_TAKEOFF, 3, z=5.0), MissionItem(MavCmd.NAV_WAYPOINT, 3, x=1, y=1),
         MissionItem(MavCmd.NAV_LAND, 3))  # fmt: skip


class Watch:
    distance, top_speed, top_height, deviation = 61.0, 5.0, 12.0, "d"

    def __init__(self) -> None:
        self.looked = 0

    def look(self) -> None:
        self.looked += 1


def flight(*, flies: bool = True, items: Any = ITEMS, current: int = 3, mode: str = "AUTO", armed: bool = False,
           complete: bool = False, texts: Any = (), why: str = "") -> Any:  # fmt: skip
    found: Any = object.__new__(_Flight)
    nav = SimpleNamespace(mission_state=COMPLETE if complete else 0, command_seq=current)
    autopilot = SimpleNamespace(
        arming=SimpleNamespace(landed=1), modes=SimpleNamespace(nav=nav), battery=SimpleNamespace(consumed_wh=3.5),
        estimate=SimpleNamespace(vel=(0.0, 0.0, 0.0)),
    )  # fmt: skip
    physics = SimpleNamespace(obstacles=SimpleNamespace(hit_count=2))
    found.simulation = SimpleNamespace(
        kind=SimpleNamespace(flies=flies), v=SimpleNamespace(autopilot=autopilot, physics=physics)
    )
    found.station = SimpleNamespace(
        armed=armed, texts=list(texts), now=42.0, mode=mode, why=lambda since: why,
        telemetry=SimpleNamespace(reached=[]),
    )  # fmt: skip
    found.items, found.outcome, found.watch = items, Outcome(), Watch()
    found.last = len(items) - 1
    found._current, found._mode, found._is_complete, found._seen, found._wh = current, mode, complete, 0, 1.25
    found.said = []
    found.on_step = lambda time, text: found.said.append((time, text))
    return found


@pytest.mark.parametrize(
    ("given", "completed", "reason"),
    [
        ({}, True, ""),
        ({"current": 2}, False, "disarmed at item 2 WP of 3"),
        ({"current": 2, "why": ": Battery failsafe"}, False, "disarmed at item 2 WP of 3: Battery failsafe"),
        ({"mode": "RTL", "why": ": Radio failsafe"}, False, "left AUTO for RTL at item 3 Land of 3: Radio failsafe"),
        ({"mode": "LAND", "complete": True}, True, ""),
        ({"complete": True, "armed": True}, True, "ends in the air: the mission has no landing"),
        ({"complete": True, "texts": [(1.0, 0, "Crash: Disarming: AngErr=70>30")]}, False,
         "Crash: Disarming: AngErr=70>30 (at item 3 Land of 3)"),
        ({"items": ITEMS[:3], "current": 2}, False, "disarmed at item 2 WP of 2"),
        ({"items": (*ITEMS[:3], MissionItem(MavCmd.NAV_RETURN_TO_LAUNCH)), "current": 3}, True, ""),
    ],
)  # fmt: skip
def test_a_mission_is_completed_when_its_last_item_brought_it_down(given: Any, completed: bool, reason: str) -> None:
    found = flight(**given)
    found._judge()
    assert (found.outcome.completed, found.outcome.reason) == (completed, reason)


@pytest.mark.parametrize(
    ("flies", "complete", "armed", "landed", "over"),
    [
        (True, False, True, 0, False),
        (True, False, False, 0, True),
        (True, True, True, 0, True),
        (True, True, True, 1, False),  # on the ground: it disarms by itself
        (False, True, True, 1, True),
        (False, False, True, 1, False),
    ],
)
def test_when_it_is_over(flies: bool, complete: bool, armed: bool, landed: int, over: bool) -> None:
    found = flight(flies=flies, complete=complete, armed=armed)
    found.simulation.v.autopilot.arming.landed = landed
    assert found._is_over() == over and found._is_complete == complete


def test_modes_items_and_their_names_are_told_as_they_come() -> None:
    found = flight(current=0, mode="GUIDED", armed=True, why=": Radio failsafe")
    found._mode = ""
    found._look()
    assert found.said == [] and found.watch.looked == 1
    found.station.mode, found.simulation.v.autopilot.modes.nav.command_seq = "AUTO", 2
    found._look()
    assert found.said == [] and found._current == 2, "AUTO is what was asked for"
    found.station.telemetry.reached = [(40.5, 1), (41.0, 2), (41.5, 9)]
    found.station.mode = "RTL"
    found.simulation.v.autopilot.modes.nav.command_seq = 3
    found._look()
    assert found.said == [
        (42.0, "mode RTL: Radio failsafe"), (40.5, "item 1 of 3 Takeoff done"), (41.0, "item 2 of 3 WP done"),
        (41.5, "item 9 of 3 WP done"),
    ]  # fmt: skip
    assert found._current == 2, "in AUTO alone"
    found._look()
    assert len(found.said) == 4 and found.watch.looked == 4, "each once"
    found.station.armed = False
    found._look()
    assert found.watch.looked == 4
    found.watch = None
    found._look()


@pytest.mark.parametrize("armed", [True, False])
def test_what_a_flight_came_to(armed: bool) -> None:
    found = flight(armed=armed, texts=[(1.0, 6, "x")])
    found.station.telemetry.reached = [(40.5, 1)]
    outcome = found.result()
    assert (outcome.ended, outcome.texts, outcome.items, outcome.energy, outcome.hits) == (
        42.0, [(1.0, 6, "x")], [(40.5, 1)], 2.25, 2,
    )  # fmt: skip
    assert (outcome.distance, outcome.top_speed, outcome.top_height, outcome.deviation) == (61.0, 5.0, 12.0, "d")
    assert found.said == [(42.0, "armed still" if armed else "disarmed")]
    found.watch = None
    assert found.result().distance == 61.0


@pytest.mark.parametrize(("speeds", "steps"), [([], 0), ([1.0] * 3, 3), ([0.0] * 3 + [1.0], 4)])
def test_a_rover_is_disarmed_when_it_has_stood_for_a_while(speeds: list[float], steps: int) -> None:
    found = flight(flies=False, armed=True)
    counted: list[int] = []

    def passes(stands: Any, seconds: float) -> bool:
        assert seconds == fly.STOPPING_S
        for k, speed in enumerate([*speeds, *[0.0] * 99]):
            found.simulation.v.autopilot.estimate.vel = (0.6 * speed, 0.8 * speed, 9.0)
            if stands():
                counted.append(k + 1)
                break
        return True

    found.station.passes, found.station.disarm = passes, lambda: counted.append(-1)
    found._stop_rover()
    needed = round(fly.STANDING_S * 1e6 / fly.STEP_US)
    assert counted == [needed + steps, -1] and found.said == [(42.0, "mission complete")]
