# SPDX-License-Identifier: BSD-3-Clause
"""Datagrams of the JSON interface: a socket towards physics."""

from __future__ import annotations

import contextlib
import select
import socket
import struct
import sys

from ..errors import OptionError

PORT = 9002
"""Of instance 0; 10 more for each."""
LOCAL = "127.0.0.1"
WAIT_S = 0.2
"""Longest wait for a datagram [s]."""
_MOST = 65535


def parse_address(text: str, what: str = "physics json:HOST:PORT") -> tuple[str, int]:
    """(host, port) of ``[HOST:]PORT`` or ``HOST``.

    Raises:
        OptionError: it is neither.
    """
    host, _, port = text.rpartition(":")
    if not host and not port.isdigit():
        host, port = port, str(PORT)
    if not (port.isascii() and port.isdigit() and 0 <= int(port) < 65536):
        raise OptionError(f"{what}: {text!r} is not HOST:PORT, as in {LOCAL}:{PORT}")
    return host or LOCAL, int(port)


def wait_in_kernel(sock: socket.socket, seconds: float) -> None:
    """Let reads block for so long at most [s]: one system call where a Python time-out takes two."""
    whole = int(seconds)
    if sys.platform == "win32":
        sock.settimeout(seconds)
    else:
        sock.setblocking(True)
        timeval = struct.pack("@ll", whole, int(1e6 * (seconds - whole)))
        sock.setsockopt(socket.SOL_SOCKET, socket.SO_RCVTIMEO, timeval)


class JsonLink:
    """A UDP socket to a simulator.

    Args:
        address: host and port of the simulator.

    Raises:
        OptionError: no such host.
    """

    def __init__(self, address: tuple[str, int]) -> None:
        self.name = f"{address[0]}:{address[1]}"
        self._socket = socket.socket(socket.AF_INET, socket.SOCK_DGRAM)
        try:
            self._socket.connect(address)
        except OSError as error:
            self._socket.close()
            raise OptionError(f"physics json:{self.name} cannot be reached: {error.strerror or error}") from None
        wait_in_kernel(self._socket, WAIT_S)

    def send(self, frame: bytes) -> None:
        """To the simulator; lost when nobody is there."""
        with contextlib.suppress(OSError):
            self._socket.send(frame)

    def receive(self, wait_s: float = WAIT_S) -> bytes | None:
        """A datagram; None when none came for so long, which is ``WAIT_S`` at most."""
        try:
            if wait_s != WAIT_S and not select.select([self._socket], [], [], wait_s)[0]:
                return None
            return self._socket.recv(_MOST)
        except OSError:  # nothing came, or the last one that we sent met a closed port
            return None

    def close(self) -> None:
        """Let go of the socket."""
        self._socket.close()
