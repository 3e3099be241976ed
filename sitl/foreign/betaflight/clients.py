# SPDX-License-Identifier: BSD-3-Clause
"""The clients of a face: on the links that ``sitl run`` has, and in this process."""

from __future__ import annotations

import selectors
from collections.abc import Callable, Sequence

from ...bridge.links.link import Link, Peer, receive_all
from ...client.outbox import Outbox
from ..process import Cutter
from .face import Face


class Clients:
    """Carries frames between a face and the peers of links.

    Args:
        face: of the vehicle.
        links: closed with this.
        tap: gets every frame of both sides.
    """

    def __init__(self, face: Face, links: Sequence[Link], tap: Callable[[bytes], None] = lambda frame: None) -> None:
        self._face, self._links, self._tap = face, list(links), tap
        self._peers: list[Peer] = []
        self._selector = selectors.DefaultSelector()
        for link in self._links:
            link.attach(self._selector, self._peers.append)
        face.send = self._send

    def _send(self, frame: bytes) -> None:
        self._tap(frame)
        for peer in self._peers:
            if not peer.closed and not peer.congested:
                peer.write(frame)

    def turn(self, seconds: float) -> None:
        """Hand on what has come; waits up to ``seconds`` [s] wall time for something."""
        for peer in self._peers:
            if not peer.closed:
                peer.flush()
        for _, data in receive_all(self._selector, self._links, self._peers, seconds):
            for frame in Cutter().feed(data):
                self._tap(frame)
            self._face.feed(data)

    def close(self) -> None:
        """Close all links."""
        for link in self._links:
            link.close()
        self._selector.close()


class InProcess(Outbox):
    """A client in this process, as ``sitl.client.byte_socket.ByteStream`` has it: it is heard at once.

    Args:
        face: of the vehicle.
    """

    name = "betaflight"

    def __init__(self, face: Face) -> None:
        super().__init__()
        self._face = face
        self._received: list[bytes] = []
        face.send = self._received.append

    def write(self, data: bytes) -> None:
        """Send bytes now."""
        self._face.feed(data)

    def wait(self, seconds: float) -> bool:
        """Whether something has come."""
        return bool(self._received)

    def receive(self) -> bytes:
        """All that has come."""
        data = b"".join(self._received)
        self._received.clear()
        return data

    def limit(self, seconds: float) -> None:
        """Nothing takes time here."""

    def close(self) -> None:
        """Hear no more."""
        self._face.send = lambda frame: None
