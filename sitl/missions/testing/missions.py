# SPDX-License-Identifier: BSD-3-Clause
"""Missions: upload a file, start it, fly it to its end."""

from __future__ import annotations

import math
from collections.abc import Sequence
from pathlib import Path

from sitl.autopilot.mission.item import MissionItem
from sitl.autopilot.mission.mission import Mission
from sitl.client import Client, ClientError, px4
from sitl.errors import OptionError

from .. import library
from ..files import for_vehicle, load
from ..fly import STANDING_S, STANDS, checked

__tracebackhide__ = True

Given = str | Path | Mission | Sequence[MissionItem]


def find(given: str | Path, folders: Sequence[Path]) -> Path:
    """The file of a mission: in one of the folders, or of the library ("copter/square").

    Raises:
        OptionError: there is none.
    """
    for folder in folders:
        if (folder / given).is_file():
            return folder / given
    if str(given) in library.entries():
        return library.find(str(given)).path
    searched = ", ".join(dict.fromkeys(str(folder) for folder in folders))  # the test's is often pytest's own, too
    raise OptionError(f"there is no mission file {str(given)!r} in {searched}, and none in the library")


class MissionFlier(Client):
    """A vehicle that flies mission files."""

    folders: tuple[Path, ...] = (Path(),)
    """Where files are looked for."""

    def upload(self, given: Given) -> Mission:
        """Upload a file (``sitl.missions.files.load``), a mission of the library by its name, or items (home first).

        A file is looked for beside the test, then where pytest runs. A rover gets waypoints on the curve of spline
        waypoints.
        """
        if isinstance(given, str | Path):
            kind = self.connection.kind
            assert kind is not None
            mission = for_vehicle(load(find(given, self.folders)), kind.firmware.commands.taken).mission
        else:
            mission = given if isinstance(given, Mission) else Mission(tuple(given))
        simulation = self.connection.simulation
        return super().upload(checked(mission, simulation) if simulation is not None else mission)

    def fly_mission(self, given: Given, timeout: float = 1800.0) -> None:
        """Upload a mission, start it, and wait for its end: a copter is disarmed, a rover has reached the last item."""
        mission = self.upload(given)
        self.start_mission()
        last = max(seq for seq, item in enumerate(mission.items) if item.is_nav)
        if not self.flies:
            self.wait_waypoint(last, timeout)
            self.wait_groundspeed(-math.inf, STANDS, 30.0, STANDING_S)
            self.disarm()
            return
        self.wait_disarmed(timeout)
        ends = px4.MISSION_ENDS if self.telemetry.is_px4 else ("AUTO",)
        if self.mode not in ends or last not in (*self.reached, *self.telemetry.items):
            name = mission.items[last].name
            self.raise_error(ClientError("the mission", f"was not flown to its end, item {last} {name}"))
