# SPDX-License-Identifier: BSD-3-Clause
"""Which clients' links have faults, and which faults."""

from __future__ import annotations

from ..core.constants import NEVER
from .channel import Channel
from .links.faults import TO_CLIENT, TO_VEHICLE, LinkFaults
from .links.faulty_way import NONE, FaultyWay, Ways
from .links.link import Link


class FaultyLinks:
    """The links of one vehicle that have faults; logs have none."""

    def __init__(self) -> None:
        self.are_on = False
        """Whether any client's link has some, or has frames under way since it had some."""
        self._of_all: LinkFaults | None = None
        self._of: dict[Link, LinkFaults | None] = {}

    def set(self, faults: LinkFaults | None, link: Link | None) -> None:
        """Faults of one link, or of all, later ones too; None: none. ``follow`` tells the clients' links."""
        if link is None:
            self._of_all = faults
            self._of.clear()
        else:
            self._of[link] = faults

    def forget(self, link: Link) -> None:
        """It is closed."""
        self._of.pop(link, None)

    def of(self, channel: Channel) -> LinkFaults | None:
        """Of this client's link, as they should be."""
        if channel.peer.is_log:
            return None
        return next((faults for link, faults in self._of.items() if channel.peer in link.peers), self._of_all)

    def follow(self, channel: Channel, stands: bool) -> None:
        """Give a client's link the faults that it should have.

        Args:
            channel: the client.
            stands: time stands until clients push it.
        """
        self.give(channel, self.of(channel), stands)

    @staticmethod
    def give(channel: Channel, faults: LinkFaults | None, stands: bool = False) -> None:
        """Give a client's link faults; frames under way arrive as they would have."""
        peer = channel.peer
        if faults is not None and peer.ways is None:
            peer.ways = Ways(FaultyWay(faults, 2 * channel.number), FaultyWay(faults, 2 * channel.number + 1))
            peer.ways.hold(stands)
        if peer.ways is not None:
            for way, direction in zip(peer.ways, (TO_VEHICLE, TO_CLIENT)):
                way.faults = faults if faults is not None and faults.acts(direction) else NONE

    def look(self, channels: list[Channel]) -> None:
        """Notice which links have faults; one that has none any more, and nothing under way, is as it was before."""
        for channel in channels:
            ways = channel.peer.ways
            if ways is not None and all(way.is_idle for way in ways):
                channel.peer.ways = None
        self.are_on = any(channel.peer.ways is not None for channel in channels)

    @staticmethod
    def due_us(channels: list[Channel]) -> int:
        """When the next frame arrives, simulated time since the start [us]."""
        return min((channel.peer.ways.due_us for channel in channels if channel.peer.ways is not None), default=NEVER)
