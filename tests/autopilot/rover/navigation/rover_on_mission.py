# SPDX-License-Identifier: BSD-3-Clause
"""A driven rover with a mission and the shell's part of it."""

from __future__ import annotations

from typing import Any

from sitl.autopilot.mission.item import MissionItem, home_item
from sitl.autopilot.mission.mission import Mission
from sitl.autopilot.mission.sequencer import Sequencer
from sitl.autopilot.notes import ItemReached, Text
from sitl.autopilot.rover.mission import COMMANDS
from sitl.autopilot.rover.modes.auto import AUTO
from sitl.autopilot.rover.modes.set_mode import request
from sitl.core.geodesy import add_offset
from sitl.core.mavlink import MavFrame
from tests.autopilot.rover.modes.driven_rover import Rover

ORIGIN = (-353632621, 1491652371, 584.0)


def at(command: int, n: float, e: float, **fields: float) -> MissionItem:
    """An item at an offset from the origin [m]."""
    lat, lon = add_offset(ORIGIN[0], ORIGIN[1], n, e)
    return MissionItem(command, MavFrame.GLOBAL_RELATIVE_ALT, x=round(lat), y=round(lon), **fields)  # type: ignore[arg-type]


class Missionary(Rover):
    """Armed at the origin, facing north, after two seconds at rest; ``drive`` starts a mission."""

    def __init__(self, **params: float) -> None:
        self.sequencer: Sequencer | None = None
        self.notes: list[tuple[float, Any]] = []
        super().__init__(**params)
        estimate = self.ap.estimate
        estimate.origin_lat, estimate.origin_lon, estimate.origin_alt = ORIGIN
        self.arm()
        self.run(2.0)
        self.mission = Mission()
        self.sequencer = Sequencer(self, COMMANDS)
        self.begun_us = int(self.v.time_us)

    @property
    def time(self) -> float:
        """Since the mission was started [s]."""
        return (int(self.v.time_us) - self.begun_us) * 1e-6

    def step(self) -> None:
        """One period, then the shell."""
        super().step()
        if self.sequencer is not None:
            self.notes += [(self.time, note) for note in self.sequencer.attend()]

    def drive(self, *items: MissionItem) -> Missionary:
        """Upload the items and enter AUTO."""
        assert self.sequencer is not None
        self.sequencer.set_mission(self.v, Mission.of([home_item(*ORIGIN), *items]))
        self.begun_us = int(self.v.time_us)
        assert request(self.v, AUTO, 2) == 0
        return self

    def until(self, seq: int, most: float = 120.0) -> float:
        """Drive until an item is reached; its time [s], or infinity."""
        while self.time < most:
            self.step()
            if (reached := self.reached(seq)) is not None:
                return reached
        return float("inf")

    def reached(self, seq: int) -> float | None:
        """When an item was reached [s]."""
        return next((t for t, note in self.notes if note == ItemReached(seq)), None)

    def said(self) -> list[str]:
        """All status texts of the mission."""
        return [note.text for _, note in self.notes if isinstance(note, Text)]
