# SPDX-License-Identifier: BSD-3-Clause
"""The winch (WINCH_*, copters): servo outputs of function 88 wind its line, whose length is counted from them."""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import NamedTuple

from ...autopilot import payload
from ...autopilot.aux_switch import HIGH
from ...autopilot.mission.item import MissionItem
from ...core.mavlink import MavResult, MavSeverity
from ..dialect import message
from ..host import Host
from .payload import PayloadService
from .statustext import StatusTextService

STATUS = message("WINCH_STATUS")
HEALTHY = 1
"""MAV_WINCH_STATUS_HEALTHY"""
RELAXED, LENGTH_CONTROL, RATE_CONTROL = 0, 1, 2
"""WINCH_ACTIONS"""
EVERY_US = 20_000
UNKNOWN = 32767
"""WINCH_STATUS.temperature"""


class State(NamedTuple):
    """What it does."""

    action: int = RELAXED
    wanted: float = 0.0
    """Length [m], or rate [m/s] out."""
    length: float = 0.0
    """Line that is out [m]."""
    rate: float = 0.0


class WinchService(PayloadService):
    """The winch."""

    def __init__(self, bridge: Host) -> None:
        super().__init__(bridge)
        self._there = self._value("WINCH_TYPE") == payload.BY_SERVO
        self._state = State()

    def messages(self) -> dict[str, Callable[[], bytes]]:
        return {STATUS.name: self.status} if self._there else {}

    def status(self) -> bytes:
        """WINCH_STATUS: length of the line [m], its rate [m/s]; with WINCH_TYPE at boot."""
        unknown = math.nan
        return STATUS.payload(
            time_usec=self.bridge.now_us, line_length=self._state.length, speed=self._state.rate, tension=unknown,
            voltage=unknown, current=unknown, temperature=UNKNOWN, status=HEALTHY,
        )  # fmt: skip

    def carry_out(self, item: MissionItem) -> None:
        """A mission's DO_WINCH."""
        self.act(item.p2, item.p3, item.p4)

    def act(self, action: float, length: float, rate: float) -> int:
        """WINCH_ACTIONS: 0 relax, 1 more line by ``length`` [m] (less below 0), 2 wind at ``rate`` [m/s]."""
        if not self._there:
            return MavResult.FAILED
        if action == RELAXED:
            self.relax()
        elif action == LENGTH_CONTROL and abs(length) <= UNKNOWN:
            to = self._state.length + length
            verb = "lowering" if length > 0.0 else "raising"
            text = f"Winch: {verb} {abs(length):4.1f}m to {to:4.1f}m"
            self.bridge.get(StatusTextService).say(MavSeverity.INFO, text)
            self._start(LENGTH_CONTROL, to)
        elif action == RATE_CONTROL:
            self.wind(rate)
        else:
            return MavResult.FAILED
        return MavResult.ACCEPTED

    def relax(self) -> None:
        """Let the line go."""
        if self._there:
            self._state = self._state._replace(action=RELAXED, rate=0.0)
            self._send(payload.WINCH, 0)

    def wind(self, rate: float) -> None:
        """Wind at a rate [m/s] out, at most WINCH_RATE_MAX."""
        if self._there:
            most = self._most()
            self._start(RATE_CONTROL, min(max(rate, -most), most))

    def enable(self, position: int) -> None:
        """Function 44 of a switch: high holds the line, else it is let go."""
        if position == HIGH:
            self.wind(0.0)
        else:
            self.relax()

    def control(self, position: int) -> None:
        """Function 45 of a switch: high lowers, low raises, at WINCH_RATE_MAX."""
        self.wind((position - 2) * self._most())

    def _most(self) -> float:
        return max(self._values["WINCH_RATE_MAX"], 0.0)

    def _start(self, action: int, wanted: float) -> None:
        self._state = self._state._replace(action=action, wanted=wanted)
        self.due_us = min(self.due_us, self.bridge.now_us + EVERY_US)

    def service(self, now_us: int) -> None:
        self.due_us = now_us + EVERY_US
        state, most = self._state, self._most()
        if state.action == RELAXED:
            return
        rate = state.wanted
        if state.action == LENGTH_CONTROL:
            rate = min(max((state.wanted - state.length) * self._values["WINCH_POS_P"], -most), most)
        self._state = state._replace(rate=rate, length=state.length + rate * EVERY_US * 1e-6)
        self._send_share(payload.WINCH, 0.5 + 0.5 * (rate / most if most > 0.0 else 0.0))
