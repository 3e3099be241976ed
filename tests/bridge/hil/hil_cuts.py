# SPDX-License-Identifier: BSD-3-Clause
"""A wire that is cut: passes bytes on between two sockets and closes both after so many of them."""

from __future__ import annotations

import contextlib
import select
import socket
import threading
from collections.abc import Iterator


class CutWire:
    """Listens, connects each caller to ``target`` and cuts the connection after the next number of bytes.

    Args:
        target: (host, port).
        lengths: bytes that connections live for, both directions counted; then they live on.
    """

    def __init__(self, target: tuple[str, int], lengths: Iterator[int]) -> None:
        self._target, self._lengths = target, lengths
        self._listener = socket.create_server(("127.0.0.1", 0))
        self.port = self._listener.getsockname()[1]
        self.cuts = 0
        self._thread = threading.Thread(target=self._run, daemon=True)
        self._thread.start()

    def _run(self) -> None:
        with contextlib.suppress(OSError):
            while True:
                caller = self._listener.accept()[0]
                with caller, socket.create_connection(self._target) as callee:
                    for end in (caller, callee):
                        end.setsockopt(socket.IPPROTO_TCP, socket.TCP_NODELAY, 1)
                    self._pass_on(caller, callee, next(self._lengths, 1 << 62))

    def _pass_on(self, caller: socket.socket, callee: socket.socket, left: int) -> None:
        other = {caller: callee, callee: caller}
        while True:
            for end in select.select([caller, callee], [], [], 5.0)[0]:
                data = end.recv(1 << 16)
                if not data:
                    return
                other[end].sendall(data[:left])  # perhaps in the middle of a message
                left -= len(data)
                if left <= 0:
                    self.cuts += 1
                    return

    def close(self) -> None:
        """Take no more callers."""
        self._listener.close()
