# SPDX-License-Identifier: BSD-3-Clause
"""ArduPilot's recorded mission, a square of 20 m, through sequencer, planner, AUTO and controllers."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import pytest

from sitl.autopilot.mission.item import MissionItem
from sitl.autopilot.mission.mission import Mission
from sitl.autopilot.mission.sequencer import Sequencer
from sitl.autopilot.notes import ItemReached, Text
from sitl.autopilot.rover.mission import COMMANDS
from sitl.autopilot.rover.modes.auto import AUTO
from sitl.autopilot.rover.modes.set_mode import request
from tests.autopilot.rover.modes.driven_rover import Rover

LAT, LON = -353632621, 1491652371
NORTH, EAST = -353630824, 1491654574
PLACES = ((LAT, LON), (NORTH, LON), (NORTH, EAST), (LAT, EAST), (LAT, LON))
RECORDED = (10.2, 15.4, 20.6, 29.7)
RESIDUAL = (0.02, 0.018)
"""What the recorded estimate still said of the velocity of the standing vehicle [m/s].

The path's time waits for a vehicle that goes the other way, as this one does at first; so small a number is worth a
second of this mission.
"""


@dataclass
class Holder:
    v: Any
    mission: Mission


class Biased(Rover):
    """Its estimate is off by RESIDUAL."""

    def _sense(self, turn_rate: float) -> None:
        super()._sense(turn_rate)
        self.ap.estimate.vel = self.ap.estimate.vel.replace(x=self.ap.estimate.vel.x + RESIDUAL[0])
        self.ap.estimate.vel = self.ap.estimate.vel.replace(y=self.ap.estimate.vel.y + RESIDUAL[1])


def test_square_as_recorded() -> None:
    rover = Biased()
    rover.ap.estimate.origin_lat, rover.ap.estimate.origin_lon = LAT, LON
    rover.run(1.1)
    rover.arm()
    rover.place(-0.11, 0.08, -2.39)
    mission = Mission(tuple(MissionItem(16, x=lat, y=lon) for lat, lon in PLACES))
    sequencer = Sequencer(Holder(rover.v, mission), COMMANDS)
    request(rover.v, AUTO, 2)
    notes: list[Any] = sequencer.attend()
    times: list[float] = []
    top = 0.0
    for k in range(1700):
        rover.step()
        told = sequencer.attend()
        notes += told
        times += [0.02 * (k + 1) for note in told if isinstance(note, ItemReached)]
        top = max(top, rover.speed)
    assert times == pytest.approx(RECORDED, rel=0.05)
    assert top == pytest.approx(4.36, rel=0.05)
    said = [note.text for note in notes if isinstance(note, Text)]
    assert said == [
        "Mission: 1 WP", "Reached waypoint #1", "Mission: 2 WP", "Reached waypoint #2",
        "Mission: 3 WP", "Reached waypoint #3", "Mission: 4 WP", "Reached waypoint #4", "Mission Complete",
    ]  # fmt: skip
    assert rover.speed == pytest.approx(0.0, abs=0.02)
    assert rover.position == pytest.approx((0.0, 0.0), abs=1.0)
