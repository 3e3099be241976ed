# SPDX-License-Identifier: BSD-3-Clause
"""MAVLink over TCP: the vehicle listens, up to 64 clients connect; none of them can stall it or keep others out.

Who tries to connect to a port of this machine where nobody listens yet gets, once in some ten thousand times, that very
port as its own, and is connected with itself: it would hear its own words, and keep the port from whom it waits for.
"""

from __future__ import annotations

import contextlib
import errno
import os
import selectors
import socket
from collections.abc import Callable

from .link import Link, LinkAddressError, Peer, Selector

CONGESTED_BYTES = 1 << 18
"""With this much unsent, telemetry to the client waits (``Peer.congested``)."""
QUEUE_BYTES = 1 << 22
"""With this much unsent, the client is dropped."""
MAX_CONNECTIONS = 64
"""With so many, the client that was silent for longest gives way to another one."""
CONNECT_S = 5.0
"""Wall time to connect to a client that listens [s]."""
_READ_BYTES = 1 << 16
_WEB = tuple(f"{word} ".encode() for word in ("GET", "POST", "HEAD", "PUT", "DELETE", "OPTIONS", "PATCH", "CONNECT"))
"""Beginnings of what a browser sends: it lets any site's page post bytes to this machine, frames among them."""


_EXHAUSTED = frozenset((errno.EMFILE, errno.ENFILE, errno.ENOBUFS, errno.ENOMEM))


def _reserve() -> int:
    """A descriptor of nothing, -1 when there is none to be had."""
    try:
        return os.open(os.devnull, os.O_RDONLY)
    except OSError:
        return -1


class _TcpPeer(Peer):
    joins_frames = waits = spools = True

    def __init__(self, name: str, sock: socket.socket, link: TcpServerLink | TcpClientLink) -> None:
        super().__init__(name)
        self._socket = sock
        self._link = link
        self._pending = bytearray()
        self._begin: bytes | None = b""
        """First bytes from the client, as long as they may become the beginning of HTTP."""

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
                self.drop(f"client does not read: {len(self._pending)} bytes unsent, at most {QUEUE_BYTES} are kept")
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
        if self._begin is not None and self._is_web(data):
            self.drop("client speaks HTTP, not MAVLink")
        elif data:
            self._link.deliver(self, data)
        else:
            self.drop("client closed the connection")

    def _is_web(self, data: bytes) -> bool:
        begin = (self._begin or b"") + data[:8]
        self._begin = begin if any(word.startswith(begin) for word in _WEB) else None
        return begin.startswith(_WEB)

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
        self._listens = False
        self._refuses = False
        self._reserve = _reserve()
        """A descriptor to give up when there are no more, so that a connection can be taken and closed."""

    @property
    def local_address(self) -> tuple[str, int]:
        """(host, port) that the server listens on."""
        host, port = self._socket.getsockname()[:2]
        return host, port

    def attach(self, selector: Selector, on_peer: Callable[[Peer], None]) -> None:
        self._selector = selector
        self._listen(True)
        super().attach(selector, on_peer)

    def _listen(self, on: bool) -> None:
        if self._selector is None or on == self._listens:
            return
        if on:
            self._selector.register(self._socket, selectors.EVENT_READ, self._accept)
        else:
            self._selector.unregister(self._socket)
        self._listens = on

    def _refuse(self, why: str) -> None:
        if not self._refuses:  # one note, however often the refused try again
            self.refusals.append(f"{self.name}: connections are refused: {why}")
        self._refuses = True

    def _free_descriptor(self, error: OSError) -> None:
        """No descriptor or memory for a connection that waits, and that would be reported for ever.

        Close it in the place of the reserve; if that fails as well, do not look again before a client leaves.
        """
        self._refuse(error.strerror or str(error))
        if self._reserve >= 0:
            os.close(self._reserve)
        try:
            self._socket.accept()[0].close()
        except OSError as again:
            if again.errno in _EXHAUSTED:
                self._listen(False)
        self._reserve = _reserve()

    def _accept(self) -> None:
        try:
            sock, address = self._socket.accept()
        except OSError as error:
            if error.errno in _EXHAUSTED:
                self._free_descriptor(error)
            return  # else gone again before we looked
        if len(self.peers) >= MAX_CONNECTIONS:
            silent = self.silent_for_longest()
            if isinstance(silent, _TcpPeer):
                silent.drop(f"more than {MAX_CONNECTIONS} clients; silent for longest")
        sock.setblocking(False)
        with contextlib.suppress(OSError):  # some systems refuse it when the client has gone already
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
        self._refuses = False
        self._listen(True)

    def close(self) -> None:
        for peer in list(self.peers):
            if isinstance(peer, _TcpPeer):
                peer.flush()
                peer.drop("vehicle closed")
        if self._selector is not None:
            self._listen(False)
            self._selector = None
        if self._reserve >= 0:
            os.close(self._reserve)
            self._reserve = -1
        self._socket.close()
        super().close()


class TcpClientLink(Link):
    """Connects to ``host:port``, where a client listens; when that leaves, the link stays empty.

    Raises:
        LinkAddressError: nobody listens there.
    """

    def __init__(self, host: str, port: int) -> None:
        super().__init__(f"tcpclient:{host}:{port}")
        try:
            self._socket = socket.create_connection((host, port), CONNECT_S)
            refuse_echo(self._socket)
        except OSError as error:
            raise LinkAddressError(f"link {self.name} cannot be opened: {error.strerror or error}") from None
        self._socket.setblocking(False)
        self._socket.setsockopt(socket.IPPROTO_TCP, socket.TCP_NODELAY, 1)
        self._selector: Selector | None = None
        self._peer = _TcpPeer(self.name, self._socket, self)
        self.add_peer(self._peer)

    def attach(self, selector: Selector, on_peer: Callable[[Peer], None]) -> None:
        self._selector = selector
        selector.register(self._socket, selectors.EVENT_READ, self._peer.readable)
        super().attach(selector, on_peer)

    def forget(self, peer: Peer, sock: socket.socket) -> None:
        """Stop watching the closed connection."""
        if self._selector is not None:
            self._selector.unregister(sock)
        sock.close()
        self.peers.clear()

    def close(self) -> None:
        self._peer.flush()
        self._peer.drop("vehicle closed")
        super().close()


def refuse_echo(connection: socket.socket) -> None:
    """Check a connection that was just made.

    Raises:
        ConnectionRefusedError: it leads to itself: nobody listens there. It is closed.
    """
    if connection.getsockname() == connection.getpeername():
        connection.close()
        raise ConnectionRefusedError(errno.ECONNREFUSED, os.strerror(errno.ECONNREFUSED))
