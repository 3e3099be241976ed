# SPDX-License-Identifier: BSD-3-Clause
"""Which clients' links have faults, and which faults."""

from __future__ import annotations

from ..core.constants import NEVER
from .channel import Channel
from .links.faults import TO_CLIENT, TO_VEHICLE, LinkFaults
from .links.faulty_direction import NONE, Directions, FaultyDirection
from .links.link import Link


class FaultyLinks:
    """The links of one vehicle that have faults; logs have none."""

    def __init__(self) -> None:
        self.are_on = False
        """Whether any client's link has some, or has frames in flight since it had some."""
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
        """Give a client's link faults; frames in flight arrive as they would have."""
        peer = channel.peer
        if faults is not None and peer.directions is None:
            peer.directions = Directions(
                FaultyDirection(faults, 2 * channel.number), FaultyDirection(faults, 2 * channel.number + 1)
            )
            peer.directions.hold(stands)
        if peer.directions is not None:
            for direction, number in zip(peer.directions, (TO_VEHICLE, TO_CLIENT)):
                direction.faults = faults if faults is not None and faults.acts(number) else NONE

    def look(self, channels: list[Channel]) -> None:
        """Notice which links have faults; one that has none any more, and nothing in flight, is as it was before."""
        for channel in channels:
            directions = channel.peer.directions
            if directions is not None and all(direction.is_idle for direction in directions):
                channel.peer.directions = None
        self.are_on = any(channel.peer.directions is not None for channel in channels)

    @staticmethod
    def due_us(channels: list[Channel]) -> int:
        """When the next frame arrives, simulated time since the start [us]."""
        return min(
            (channel.peer.directions.due_us for channel in channels if channel.peer.directions is not None),
            default=NEVER,
        )
