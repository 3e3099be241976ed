# SPDX-License-Identifier: BSD-3-Clause
"""Carries MAVLink between an autopilot and the links that ``sitl run`` has: UDP, TCP, a log.

ArduPilot boots when the first client connects, and stands still when that client does not read: the relay connects at
once, always reads (in a thread of its own), and connects again after a reboot. PX4 speaks UDP (``UdpRelay``).
"""

from __future__ import annotations

import contextlib
import selectors
import socket
import threading
import time
from collections.abc import Callable, Sequence

from ..bridge.links.link import Link, Peer, receive_all
from ..bridge.links.tcp import refuse_echo
from ..bridge.links.udp import DATAGRAM_BYTES
from .process import HOST, Cutter

_WAIT_S = 0.1
_RETRY_S = 0.2
_READ = 1 << 16
_UNSENT = 1 << 20
_BUFFER = 1 << 21
_READS_AT_ONCE = 256


class Relay:
    """Relays frames between one autopilot and all clients.

    Args:
        address: host and port of the autopilot's MAVLink.
        links: to clients; closed with the relay.
        tap: gets every frame, of both sides, in the relay's thread.
        answer: gets every frame of a client; b"": it goes to the autopilot; else this is the answer to it.
    """

    def __init__(
        self,
        address: tuple[str, int],
        links: Sequence[Link],
        tap: Callable[[bytes], None] = lambda frame: None,
        answer: Callable[[bytes], bytes] = lambda frame: b"",
    ) -> None:
        self._address, self._links, self._tap, self._answer = address, list(links), tap, answer
        self._peers: list[Peer] = []
        self._selector = selectors.DefaultSelector()
        self._autopilot: socket.socket | None = None
        self._cutter = Cutter()
        self._unsent = bytearray()
        self._retry_at = 0.0
        self._stopping = False
        self.frames = 0
        """Number of frames from the autopilot so far."""
        for link in self._links:
            link.attach(self._selector, self._peers.append)
        self._thread = threading.Thread(target=self._run, name="mavlink relay", daemon=True)

    def start(self) -> None:
        """Start the relay's thread."""
        self._thread.start()

    @property
    def is_connected(self) -> bool:
        """Whether the autopilot is connected."""
        return self._autopilot is not None

    def _run(self) -> None:
        while not self._stopping:
            self.turn(_WAIT_S)

    def turn(self, seconds: float) -> None:
        """Relay pending frames; waits up to ``seconds`` [s] wall time for one."""
        if self._autopilot is None:
            self._connect()
        for _, data in receive_all(self._selector, self._links, self._peers, seconds):
            self._to_autopilot(data)
        self._push()

    def _connect(self) -> None:
        now = time.monotonic()
        if now < self._retry_at:
            return
        self._retry_at = now + _RETRY_S
        made = socket.socket(socket.AF_INET, socket.SOCK_STREAM)
        made.settimeout(_RETRY_S)
        try:
            made.connect(self._address)
            refuse_echo(made)
        except OSError:
            made.close()
            return
        made.setblocking(False)
        with contextlib.suppress(OSError):
            made.setsockopt(socket.IPPROTO_TCP, socket.TCP_NODELAY, 1)
        self._autopilot, self._cutter = made, Cutter()
        self._unsent.clear()
        self._selector.register(made, selectors.EVENT_READ, self._from_autopilot)

    def _from_autopilot(self) -> None:
        assert self._autopilot is not None
        try:
            data = self._autopilot.recv(_READ)
        except BlockingIOError:
            return
        except OSError:
            data = b""
        if not data:
            self._drop()
            return
        self.frames += self._to_clients(data)

    def _to_clients(self, data: bytes) -> int:
        """The frames that are whole; how many they are."""
        frames = self._cutter.feed(data)
        for frame in frames:
            self._tap(frame)
            for peer in self._peers:
                if not peer.closed and not peer.congested:
                    peer.write(frame)
        for peer in self._peers:
            if not peer.closed:
                peer.flush()
        return len(frames)

    def _to_autopilot(self, data: bytes) -> None:
        for frame in Cutter().feed(data):
            self._tap(frame)
            answer = self._answer(frame)
            if answer:
                self._to_clients(answer)
            elif self._autopilot is not None and len(self._unsent) < _UNSENT:
                self._unsent += frame

    def _push(self) -> None:
        while self._unsent and self._autopilot is not None:
            try:
                del self._unsent[: self._autopilot.send(self._unsent)]
            except BlockingIOError:
                return
            except OSError:
                self._drop()

    def _drop(self) -> None:
        if self._autopilot is not None:
            self._selector.unregister(self._autopilot)
            self._autopilot.close()
            self._autopilot = None
            self._retry_at = time.monotonic() + _RETRY_S

    def close(self) -> None:
        """End the thread, close all links."""
        self._stopping = True
        if self._thread.is_alive():
            self._thread.join()
        self._drop()
        for link in self._links:
            link.close()
        self._selector.close()


class UdpRelay(Relay):
    """The same for an autopilot that speaks UDP: it is given our port (``own_port``), and hears at its own.

    Args:
        port: at which the autopilot hears, on this machine.
        links, tap, answer: as of ``Relay``.
    """

    def __init__(
        self,
        port: int,
        links: Sequence[Link],
        tap: Callable[[bytes], None] = lambda frame: None,
        answer: Callable[[bytes], bytes] = lambda frame: b"",
    ) -> None:
        super().__init__((HOST, port), links, tap, answer)
        self._datagrams = socket.socket(socket.AF_INET, socket.SOCK_DGRAM)
        self._datagrams.setsockopt(socket.SOL_SOCKET, socket.SO_RCVBUF, _BUFFER)
        self._datagrams.bind((HOST, 0))
        self._datagrams.setblocking(False)
        self._autopilot = self._datagrams
        self._selector.register(self._datagrams, selectors.EVENT_READ, self._from_autopilot)

    @property
    def own_port(self) -> int:
        """At which the autopilot finds us."""
        return int(self._datagrams.getsockname()[1])

    def _from_autopilot(self) -> None:
        for _ in range(_READS_AT_ONCE):
            try:
                data, address = self._datagrams.recvfrom(_READ)
            except BlockingIOError:
                return
            except OSError:
                continue  # what was sent before it listened was refused
            if address == self._address:
                self.frames += self._to_clients(data)

    def _push(self) -> None:
        while self._unsent:
            with contextlib.suppress(OSError):  # it does not listen yet, or no more
                self._datagrams.sendto(self._unsent[:DATAGRAM_BYTES], self._address)
            del self._unsent[:DATAGRAM_BYTES]
