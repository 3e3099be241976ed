# SPDX-License-Identifier: BSD-3-Clause
"""One mission upload under way."""

from __future__ import annotations

from typing import Any

from ...autopilot.mission.item import MissionItem
from ..channel import Channel
from .service import Sender

TIMEOUT_US = 8_000_000
"""Without an item for so long [simulated us] the upload is given up (ArduPilot's figure)."""
ASK_AGAIN_US = 1_000_000


class Upload:
    """Items ``first`` .. ``stop - 1``, collected in order; ``base`` is what a partial write goes into."""

    def __init__(
        self,
        channel: Channel,
        sender: Sender,
        first: int,
        stop: int,
        base: tuple[MissionItem, ...],
        now_us: int,
    ) -> None:
        self.channel = channel
        self.sender = sender
        self.first = first
        self.stop = stop
        self.next = first
        self.deadline_us = now_us + TIMEOUT_US
        self._ask_us = now_us + ASK_AGAIN_US
        self._base = base
        self._items: list[MissionItem] = []

    def snapshot(self) -> tuple[Any, ...]:
        """Immutable; begins with the channel's number."""
        times = (self.deadline_us, self._ask_us)
        return (self.channel.number, self.sender, self.first, self.stop, self._base, tuple(self._items), *times)

    @classmethod
    def restored(cls, state: tuple[Any, ...], channel: Channel) -> Upload:
        """The upload as it was."""
        _, sender, first, stop, base, items, deadline_us, ask_us = state
        upload = cls(channel, sender, first, stop, base, 0)
        upload._items, upload.next = list(items), first + len(items)
        upload.deadline_us, upload._ask_us = deadline_us, ask_us
        return upload

    @property
    def due_us(self) -> int:
        """When to ask again or to give up."""
        return min(self._ask_us, self.deadline_us)

    @property
    def complete(self) -> bool:
        """All items are there."""
        return self.next == self.stop

    def asked(self, now_us: int) -> None:
        """The next item was asked for."""
        self._ask_us = now_us + ASK_AGAIN_US

    def add(self, item: MissionItem, now_us: int) -> None:
        """The item asked for has come."""
        self._items.append(item)
        self.next += 1
        self.deadline_us = now_us + TIMEOUT_US

    def merged(self) -> tuple[MissionItem, ...]:
        """The whole mission as it becomes."""
        return (*self._base[: self.first], *self._items, *self._base[self.stop :])
