# SPDX-License-Identifier: BSD-3-Clause
"""The sprayer (SPRAY_*): a pump that follows the speed over the ground, and a spinner, on servo outputs."""

from __future__ import annotations

from typing import NamedTuple

from sitl.core.elementary import hypot

from ...autopilot import payload
from ...autopilot.mission.item import MissionItem
from ..host import Host
from .payload import PayloadService

EVERY_US = 333_333
"""ArduPilot looks three times a second."""
STARTS_US, STOPS_US = 100_000, 1_000_000
"""So long it has to be fast enough, or too slow."""
TEST_SPEED = 1.0
"""Speed that a test stands for [m/s]."""


class State(NamedTuple):
    """What it does. Times since boot [us]."""

    runs: bool = False
    is_test: bool = False
    sprays: bool = False
    changed_us: int = 0
    """When it was first fast enough to spray, or too slow; 0: it does what the speed says."""


class SprayerService(PayloadService):
    """The sprayer."""

    def __init__(self, bridge: Host) -> None:
        super().__init__(bridge)
        self._there = self._value("SPRAY_ENABLE") != 0.0
        self._state = State()

    def carry_out(self, item: MissionItem) -> None:
        """A mission's DO_SPRAYER."""
        self.act(item.p1)

    def act(self, action: float) -> None:
        """1 sprays when the vehicle is fast enough, 0 ends it; others do nothing."""
        if action in (0.0, 1.0):
            self.run(action == 1.0, False)

    def run(self, on: bool, is_test: bool) -> None:
        """Spray when the vehicle is fast enough; ``is_test``: at once, while it is not armed."""
        state = self._state
        if self._there and on | state.runs:
            tests = is_test and on and not self.bridge.autopilot.armed()
            self._state = State(on, tests, on and state.sprays, state.changed_us)
            self.due_us = min(self.due_us, self.bridge.now_us + EVERY_US)
            if not on:
                self._drive(0.0)

    def service(self, now_us: int) -> None:
        self.due_us = now_us + EVERY_US
        vel = self.bridge.vehicle.v.autopilot.estimate.vel
        speed = TEST_SPEED if self._state.is_test else hypot(vel.x, vel.y)
        self._decide(now_us, speed)
        self._drive(speed)

    def _decide(self, now_us: int, speed: float) -> None:
        """Begin to spray, or pause: a little after the speed says so."""
        state = self._state
        wanted = state.runs and (state.is_test or 100.0 * speed >= self._values["SPRAY_SPEED_MIN"])
        if wanted == state.sprays:
            self._state = state._replace(changed_us=0)
            return
        since = state.changed_us or now_us
        waits = 0 if state.is_test else STARTS_US if wanted else STOPS_US
        if now_us - since >= waits:
            self._state = state._replace(sprays=wanted, changed_us=0)
        else:
            self._state = state._replace(changed_us=since)

    def _drive(self, speed: float) -> None:
        if not self._state.sprays:
            self._send_share(payload.PUMP, 0.0)
            self._send_share(payload.SPINNER, 0.0)
            return
        percent = max(speed * self._values["SPRAY_PUMP_RATE"], self._values["SPRAY_PUMP_MIN"])
        self._send_share(payload.PUMP, 0.01 * percent)
        self._send(payload.SPINNER, self._values["SPRAY_SPINNER"])
