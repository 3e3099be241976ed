# SPDX-License-Identifier: BSD-3-Clause
"""MAVLink over TCP: the vehicle listens, any number of clients connect; none of them can stall it."""

from __future__ import annotations

import selectors
import socket
from collections.abc import Callable

from .link import Link, Peer, Selector

CONGESTED_BYTES = 1 << 18
"""With this much unsent, telemetry to the client waits (``Peer.congested``)."""
QUEUE_BYTES = 1 << 22
"""With this much unsent, the client is dropped."""
_READ_BYTES = 1 << 16


class _TcpPeer(Peer):
    def __init__(self, name: str, sock: socket.socket, link: TcpServerLink) -> None:
        super().__init__(name)
        self._socket = sock
        self._link = link
        self._pending = bytearray()

    @property
    def congested(self) -> bool:
        return len(self._pending) > CONGESTED_BYTES

    def flush(self) -> None:
        if self.outbox:
            self._pending += b"".join(self.outbox)
            self.outbox.clear()
        if not self._pending or self.closed:
            return
        try:
            while self._pending:
                del self._pending[: self._socket.send(memoryview(self._pending)[: 1 << 16].tobytes())]
        except BlockingIOError:
            if len(self._pending) > QUEUE_BYTES:
                self.drop(
                    f"client does not read: {len(self._pending)} bytes unsent, at most {QUEUE_BYTES} are kept"
                )
        except OSError as error:
            self.drop(f"connection lost: {error.strerror or error}")

    def readable(self) -> None:
        try:
            data = self._socket.recv(_READ_BYTES)
        except BlockingIOError:
            return
        except OSError as error:
            self.drop(f"connection lost: {error.strerror or error}")
            return
        if data:
            self.deliver(data)
        else:
            self.drop("client closed the connection")

    def drop(self, why: str) -> None:
        """Close the connection and say why."""
        if not self.closed:
            self.closed, self.why_closed = True, why
            self._link.forget(self, self._socket)


class TcpServerLink(Link):
    """Listens on ``host:port`` (ArduPilot's SITL: 5760 + 10 x instance); 0 takes a free port, told by ``name``."""

    def __init__(self, port: int = 5760, host: str = "127.0.0.1") -> None:
        super().__init__(f"tcp:{host}:{port}")
        self._socket = socket.socket(socket.AF_INET, socket.SOCK_STREAM)
        self._socket.setsockopt(socket.SOL_SOCKET, socket.SO_REUSEADDR, 1)
        self._socket.setblocking(False)
        try:
            self._socket.bind((host, port))
            self._socket.listen(16)
        except OSError:
            self._socket.close()
            raise
        self.name = f"tcp:{host}:{self.local_address[1]}"
        self._selector: Selector | None = None

    @property
    def local_address(self) -> tuple[str, int]:
        """(host, port) that the server listens on."""
        host, port = self._socket.getsockname()[:2]
        return host, port

    def attach(self, selector: Selector, on_peer: Callable[[Peer], None]) -> None:
        self._selector = selector
        selector.register(self._socket, selectors.EVENT_READ, self._accept)
        super().attach(selector, on_peer)

    def _accept(self) -> None:
        try:
            sock, address = self._socket.accept()
        except OSError:
            return  # gone again before we looked
        sock.setblocking(False)
        sock.setsockopt(socket.IPPROTO_TCP, socket.TCP_NODELAY, 1)
        peer = _TcpPeer(f"{self.name} {address[0]}:{address[1]}", sock, self)
        if self._selector is not None:
            self._selector.register(sock, selectors.EVENT_READ, peer.readable)
        self.add_peer(peer)

    def forget(self, peer: Peer, sock: socket.socket) -> None:
        """Stop watching a closed connection."""
        if self._selector is not None:
            self._selector.unregister(sock)
        sock.close()
        if peer in self.peers:
            self.peers.remove(peer)

    def close(self) -> None:
        for peer in list(self.peers):
            if isinstance(peer, _TcpPeer):
                peer.flush()
                peer.drop("vehicle closed")
        if self._selector is not None:
            self._selector.unregister(self._socket)
            self._selector = None
        self._socket.close()
        super().close()
