# SPDX-License-Identifier: BSD-3-Clause
"""Missions: upload a file, start it, fly it to its end."""

from __future__ import annotations

import math
from collections.abc import Sequence
from pathlib import Path
from typing import Any

from sitl.autopilot.mission.item import MissionItem, home_item
from sitl.autopilot.mission.mission import RESULT_NAMES, Mission
from sitl.bridge.client import Received
from sitl.option_error import OptionError

from .. import library
from ..files import load, straightened
from ..fly import checked
from .pilot import Piloted

MISSION_START = 300
STANDS, STANDING_S = 0.1, 1.0
"""A rover has arrived when it is slower than this [m/s] for this long [s]."""
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
    searched = ", ".join(str(folder) for folder in folders)
    raise OptionError(f"there is no mission file {str(given)!r} in {searched}, and none in the library")


class MissionFlier(Piloted):
    """A vehicle that flies missions."""

    folders: tuple[Path, ...] = (Path(),)
    """Where files are looked for."""
    _upload: Sequence[MissionItem] = ()
    _answer: int | None = None

    def upload(self, given: Given) -> Mission:
        """Upload a .plan or .waypoints file, a mission of the library by its name, or items (home first).

        A file is looked for beside the test, then where pytest runs. Spline waypoints become waypoints on the curve.
        """
        __tracebackhide__ = True
        if isinstance(given, str | Path):
            mission = straightened(load(find(given, self.folders))).mission
        else:
            mission = given if isinstance(given, Mission) else Mission(tuple(given))
        checked(mission, self.simulation)
        items = mission.items
        if items[0].no_place:
            lat, lon, alt = self._home()
            items = (home_item(lat, lon, alt), *items[1:])
        self._upload, self._answer = items, None
        self.telemetry.reached.clear()
        self.telemetry.items.clear()
        self.send("MISSION_COUNT", count=len(items))
        self.wait_until(lambda: self._answer is not None, 10.0 + 0.2 * len(items), "MISSION_ACK")
        self._upload = ()
        if self._answer:
            self.give_up(f"the mission was refused: {RESULT_NAMES.get(self._answer, self._answer)}")
        return mission

    def start_mission(self) -> None:
        """Arm if need be, AUTO, and begin with its first item."""
        __tracebackhide__ = True
        if not self.armed:
            self.change_mode("GUIDED")
            self.arm()
        self.change_mode("AUTO")
        if self.kind == "copter":
            self.command(MISSION_START, 0, 0, name="the start of the mission")

    def fly_mission(self, given: Given, timeout: float = 1800.0) -> None:
        """Upload a mission, start it, and wait for its end: a copter is disarmed, a rover has reached the last item."""
        __tracebackhide__ = True
        mission = self.upload(given)
        self.start_mission()
        last = max(seq for seq, item in enumerate(mission.items) if item.is_nav)
        if self.kind == "rover":
            self.wait_waypoint(last, timeout)
            self.wait_groundspeed(-math.inf, STANDS, 30.0, STANDING_S)
            self.disarm()
            return
        self.wait_disarmed(timeout)
        if self.mode != "AUTO" or last not in (*self.reached, *self.telemetry.items):
            self.give_up(f"the mission was not flown to its end, item {last} {mission.items[last].name}")

    def _take(self, now: float, received: Received) -> None:
        super()._take(now, received)
        name, fields = received
        if name in ("MISSION_REQUEST", "MISSION_REQUEST_INT") and fields.seq < len(self._upload):
            self._send_item(fields.seq, self._upload[fields.seq])
        elif name == "MISSION_ACK":
            self._answer = int(fields.type)

    def _send_item(self, seq: int, item: Any) -> None:
        self.send(
            "MISSION_ITEM_INT", seq=seq, frame=item.frame, command=item.command, autocontinue=item.autocontinue,
            param1=item.p1, param2=item.p2, param3=item.p3, param4=item.p4, x=item.x, y=item.y, z=item.z,
        )  # fmt: skip
