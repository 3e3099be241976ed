# SPDX-License-Identifier: BSD-3-Clause
"""What a MAVLink microservice is, and the results that it gives."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any, ClassVar

from ...core.constants import NEVER
from ..channel import Channel
from ..host import Host
from ..listener import Sender

Handler = Callable[[Channel, Any, Sender], None]
"""``handler(channel, message, sender)``; the message is a named tuple with MAVLink's field names."""


class Service:
    """Base of all services; each overrides what it needs."""

    due_us = NEVER
    """When ``service`` wants to be called [simulated us since boot]; each service keeps its own."""

    def __init__(self, bridge: Host) -> None:
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


class StatefulService(Service):
    """A service whose snapshot is some of its attributes: plain values, or tuples with or without names."""

    kept: ClassVar[tuple[str, ...]] = ("_state", "due_us")
    """Their names."""

    def snapshot(self) -> Any:
        held = [getattr(self, name) for name in self.kept]
        return tuple(tuple(value) if isinstance(value, tuple) else value for value in held)

    def restore(self, state: Any) -> None:
        for name, value in zip(self.kept, state, strict=True):
            make = getattr(getattr(self, name), "_make", None)
            setattr(self, name, value if make is None else make(value))
