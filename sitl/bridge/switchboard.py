# SPDX-License-Identifier: BSD-3-Clause
"""All links and the clients on them: who is there, what came in, what goes out."""

from __future__ import annotations

import selectors
from collections import deque
from collections.abc import Callable, Mapping
from typing import Protocol

from .channel import Channel, Ports
from .faulty_links import FaultyLinks
from .links.link import Link, Peer

MAX_NOTES = 1000


class Tap(Protocol):
    """Sees every frame of every channel (a telemetry log)."""

    def frame(self, time_us: int, raw: bytes) -> None:
        """One frame, sent or received at simulated ``time_us`` since the start of the simulation."""
        ...


class Signer(Protocol):
    """Signs frames on their way out."""

    @property
    def is_on(self) -> bool:
        """Whether there is a key."""
        ...

    def concerns(self, channel: Channel) -> bool:
        """Whether frames to this client are signed."""
        ...

    def sent(self, channel: Channel, frames: list[bytes]) -> list[bytes]:
        """The frames, signed."""
        ...


class Journal(Protocol):
    """Is notified of everything that comes to the vehicle from outside, and of what goes out (a recording).

    Channels are told by their numbers, which no other channel of the run has, links by their position in the order in
    which they were added.
    """

    def link_added(self, link: Link) -> None:
        """A link for clients to reach the vehicle; its peers follow."""

    def link_removed(self, link: Link) -> None:
        """It is closed; its peers leave."""

    def came(self, channel: Channel) -> None:
        """A client appeared."""

    def left(self, channel: Channel) -> None:
        """It is gone."""

    def received(self, channel: Channel, data: bytes) -> None:
        """Bytes that the client sent, read now."""

    def acted(self) -> None:
        """All that was received has been acted on."""

    def sent(self, channel: Channel, frames: list[bytes]) -> None:
        """Frames on their way to the client."""

    def flushed(self, channel: Channel) -> None:
        """They were handed to its link."""

    def streams(self, link: Link, rates_hz: Mapping[str, int]) -> None:
        """Stream groups were asked for by this program for every client of a link."""

    def arrived(self) -> None:
        """Time stands, and all that was due has been sent."""

    def attended(self) -> None:
        """What clients asked for is being followed up: the vehicle is about to go on, even if only by no time."""

    def beat(self) -> None:
        """A HEARTBEAT went out while time stood."""

    def lockstep(self, on: bool) -> None:
        """From now on clients push the clock, or do so no more."""

    def answered(self) -> None:
        """Grants whose time has been reached are being answered."""

    def logs(self) -> None:
        """The vehicle keeps on-board logs from now on."""

    def failed(self, text: str) -> None:
        """A fault was ordered, or ("-" and a unit) repaired, by this program."""

    def restored(self) -> None:
        """The vehicle was put back to a snapshot."""

    def close(self) -> None:
        """The run ends; called once or more."""


class Switchboard:
    """Makes a channel of every peer that appears on a link, and forgets it when the peer is gone."""

    def __init__(
        self,
        system: Callable[[], int],
        clock: Callable[[], int],
        added: Callable[[Channel], None],
        removed: Callable[[Channel], None],
    ) -> None:
        self.links: list[Link] = []
        self.channels: list[Channel] = []
        self.logs: list[Channel] = []
        """Those of the channels that get what the others are answered."""
        self.ports = Ports()
        self.received = 0
        """How often clients have said something."""
        self.dropped: deque[str] = deque(maxlen=MAX_NOTES)
        """Why channels were lost or refused, for people; the oldest are forgotten where nobody takes them."""
        self.taps: list[Tap] = []
        self.client_taps: list[Tap] = []
        """See only what clients sent."""
        self.journal: Journal | None = None
        self.signer: Signer | None = None
        self.faults = FaultyLinks()
        self._system, self._clock, self._added, self._removed = system, clock, added, removed
        self._selector = selectors.DefaultSelector()
        self._sockets = 0
        self._has_spools = False
        self._numbers = 0
        self._kept: dict[Peer, int] = {}
        """Numbers of channels of before a reboot."""

    def take_over(self, old: Switchboard) -> None:
        """Links, clients, sockets and taps of ``old``, which must not be used any more."""
        self._selector.close()
        self.links, self.dropped = old.links, old.dropped
        self.taps, self.client_taps = old.taps, old.client_taps
        self.journal, self.received, self.faults = old.journal, old.received, old.faults
        self._selector, self._sockets = old._selector, old._sockets
        self._numbers, self._kept = old._numbers, {channel.peer: channel.number for channel in old.channels}
        for link in self.links:
            link.reattach(self._add_channel)

    def is_watched(self) -> bool:
        """Whether every frame that goes out has to be seen by someone, signed, or sent over a link with faults."""
        signs = self.signer is not None and self.signer.is_on
        return signs or self.faults.are_on or bool(self.taps) or self.journal is not None

    def add_link(self, link: Link) -> None:
        """Open a link for clients to reach the vehicle."""
        self.links.append(link)
        if self.journal is not None:
            self.journal.link_added(link)
        link.attach(self._selector, self._add_channel)
        self._sockets = len(self._selector.get_map())

    def remove_link(self, link: Link) -> None:
        """Close a link and forget its clients."""
        if self.journal is not None:
            self.journal.link_removed(link)
        link.close()
        self.links.remove(link)
        self.faults.forget(link)
        self._forget_closed()
        self._sockets = len(self._selector.get_map())

    def _add_channel(self, peer: Peer) -> None:
        is_new = peer not in self._kept
        number = self._kept.pop(peer, self._numbers)
        self._numbers = max(self._numbers, number + 1)
        channel = Channel(peer, number, self._system(), self.is_watched, self.logs)
        self.channels.append(channel)
        if peer.is_log:
            self.logs.append(channel)
        self._has_spools = self._has_spools or channel.spool is not None
        self.ports.arrange(self.channels)
        if self.journal is not None and is_new:
            self.journal.came(channel)
        self._added(channel)

    def _forget_closed(self) -> None:
        for channel in [c for c in self.channels if c.peer.closed]:
            self.channels.remove(channel)
            if channel in self.logs:
                self.logs.remove(channel)
            self.ports.arrange(self.channels)
            if channel.peer.why_closed:
                self.dropped.append(f"{channel.name}: {channel.peer.why_closed}")
            if self.journal is not None:
                self.journal.left(channel)
            self._removed(channel)
            self._has_spools = any(c.spool is not None for c in self.channels)

    def wait(self, seconds: float) -> bool:
        """Sleep until a socket has something to read, at most ``seconds`` of wall time. True when one has."""
        return bool(self._selector.select(seconds))

    @property
    def has_sockets(self) -> bool:
        """Whether there is anything to ``read``."""
        return self._sockets > 0

    @property
    def is_outside(self) -> bool:
        """Whether there are clients or logs that are no in-process clients."""
        return self._sockets > 0 or self._has_spools

    def read(self) -> None:
        """Read all sockets."""
        for key, _ in self._selector.select(0):
            key.data()
        for link in self.links:
            if link.refusals:
                self.dropped += link.refusals
                link.refusals.clear()

    def flush(self) -> None:
        """Hand everything queued to the links; notice who is gone."""
        closed = False
        for channel in self.channels:
            peer = channel.peer
            if channel.port.out_count or channel.has_spooled():
                channel.collect()
            elif peer.is_idle():
                continue
            if self.taps and peer.outbox:
                now = self._clock()
                for tap in self.taps:
                    for raw in peer.outbox:
                        tap.frame(now, raw)
            if peer.outbox and self.signer is not None and self.signer.concerns(channel):
                peer.outbox[:] = self.signer.sent(channel, peer.outbox)
            if self.journal is not None and peer.outbox:
                self.journal.sent(channel, peer.outbox)
            if peer.directions is not None:
                peer.outbox[:] = peer.directions.to_client.carry(peer.outbox, self._clock())
            peer.flush()
            if self.journal is not None:
                self.journal.flushed(channel)
            closed = closed or peer.closed
        if closed:
            self._forget_closed()

    def close(self) -> None:
        """Flush and close everything."""
        self.flush()
        if self.journal is not None:
            self.journal.close()
            self.journal = None
        for link in list(self.links):
            self.remove_link(link)
        self._selector.close()
