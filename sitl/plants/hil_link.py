# SPDX-License-Identifier: BSD-3-Clause
"""The TCP connection from an autopilot to its physics: opened and opened again by the autopilot."""

from __future__ import annotations

import contextlib
import socket
import time

from ..bridge.links.tcp import refuse_echo
from ..errors import OptionError
from .plant import PhysicsLostError

READ_BYTES = 1 << 16
CONNECT_S = 1.0
"""Longest wait for a connection [s of wall time]."""
WAIT_S = 0.2
"""Longest wait for bytes in one ``receive`` [s of wall time]."""
_AGAIN_S = 0.05
FORM = "tcp:HOST:PORT or tcp:PORT"


def parse_address(text: str) -> tuple[str, int]:
    """(host, port) of "tcp:HOST:PORT"; without a host this machine.

    Raises:
        OptionError: it is none.
    """
    kind, _, rest = text.partition(":")
    host, _, port = rest.rpartition(":")
    if kind != "tcp" or not (port.isascii() and port.isdigit() and 0 < int(port) < 65536):
        raise OptionError(f"physics hil:{text}: {text!r} is not an address; allowed: hil:{FORM}")
    return host or "127.0.0.1", int(port)


def tune(connection: socket.socket, wait_s: float) -> None:
    """Send at once, wait at most so long, and find out within some ten seconds that the other machine is gone."""
    connection.settimeout(wait_s)
    connection.setsockopt(socket.IPPROTO_TCP, socket.TCP_NODELAY, 1)
    connection.setsockopt(socket.SOL_SOCKET, socket.SO_KEEPALIVE, 1)
    for name, value in (("TCP_KEEPIDLE", 5), ("TCP_KEEPINTVL", 2), ("TCP_KEEPCNT", 3)):
        if hasattr(socket, name):
            connection.setsockopt(socket.IPPROTO_TCP, getattr(socket, name), value)


class HilLink:
    """A connection that may be lost and opened again.

    Args:
        address: (host, port) that the physics listens on.
    """

    def __init__(self, address: tuple[str, int]) -> None:
        self.address = address
        self.name = f"tcp:{address[0]}:{address[1]}"
        self._socket: socket.socket | None = None

    @property
    def is_open(self) -> bool:
        """Whether there is a connection, as far as is known."""
        return self._socket is not None

    def open(self, patience_s: float = 0.0) -> None:
        """Connect, trying again for ``patience_s`` [s of wall time].

        Raises:
            PhysicsLostError: nobody listens there.
        """
        end = time.monotonic() + patience_s
        while True:
            try:
                found = socket.create_connection(self.address, CONNECT_S)
                refuse_echo(found)
            except OSError as error:
                if time.monotonic() >= end:
                    raise PhysicsLostError(f"no physics at {self.name}: {error.strerror or error}") from None
                time.sleep(_AGAIN_S)
            else:
                break
        tune(found, WAIT_S)
        self._socket = found

    def send(self, data: bytes) -> None:
        """Send all of it.

        Raises:
            PhysicsLostError: the connection is lost.
        """
        try:
            if self._socket is not None:
                self._socket.sendall(data)
        except OSError as error:
            raise self._lost(error.strerror or str(error)) from None

    def receive(self) -> bytes:
        """Bytes that came; none after ``WAIT_S``.

        Raises:
            PhysicsLostError: the connection is lost.
        """
        if self._socket is None:
            return b""
        try:
            data = self._socket.recv(READ_BYTES)
        except TimeoutError:
            return b""
        except OSError as error:
            raise self._lost(error.strerror or str(error)) from None
        if not data:
            raise self._lost("it closed the connection")
        return data

    def _lost(self, why: str) -> PhysicsLostError:
        self.close()
        return PhysicsLostError(f"physics at {self.name} is lost: {why}")

    def close(self) -> None:
        """Leave the connection."""
        if self._socket is not None:
            with contextlib.suppress(OSError):
                self._socket.close()
            self._socket = None
