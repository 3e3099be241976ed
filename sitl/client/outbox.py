# SPDX-License-Identifier: BSD-3-Clause
"""Frames that leave together."""

from __future__ import annotations


class Outbox:
    """What a stream of bytes (``byte_socket.ByteStream``) does with frames until they are sent."""

    def __init__(self) -> None:
        self._unsent: list[bytes] = []

    def send(self, data: bytes) -> None:
        """Keep a frame for ``flush``."""
        self._unsent.append(data)

    def flush(self) -> bytes:
        """Send what was kept, in one piece; returns it."""
        data = b"".join(self._unsent)
        self._unsent.clear()
        self.write(data)
        return data

    def write(self, data: bytes) -> None:
        """Send bytes now."""
        raise NotImplementedError
