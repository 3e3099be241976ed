# SPDX-License-Identifier: BSD-3-Clause
"""What a connection itself must know of the vehicle: who it is, its clock, its answers."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

from ..bridge.dialect import MessageType, message
from ..bridge.frame import Splitter

HEARTBEAT, ACK, TEXT, PARAMETER = (message(name) for name in ("HEARTBEAT", "COMMAND_ACK", "STATUSTEXT", "PARAM_VALUE"))
AUTOPILOT = 1
"""MAV_COMP_ID_AUTOPILOT1: messages of other components do not count."""
IN_PROGRESS = 5
"""MAV_RESULT of a command whose last answer is still to come."""
KEPT_TEXTS = 10


class Inbox:
    """Takes bytes from the vehicle apart and passes each message on.

    Args:
        on_message: gets the name and the fields of each message.
    """

    def __init__(self, on_message: Callable[[str, Any], None] = lambda name, fields: None) -> None:
        self.on_message = on_message
        self.system = 0
        """MAVLink id of the vehicle; 0 before it was heard."""
        self.acks: dict[int, Any] = {}
        """The last COMMAND_ACK of each command."""
        self.parameters: dict[str, float] = {}
        """Values as they were sent last."""
        self.last_texts: list[str] = []
        """The last status texts, newest last."""
        self.count = 0
        """Messages so far that a vehicle whose time stands does not send: all but HEARTBEAT and texts."""
        self.boots = 0
        """How often the vehicle's clock has gone back."""
        self._time_ms = self._before_boot_ms = 0
        self._splitter = Splitter()

    @property
    def time_ms(self) -> int:
        """The vehicle's clock, from ``time_boot_ms`` of what it sends [ms]; a reboot does not set it back."""
        return self._before_boot_ms + self._time_ms

    def feed(self, data: bytes) -> None:
        """Take bytes from the vehicle, in any pieces."""
        for kind, payload, _, system, component, _, _ in self._splitter.feed(data):
            if component == AUTOPILOT and system == (self.system or system):
                fields = kind.decode(payload)
                self._note(kind, fields, system)
                self.on_message(kind.name, fields)

    def _note(self, kind: MessageType, fields: Any, system: int) -> None:
        if kind is TEXT:
            self.last_texts = [*self.last_texts[1 - KEPT_TEXTS :], fields.text.decode("ascii", "replace")]
        elif kind is HEARTBEAT:
            self.system = system
        else:
            self.count += 1
            if kind is ACK:
                self.system = system
                if fields.result != IN_PROGRESS:
                    self.acks[int(fields.command)] = fields
            elif kind is PARAMETER:
                self.parameters[fields.param_id.decode("ascii", "replace")] = float(fields.param_value)
            elif hasattr(fields, "time_boot_ms"):
                self._tick(int(fields.time_boot_ms))

    def _tick(self, time_ms: int) -> None:
        if time_ms < self._time_ms - 1000:  # more than an old message that comes late
            self.boots += 1
            self._before_boot_ms += self._time_ms
            self._time_ms = time_ms
        self._time_ms = max(time_ms, self._time_ms)
