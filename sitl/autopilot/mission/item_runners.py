# SPDX-License-Identifier: BSD-3-Clause
"""What a firmware's missions may hold and how each item is run; ``mission`` of each firmware fills it in."""

from __future__ import annotations

import math
from abc import ABC, abstractmethod
from typing import Any, Generic, TypeVar

from ...core.mavlink import MavCmd, MavSeverity
from ..fence.checks import ALL, switch_by_user
from ..fence.state import names
from ..navigation.planner import Planner
from ..navigation.state import CONDITION_DELAY, CONDITION_DISTANCE
from ..notes import Text
from ..state import Vehicle
from . import item as commands
from .item import UNREPORTED, MissionItem
from .location import set_home
from .notes import Note, OutputItem

V = TypeVar("V", bound=Vehicle)


class Commands(ABC, Generic[V]):
    """The commands of a firmware's missions. All state is in the record ``v`` of the vehicle."""

    auto: int
    """Number of the mode that runs missions."""
    auto_return = -1
    """Number that AUTO is shown under while it flies the mission's way back."""
    taken: frozenset[int]
    """MAV_CMDs that it carries out; others of ``item.STORED`` are stored and passed over."""
    said_invalid: frozenset[int] = frozenset()
    """Of ``taken``, those of which ArduPilot says all the same that it skips them."""
    planner: Planner[Any]
    """Plans the legs of missions and of modes."""
    goes_on_disarmed = False
    """Disarming in AUTO leaves the mission where it is; else, and in other modes, it goes back to its start."""

    @abstractmethod
    def enter(self, v: V) -> None:
        """AUTO was entered: limits that an earlier mission set and its legs are forgotten."""

    @abstractmethod
    def reset(self, v: V) -> None:
        """The mission starts again from its first item: legs are forgotten."""

    @abstractmethod
    def give(self, v: V, seq: int, item: MissionItem) -> list[Note]:
        """Make a navigation command the one under way (``navigation.state``: ``command_*``), with the legs it needs."""

    @abstractmethod
    def look_ahead(self, v: V, item: MissionItem | None, after: MissionItem | None) -> None:
        """The two navigation commands after the one under way, None at the end: plan what is joined without a stop."""

    def arrived(self, v: V, seq: int, item: MissionItem) -> list[Note]:
        """The command under way has come to its location and waits there (COMMAND_ARRIVED)."""
        return []

    def completed(self, v: V, seq: int, item: MissionItem) -> list[Note]:
        """The command under way is done."""
        return []

    @abstractmethod
    def finish(self, v: V) -> list[Note]:
        """The mission has come to its end."""

    def run(self, v: V, item: MissionItem) -> list[Note]:
        """Run a do-command, or start a condition: then ``nav.condition_kind`` is not zero until it is met."""
        nav = v.autopilot.modes.nav
        if item.command == MavCmd.CONDITION_DELAY:
            nav.condition_kind = CONDITION_DELAY
            nav.condition_until_us = v.time_us + round(min(max(item.p1, 0.0), 1e9) * 1e6)
        elif item.command == MavCmd.CONDITION_DISTANCE:
            nav.condition_kind = CONDITION_DISTANCE
            nav.condition_distance = item.p1
        elif item.command == MavCmd.DO_SET_HOME:
            set_home(v.autopilot, item)
        elif item.command == MavCmd.DO_FENCE_ENABLE:
            return _enable_fence(v, item.p1 == 1.0)
        elif item.command == MavCmd.DO_SET_RESUME_REPEAT_DIST:  # taken, and no way is gone back
            return [Text(MavSeverity.INFO, f"Resume repeat dist set to {int(item.p1)} m")]
        elif item.command in commands.CARRIED_OUT:
            return [OutputItem(item)]
        return []

    def skips(self, item: MissionItem) -> bool:
        """Whether it says of a do-command that it skips it."""
        return item.command in self.said_invalid or not (item.command in self.taken or item.command in UNREPORTED)

    @abstractmethod
    def change_speed(self, v: V, kind: int, speed: float) -> bool:
        """DO_CHANGE_SPEED (SPEED_TYPE, m/s); whether it was taken."""


def _enable_fence(v: Vehicle, on: bool) -> list[Note]:
    """DO_FENCE_ENABLE: all fences of FENCE_TYPE, or none."""
    ap = v.autopilot
    before = ap.fence.on
    switch_by_user(ap.fence, on, ALL, ap.params.FENCE, ap.events, v.time_us)
    changed = before ^ ap.fence.on
    return [Text(MavSeverity.NOTICE, f"{names(changed)} {'enabled' if on else 'disabled'}")] if changed else []


def whole_seconds(item: MissionItem) -> float:
    """The delay in parameter 1 as ArduPilot stores it [s]."""
    return float(int(min(max(item.p1, 0.0), 65535.0)))


def turns(item: MissionItem) -> float:
    """Circles of LOITER_TURNS as ArduPilot stores them: whole ones, or a part of one."""
    return float(int(item.p1)) if item.p1 >= 1.0 else max(item.p1, 0.0)


def is_speed(speed: float) -> bool:
    """Whether a limit [m/s] can be set to it."""
    return 0.0 < speed < math.inf
