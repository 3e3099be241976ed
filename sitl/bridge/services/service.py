# SPDX-License-Identifier: BSD-3-Clause
"""What a MAVLink microservice is, who listens to it, and the results that it gives."""

from __future__ import annotations

from collections.abc import Callable
from typing import TYPE_CHECKING, Any, Protocol

from ...core.constants import NEVER
from ..channel import Channel

if TYPE_CHECKING:
    from ..bridge import Bridge


Sender = tuple[int, int]
"""(system id, component id) of who sent a message."""
Handler = Callable[[Channel, Any, Sender], None]
"""``handler(channel, message, sender)``; the message is a named tuple with MAVLink's field names."""


class Service:
    """Base of all services; each overrides what it needs."""

    due_us = NEVER
    """When ``service`` wants to be called [simulated us since boot]; each service keeps its own."""

    def __init__(self, bridge: Bridge) -> None:
        self.bridge = bridge

    def handlers(self) -> dict[str, Handler]:
        """Messages that this service acts on, by name. Messages for other systems do not arrive here."""
        return {}

    def messages(self) -> dict[str, Callable[[], bytes]]:
        """Telemetry that it builds, by name: functions that give the payload now."""
        return {}

    def channel_added(self, channel: Channel) -> None:
        """A client appeared."""

    def channel_removed(self, channel: Channel) -> None:
        """A client went away."""

    def parameter_changed(self, name: str) -> None:
        """A parameter was set, over MAVLink or by another service."""

    def arming_changed(self) -> None:
        """The vehicle was armed or disarmed."""

    def service(self, now_us: int) -> None:
        """Called at or after ``due_us``."""

    def snapshot(self) -> Any:
        """What it needs to go on from here: plain tuples, numbers, texts and bytes, channels
        by their number. Both or none are overridden."""

    def restore(self, state: Any) -> None:
        """Go on from a snapshot. The record has been put back already."""


class Listener(Protocol):
    """Hears of texts, parameters, commands and progress when they happen; it changes nothing."""

    def said(self, severity: int, text: str) -> None:
        """A text goes out to all clients, with its MAV_SEVERITY."""
        ...

    def parameter_set(self, name: str) -> None:
        """A client has set a parameter; the record has the new value."""
        ...

    def reached(self, seq: int) -> None:
        """A mission item was reached (MISSION_ITEM_REACHED)."""
        ...

    def commanded(self, fields: Any, frame: int, is_place: bool, sender: Sender, result: int) -> None:
        """A COMMAND_LONG or COMMAND_INT was answered.

        Args:
            fields: of the message.
            frame, is_place: of a COMMAND_LONG: the MAV_FRAME that it is taken in, whether p5 and p6 are degrees.
            sender: its system and component.
            result: MAV_RESULT.
        """
        ...


ACCEPTED, TEMPORARILY_REJECTED, DENIED, UNSUPPORTED, FAILED = range(5)
EMERGENCY = 0
CRITICAL, ERROR, WARNING, NOTICE, INFO, DEBUG = range(2, 8)
