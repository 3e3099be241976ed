# SPDX-License-Identifier: BSD-3-Clause
"""Missions by the mission protocol: upload, start, download (https://mavlink.io/en/services/mission.html)."""

from __future__ import annotations

from collections.abc import Sequence
from functools import partial
from typing import Any

from ..autopilot.mission.item import MissionItem, home_item
from ..autopilot.mission.mission import RESULT_NAMES, Mission
from ..core.mavlink import MavFrame, MavMissionType
from . import px4
from .commands import arguments, command_number, entry_name
from .controls import Controls
from .errors import MissionRefusedError, WaitTimeoutError

__tracebackhide__ = True

SILENCE_S = 1.0
"""When nothing was asked for so long, what was sent last is sent again."""
AT_ONCE = 10
"""As many items are asked for together."""
LIMIT_S = 10.0
"""The next item is asked for, and the last one acknowledged, within."""


class Missions(Controls):
    """A vehicle that flies missions."""

    _upload: Sequence[MissionItem] = ()
    _last_item = -1
    """The last one that the vehicle asked for."""
    _list: int = MavMissionType.MISSION
    """Which list it goes to (MAV_MISSION_TYPE)."""
    _asked = 0
    """How often it has asked for one."""
    _result: int | None = None
    """MAV_MISSION_RESULT of the upload."""

    def item(
        self, name: str, north: float | None = None, east: float | None = None, altitude: float = 0.0, **named: Any
    ) -> MissionItem:
        """A mission item.

        Args:
            name: of its command, "NAV_WAYPOINT".
            north, east: its position from home [m]; None: none, or where the vehicle is then.
            altitude: above home [m].
            named: its other parameters, as for ``command``.
        """
        number = command_number(name)
        p1, p2, p3, p4, *_ = [*arguments(number, (), named), 0.0, 0.0, 0.0, 0.0]
        x, y = self.location_of(north, east) if north is not None and east is not None else (0, 0)
        return MissionItem(number, MavFrame.GLOBAL_RELATIVE_ALT, p1, p2, p3, p4, x, y, altitude)

    def upload(self, mission: Mission | Sequence[MissionItem]) -> Mission:
        """Upload a mission, home first; a home without a position becomes the vehicle's own.

        Raises:
            MissionRefusedError: the vehicle does not take it.
            WaitTimeoutError: the vehicle does not answer to the end.
        """
        mission = mission if isinstance(mission, Mission) else Mission(tuple(mission))
        items = mission.items
        if items and items[0].no_location:
            items = (home_item(*self.home()), *items[1:])
        self.telemetry.reached.clear()
        self.telemetry.items.clear()
        self.transfer(items)
        return mission

    def upload_fence(self, items: Sequence[MissionItem]) -> None:
        """Upload areas to stay in or out of, as NAV_FENCE items; none clears them.

        Raises:
            MissionRefusedError, WaitTimeoutError: as for ``upload``.
        """
        self.transfer(items, MavMissionType.FENCE)

    def upload_rally_points(self, items: Sequence[MissionItem]) -> None:
        """Upload positions to return to, as NAV_RALLY_POINT items; none clears them.

        Raises:
            MissionRefusedError, WaitTimeoutError: as for ``upload``.
        """
        self.transfer(items, MavMissionType.RALLY)

    def download(self) -> tuple[MissionItem, ...]:
        """The mission that the vehicle has, home first.

        Raises:
            WaitTimeoutError: the vehicle does not answer to the end.
        """
        counts: list[int] = []
        found: dict[int, MissionItem] = {}

        def ask_count(_: list[int] | None) -> int:
            self.send("MISSION_REQUEST_LIST")
            return 1

        def ask(which: list[int] | None) -> int:
            for seq in (which or ())[:AT_ONCE]:
                self.send("MISSION_REQUEST_INT", seq=seq)
            return min(len(which or ()), AT_ONCE)

        def take_count(m: Any) -> None:
            if m.mission_type == MavMissionType.MISSION:  # another client may ask for the fence
                counts.append(m.count)

        def take(m: Any) -> None:
            if m.mission_type == MavMissionType.MISSION:
                found[m.seq] = MissionItem(
                    m.command, m.frame, m.param1, m.param2, m.param3, m.param4, m.x, m.y, m.z, m.autocontinue
                )

        what = "the mission"
        self.collect("MISSION_COUNT", lambda: None if not counts else [], ask_count, take_count, what)
        self.collect("MISSION_ITEM_INT", lambda: [k for k in range(counts[0]) if k not in found], ask, take, what)
        self.send("MISSION_ACK")
        items = tuple(found[k] for k in range(counts[0]))
        return (home_item(*self.home()), *items) if items and self.telemetry.is_px4 else items

    def start_mission(self) -> None:
        """Arm if need be, AUTO, and begin with its first item."""
        if self.telemetry.is_px4:  # which begins when it is armed, and without a mission is not armed in this mode
            self.set_mode(px4.MISSION)
            if not self.armed:
                self.arm()
            return
        if not self.armed:
            self.set_mode("GUIDED")
            self.arm()
        self.set_mode("AUTO")
        if self.flies:
            self.command("MISSION_START", subject="the start of the mission")

    def transfer(self, items: Sequence[MissionItem], kind: int = MavMissionType.MISSION) -> None:
        """Send items as they are, a mission's with home first, by the mission protocol; ``kind``: MAV_MISSION_TYPE.

        Raises:
            MissionRefusedError, WaitTimeoutError: as for ``upload``.
        """
        if kind == MavMissionType.MISSION and self.telemetry.is_px4:
            items = px4.mission(items)
        begin = progress = self.now
        self._upload, self._list, self._last_item, self._result = items, kind, -1, None
        self.send("MISSION_COUNT", count=len(items), mission_type=kind)
        while self._result is None:
            before, item = self._asked, self._last_item
            goes_on = self.passes(partial(self._goes_on, before), SILENCE_S)
            if self._last_item > item:
                progress = self.now
            if goes_on:
                continue
            if self.now - progress >= LIMIT_S:
                last = f"item {self._last_item} was asked for" if self._last_item >= 0 else "no item was asked for"
                self.raise_error(WaitTimeoutError("MISSION_ACK", self.now - begin, last, begin))
            if self._last_item < 0:
                self.send("MISSION_COUNT", count=len(items), mission_type=kind)
            else:
                self._send_item(self._last_item)
        self._upload = ()
        if self._result:
            name = RESULT_NAMES.get(self._result) or entry_name("MAV_MISSION_RESULT", self._result)
            self.raise_error(MissionRefusedError(self._result, name, begin))

    def _goes_on(self, asked: int) -> bool:
        """Whether the vehicle has answered, or asked for an item, since it had asked so often."""
        return self._result is not None or self._asked != asked

    def _take(self, name: str, fields: Any) -> None:
        super()._take(name, fields)
        asks = name in ("MISSION_REQUEST", "MISSION_REQUEST_INT") and fields.mission_type == self._list
        if asks and fields.seq < len(self._upload):
            self._last_item, self._asked = int(fields.seq), self._asked + 1
            self._send_item(self._last_item)
        elif name == "MISSION_ACK" and fields.mission_type == self._list:
            self._result = int(fields.type)

    def _send_item(self, seq: int) -> None:
        item = self._upload[seq]
        self.send(
            "MISSION_ITEM_INT", seq=seq, frame=item.frame, command=item.command, autocontinue=item.autocontinue,
            param1=item.p1, param2=item.p2, param3=item.p3, param4=item.p4, x=item.x, y=item.y, z=item.z,
            mission_type=self._list,
        )  # fmt: skip
