# SPDX-License-Identifier: BSD-3-Clause
"""The gripper (GRIP_*): outputs of function 28 open and close it, by a servo or an electromagnet (EPM), which rests
meanwhile. Nothing is carried: it is told, not felt."""

from __future__ import annotations

from typing import NamedTuple

from ...autopilot import payload
from ...autopilot.mission.item import MissionItem
from ...core.constants import NEVER
from ...core.mavlink import MavResult, MavSeverity
from ..host import Host
from .payload import PayloadService
from .statustext import StatusTextService

RELEASE, GRAB = 0, 1
"""GRIPPER_ACTIONS"""
NEUTRAL = -1
"""It was not commanded to move since boot."""
MOVES_US = 500_000
"""So long it moves."""
TEXTS = {RELEASE: ("Gripper load releasing", "Gripper load released"),
         GRAB: ("Gripper load grabbing", "Gripper load grabbed")}  # fmt: skip
"""By action: when it begins, and when it is done."""
IN_MISSIONS = {RELEASE: "Gripper Released", GRAB: "Gripper Grabbed"}


class State(NamedTuple):
    """What it does. Times since boot [us]."""

    action: int = NEUTRAL
    done_us: int = 0
    is_done: bool = True
    released_us: int = 0
    """When it was told to open."""


class GripperService(PayloadService):
    """The gripper."""

    def __init__(self, bridge: Host) -> None:
        super().__init__(bridge)
        kind = self._value("GRIP_TYPE")
        self._is_magnet = kind == payload.BY_MAGNET
        self._there = self._value("GRIP_ENABLE") != 0.0 and kind in (payload.BY_SERVO, payload.BY_MAGNET)
        self._state = State()
        if self._there:
            self._send(payload.GRIPPER, self._values["GRIP_NEUTRAL"])
            self._report()

    @property
    def is_there(self) -> bool:
        """Whether there is one, and switched on."""
        return self._there and self._values["GRIP_ENABLE"] != 0.0

    def parameter_changed(self, name: str) -> None:
        if name == "GRIP_ENABLE":
            self._report()

    def _report(self) -> None:
        """Tell the autopilot, which waits for it where it places a load."""
        state = self._state
        self.bridge.autopilot.gripper_is(self.is_there, state.action == RELEASE and state.is_done)

    def carry_out(self, item: MissionItem) -> None:
        """A mission's DO_GRIPPER; it is reported as done even where there is no gripper."""
        action = int(item.p2)
        self.act(action)
        if action in IN_MISSIONS:
            self.bridge.get(StatusTextService).say(MavSeverity.INFO, IN_MISSIONS[action])

    def act(self, action: float) -> int:
        """RELEASE or GRAB, in whole numbers. Its MAV_RESULT."""
        if not self.is_there or not RELEASE <= action < GRAB + 1:
            return MavResult.FAILED
        if int(action) == GRAB:
            self.grab()
        else:
            self.release()
        return MavResult.ACCEPTED

    def grab(self) -> None:
        """Close it."""
        if self.is_there:
            self._move(GRAB, "GRIP_GRAB")

    def release(self) -> None:
        """Open it."""
        if self.is_there:
            self._move(RELEASE, "GRIP_RELEASE")

    def _move(self, action: int, pulse: str) -> None:
        say, now, state = self.bridge.get(StatusTextService).say, self.bridge.now_us, self._state
        self._send(payload.GRIPPER, self._values[pulse])
        if state.action == action and not self._is_magnet:
            if state.is_done:
                say(MavSeverity.INFO, TEXTS[action][1])
            return
        say(MavSeverity.INFO, TEXTS[action][0])
        self._state = State(action, now + MOVES_US, False, now if action == RELEASE else state.released_us)
        self.due_us = now + MOVES_US
        self._report()

    def service(self, now_us: int) -> None:
        state, self.due_us = self._state, NEVER
        if not state.is_done and now_us >= state.done_us:
            self._state = state._replace(is_done=True)
            self._report()
            if self._is_magnet:
                self._send(payload.GRIPPER, self._values["GRIP_NEUTRAL"])
            else:
                self.bridge.get(StatusTextService).say(MavSeverity.INFO, TEXTS[state.action][1])
        if self._is_magnet and self._state.action == GRAB and self._state.is_done:
            self._hold(now_us)
        if self._state.action == RELEASE and self._state.is_done:
            self._close_in_time(now_us)

    def _hold(self, now_us: int) -> None:
        """An electromagnet grabs again and again."""
        again_us = self._state.done_us - MOVES_US + round(max(self._values["GRIP_REGRAB"], 0.0) * 1e6)
        if self._values["GRIP_REGRAB"] > 0.0:
            if now_us >= again_us:
                self.grab()
            else:
                self.due_us = again_us

    def _close_in_time(self, now_us: int) -> None:
        wait_us = round(min(max(self._values["GRIP_AUTOCLOSE"], 0.0), 1e6) * 1e6)
        if wait_us > 0 and self._state.released_us > 0:
            if now_us >= self._state.released_us + wait_us:
                self.grab()
            else:
                self.due_us = self._state.released_us + wait_us
