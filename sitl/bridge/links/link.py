# SPDX-License-Identifier: BSD-3-Clause
"""What every link has: peers, each with bytes that came in and frames that go out. Nothing here blocks."""

from __future__ import annotations

import selectors
import socket
from collections.abc import Callable, Iterable, Iterator, Mapping
from typing import TYPE_CHECKING

from ...errors import SitlError

if TYPE_CHECKING:
    from .faulty_direction import Directions

Selector = selectors.BaseSelector


class LinkAddressError(SitlError, ValueError):
    """A link text that cannot be understood, or an address that cannot be opened."""


class Peer:
    """One client at the other end of a link: a TCP connection, a UDP address, the other half of a pair."""

    joins_frames = False
    """Whether frames of the same time may be queued as one piece of bytes."""
    waits = False
    """Whether frames may be queued at any later time: nothing that the peer does depends on when they are."""
    spools = False
    """Whether frames of several times may be queued as one piece of bytes (``sitl.bridge.wire.spool``)."""
    stamps = False
    """Whether each of them then stands behind its time."""
    is_signed = True
    """Whether frames to and from it are signed once the vehicle has a key (``sitl.bridge.signing``)."""
    takes_unsigned = False
    """Whether its frames are received without signature then, too."""
    is_log = False
    """Whether it is a log, which gets what other clients are answered, too."""

    def __init__(self, name: str) -> None:
        self.name = name
        self.closed = False
        self.why_closed = ""
        self.last_received = 0
        """Number of the last piece of bytes that came from it on its link; 0 before the first."""
        self.directions: Directions | None = None
        """Between it and the vehicle, where the link has faults."""
        self._inbox: list[bytes] = []
        self.outbox: list[bytes] = []

    def deliver(self, data: bytes) -> None:
        """Bytes from the client, kept until the bridge takes them."""
        self._inbox.append(data)

    def take(self) -> bytes:
        """All bytes that came in since the last call."""
        if not self._inbox:
            return b""
        data = self._inbox[0] if len(self._inbox) == 1 else b"".join(self._inbox)
        self._inbox.clear()
        return data

    def write(self, frame: bytes) -> None:
        """Queue one frame; ``flush`` sends it."""
        self.outbox.append(frame)

    def accept(self, frames: bytes) -> None:
        """Frames in one piece, on their way at once; of a peer that ``waits``."""
        raise NotImplementedError

    def flush(self) -> None:
        """Hand queued frames to the operating system, as far as it takes them now."""
        self.outbox.clear()

    def spooled(self, data: bytes) -> None:
        """Queue frames of several times; they come before what is queued from now on."""
        self.outbox.append(data)

    def is_idle(self) -> bool:
        """Whether ``flush`` need not be called while nothing is queued."""
        return False

    @property
    def congested(self) -> bool:
        """True when the client reads too slowly: telemetry should wait, answers still go."""
        return False


class Link:
    """A place where peers appear.

    ``on_peer`` is called for each new one, also for those there before it was set.
    """

    def __init__(self, name: str) -> None:
        self.name = name
        self.peers: list[Peer] = []
        self.is_high_latency = False
        """Of clients that come from now on: HIGH_LATENCY2 is all their telemetry (services/high_latency.py)."""
        self._received = 0
        self._takes_unsigned = False
        self.refusals: list[str] = []
        """Why clients were turned away; the switchboard takes them."""
        self.rates_hz: Mapping[str, int] = {}
        """Stream groups that each client gets from its beginning (``sitl.bridge.bridge.Bridge.stream_to``)."""
        self._on_peer: Callable[[Peer], None] | None = None

    def attach(self, selector: Selector, on_peer: Callable[[Peer], None]) -> None:
        """Register sockets with ``selector``.

        (its ``data`` is the function to call when readable) and report peers.
        """
        self._on_peer = on_peer
        for peer in self.peers:
            on_peer(peer)

    def reattach(self, on_peer: Callable[[Peer], None]) -> None:
        """Report peers, present and new, to another listener; sockets stay registered."""
        self._on_peer = on_peer
        for peer in self.peers:
            on_peer(peer)

    def deliver(self, peer: Peer, data: bytes) -> None:
        """Bytes from a peer of this link."""
        self._received += 1
        peer.last_received = self._received
        peer.deliver(data)

    def silent_for_longest(self) -> Peer:
        """The peer to go when there is no space for another; one that never said anything is first."""
        return min(self.peers, key=lambda peer: peer.last_received)

    def take_unsigned(self) -> None:
        """Hear its peers without signature, too, when the vehicle has a key: nobody else can reach this link."""
        self._takes_unsigned = True
        for peer in self.peers:
            peer.takes_unsigned = True

    def add_peer(self, peer: Peer) -> None:
        peer.takes_unsigned = self._takes_unsigned
        self.peers.append(peer)
        if self._on_peer is not None:
            self._on_peer(peer)

    def close(self) -> None:
        """Close all sockets; peers are marked closed."""
        for peer in self.peers:
            peer.closed = True
        self.peers.clear()


class DatagramLink(Link):
    """A link with one UDP socket, which ``_readable`` reads.

    Raises:
        OSError: the address cannot be bound.
    """

    def __init__(self, name: str, bind: tuple[str, int]) -> None:
        super().__init__(name)
        self._socket = socket.socket(socket.AF_INET, socket.SOCK_DGRAM)
        self._socket.setblocking(False)
        self._selector: Selector | None = None
        try:
            self._socket.bind(bind)
        except OSError:
            self._socket.close()
            raise

    def attach(self, selector: Selector, on_peer: Callable[[Peer], None]) -> None:
        self._selector = selector
        selector.register(self._socket, selectors.EVENT_READ, self._readable)
        super().attach(selector, on_peer)

    def _readable(self) -> None:
        """Read what has come."""
        raise NotImplementedError

    def close(self) -> None:
        if self._selector is not None:
            self._selector.unregister(self._socket)
            self._selector = None
        self._socket.close()
        super().close()


def receive_all(
    selector: Selector, links: Iterable[Link], peers: list[Peer], seconds: float
) -> Iterator[tuple[Peer, bytes]]:
    """What each peer has sent, for who serves links by itself; waits up to ``seconds`` [s] wall time for something.

    Peers that are closed leave ``peers``.
    """
    for key, _ in selector.select(seconds):
        key.data()
    for link in links:
        link.refusals.clear()
    peers[:] = [peer for peer in peers if not peer.closed]
    for peer in peers:
        data = peer.take()
        if data:
            yield peer, data
