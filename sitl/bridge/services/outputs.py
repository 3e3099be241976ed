# SPDX-License-Identifier: BSD-3-Clause
"""Servo outputs and relays for commands and missions: set, or switched to and fro (DO_REPEAT_SERVO, DO_REPEAT_RELAY).

One thing repeats at a time, as in ArduPilot; setting that output or relay ends it.
"""

from __future__ import annotations

from typing import Any, NamedTuple

from ...autopilot import relays
from ...autopilot.mission.item import MissionItem
from ...core.constants import NEVER
from ...core.mavlink import MavCmd, MavSeverity
from ..autopilot_api import LONGEST_US
from ..host import Host
from .service import Service
from .statustext import StatusTextService

SHORTEST_US = 20_000
"""ArduPilot looks 50 times a second."""
OFF, ON = 0.0, 1.0
FREE = 0
"""SERVOn_FUNCTION of an output that has none."""


class Repeat(NamedTuple):
    """What goes to and fro."""

    is_relay: bool
    number: int
    """Output from 1, or relay from 0."""
    pulse: int
    rest: int
    """Pulse in between [us]."""
    left: int
    """Steps to go; below 0: for ever."""
    half_us: int


class OutputService(Service):
    """Servo outputs and relays."""

    def __init__(self, bridge: Host) -> None:
        super().__init__(bridge)
        self._values = bridge.vehicle.parameters
        self._repeat: Repeat | None = None
        relays.power_on(self._values)

    def snapshot(self) -> Any:
        return (None if self._repeat is None else tuple(self._repeat), self.due_us)

    def restore(self, state: Any) -> None:
        repeat, self.due_us = state
        self._repeat = None if repeat is None else Repeat(*repeat)

    def carry_out(self, item: MissionItem) -> None:
        """A mission's DO_SET_SERVO, DO_REPEAT_SERVO, DO_SET_RELAY or DO_REPEAT_RELAY."""
        if item.command == MavCmd.DO_SET_SERVO:
            self.set_servo(int(item.p1), int(item.p2))
        elif item.command == MavCmd.DO_REPEAT_SERVO:
            self.repeat_servo(int(item.p1), int(item.p2), int(item.p3), item.p4)
        elif item.command == MavCmd.DO_SET_RELAY:
            self.set_relay(int(item.p1), item.p2)
        else:
            self.repeat_relay(int(item.p1), int(item.p2), item.p3)

    def set_servo(self, number: int, pulse: int) -> bool:
        """A pulse [us] (0: none) on output ``number``, from 1; whether it can be: a function may have the output."""
        if not 0 <= pulse <= LONGEST_US:
            return False
        if not self._is_free(number) or not self.bridge.autopilot.set_servo(number, pulse):
            if number > 0:
                text = f"ServoRelayEvent: Channel {number} is already in use"
                self.bridge.get(StatusTextService).say(MavSeverity.WARNING, text)
            return False
        self._end(False, number)
        return True

    def _is_free(self, number: int) -> bool:
        name = f"SERVO{number}_FUNCTION"
        return name in self._values.table and self._values[name] == FREE

    def repeat_servo(self, number: int, pulse: int, count: int, period: float) -> bool:
        """``pulse`` and SERVOn_TRIM [us] by turns, ``count`` times in all (below 0: for ever), each ``period`` [s]."""
        if not self.set_servo(number, pulse if count != 0 else self._pulse_of(number)):
            return False
        rest = int(self._values[f"SERVO{number}_TRIM"])
        self._start(Repeat(False, number, pulse, rest, 2 * count, _half_us(period)))
        return True

    def _pulse_of(self, number: int) -> int:
        pulses = self.bridge.vehicle.v.actuators.pwm
        return int(pulses[number - 1]) if 0 < number <= len(pulses) else 0  # no such output is refused later

    def set_relay(self, relay: int, state: float) -> bool:
        """Switch a relay, from 0, off (0), on (1) or over (any other); whether there is one."""
        if not relays.is_fitted(self._values, relay):
            return False
        self._end(True, relay)
        over = not relays.is_on(self._values, relay)
        relays.switch(self._values, relay, state == ON if state in (OFF, ON) else over)
        return True

    def repeat_relay(self, relay: int, count: int, period: float) -> bool:
        """Switch a relay over and back, ``count`` times (below 0: for ever), each ``period`` [s]."""
        if not relays.is_fitted(self._values, relay):
            return False
        self._start(Repeat(True, relay, 0, 0, 2 * count, _half_us(period)))
        return True

    def _end(self, is_relay: bool, number: int) -> None:
        if self._repeat is not None and self._repeat[:2] == (is_relay, number):
            self._repeat, self.due_us = None, NEVER

    def _start(self, repeat: Repeat) -> None:
        self._repeat = repeat
        self.service(self.bridge.now_us)

    def service(self, now_us: int) -> None:
        repeat = self._repeat
        if repeat is None or repeat.left == 0:
            self._repeat, self.due_us = None, NEVER
            return
        if repeat.is_relay:
            relays.switch(self._values, repeat.number, not relays.is_on(self._values, repeat.number))
        else:
            self.bridge.autopilot.set_servo(repeat.number, repeat.rest if repeat.left % 2 else repeat.pulse)
        left = repeat.left - 1 if repeat.left > 0 else -1 - repeat.left % 2
        self._repeat, self.due_us = repeat._replace(left=left), now_us + repeat.half_us


def _half_us(period: float) -> int:
    """Half of a period [s] that a client gave."""
    return max(round(min(max(period, 0.0), 1e6) * 5e5), SHORTEST_US)
