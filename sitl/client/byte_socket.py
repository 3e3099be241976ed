# SPDX-License-Identifier: BSD-3-Clause
"""The client's end of a socket to a vehicle. What is sent together travels together."""

from __future__ import annotations

import contextlib
import select
import socket
import time
from typing import Protocol

from ..errors import LinkLostError, OptionError
from .outbox import Outbox
from .serial_port import FORM, SerialPort

FORMS = (
    '"udp:HOST:PORT" (listen there for a vehicle), "udpout:HOST:PORT" (speak to one there), '
    f'"tcp:HOST:PORT" (connect to one) or {FORM}'
)
KINDS = ("udp", "udpin", "udpout", "tcp")
_BUFFER = 1 << 21
_AGAIN_S = 0.1
"""Between two tries to connect again [s]."""


class ByteStream(Protocol):
    """The client's end of what carries bytes to a vehicle and back, as ``ByteSocket`` explains."""

    name: str

    def send(self, data: bytes) -> None: ...
    def flush(self) -> bytes: ...
    def write(self, data: bytes) -> None: ...
    def wait(self, seconds: float) -> bool: ...
    def receive(self) -> bytes: ...
    def limit(self, seconds: float) -> None: ...
    def close(self) -> None: ...


def open_stream(text: str) -> ByteStream:
    """The stream that a connection is given by.

    Args:
        text: one of the forms.

    Raises:
        OptionError: it is none of them.
        LinkLostError: it cannot be opened.
        MissingExtra: a serial line needs what is not installed.
    """
    return SerialPort(text) if text.startswith("serial:") else ByteSocket(text)


class ByteSocket(Outbox):
    """A socket as ``Endpoint`` wants it; nothing blocks but ``wait``.

    Args:
        text: one of the forms.

    Raises:
        OptionError: it is none of them.
        LinkLostError: it cannot be opened.
    """

    def __init__(self, text: str) -> None:
        super().__init__()
        kind, _, rest = text.partition(":")
        host, colon, port = rest.rpartition(":")
        if kind in KINDS and port and not colon:
            part = "host" if port.isdigit() else "port"
            raise OptionError(f"connection {text!r}: the {part} is missing; it is {FORMS}")
        if kind not in KINDS or not host or not port.isdigit() or not 0 < int(port) < 65536:
            raise OptionError(f"connection {text!r} is none of {FORMS}")
        self.name = text
        self._stream = kind == "tcp"
        self.listens = kind in ("udp", "udpin")
        """Whether it waits to be spoken to, by anybody who knows its port."""
        self.peer: tuple[str, int] | None = None
        """Where datagrams go to: the first that was received, until ``settle``."""
        self._is_settled = False
        self._address, self._kind = (host, int(port)), kind
        self._open()

    def _open(self) -> None:
        self._socket = socket.socket(socket.AF_INET, socket.SOCK_STREAM if self._stream else socket.SOCK_DGRAM)
        self._socket.setsockopt(socket.SOL_SOCKET, socket.SO_RCVBUF, _BUFFER)
        try:
            if self._stream:
                self._socket.settimeout(5.0)
                self._socket.connect(self._address)
                from ..bridge.links.tcp import refuse_echo  # here: only TCP needs it

                refuse_echo(self._socket)
                self._socket.setsockopt(socket.IPPROTO_TCP, socket.TCP_NODELAY, 1)
            elif self._kind == "udpout":
                self.peer = (socket.gethostbyname(self._address[0]), self._address[1])
            else:
                self._socket.bind(self._address)
        except OSError as error:
            self._socket.close()
            raise LinkLostError(f"connection {self.name}: {error.strerror or error}") from None
        self._socket.setblocking(self._stream)

    def reopen(self, seconds: float) -> bool:
        """Connect again over TCP, trying so long [s of wall time]; False: this is another kind of connection.

        Raises:
            LinkLostError: nobody listens there.
        """
        if not self._stream:
            return False
        end = time.monotonic() + seconds
        self.close()
        while True:
            try:
                self._open()
            except LinkLostError:
                if time.monotonic() >= end:
                    raise
                time.sleep(_AGAIN_S)
            else:
                return True

    def write(self, data: bytes) -> None:
        """Send bytes now; a datagram without a vehicle yet is lost.

        Raises:
            LinkLostError: the connection is closed.
        """
        if self._stream:
            try:
                self._socket.sendall(data)
            except OSError as error:
                raise LinkLostError(f"connection {self.name} is lost: {error.strerror or error}") from None
        elif self.peer is not None and data:
            with contextlib.suppress(OSError):  # the answer that does not come is noticed
                self._socket.sendto(data, self.peer)

    def wait(self, seconds: float) -> bool:
        """Until something can be read, at most so long [s of wall time]. True when it can."""
        return bool(select.select([self._socket], [], [], seconds)[0])

    def settle(self, address: tuple[str, int] | None) -> None:
        """Send datagrams to this address, and hear no others, from now on."""
        self.peer, self._is_settled = address, True

    def receive(self) -> bytes:
        """All bytes that are there.

        Raises:
            LinkLostError: the connection is closed.
        """
        return b"".join(data for data, _ in self.receive_each())

    def receive_each(self) -> list[tuple[bytes, tuple[str, int] | None]]:
        """The same in the pieces that came, with the address of each one's sender; None: of a stream.

        Raises:
            LinkLostError: the connection is closed.
        """
        parts: list[tuple[bytes, tuple[str, int] | None]] = []
        while not self._stream or self.wait(0.0):  # a socket for datagrams does not block
            try:
                data, address = self._socket.recvfrom(1 << 16)
            except BlockingIOError:
                break
            except OSError:
                if self._stream:
                    data, address = b"", None
                else:
                    continue  # an earlier datagram was refused
            if not data and self._stream:
                if parts:
                    break
                raise LinkLostError(f"connection {self.name} is lost: the vehicle has closed it")
            if not self._stream:
                if self.peer is None:
                    self.peer = address
                elif self._is_settled and address != self.peer:
                    continue
            parts.append((data, address))
        return parts

    def limit(self, seconds: float) -> None:
        """From now on, sending takes at most so long [s of wall time]; what is not sent by then raises."""
        if self._stream:
            self._socket.settimeout(seconds)

    def close(self) -> None:
        """Close the socket; may be called twice."""
        self._socket.close()
