# SPDX-License-Identifier: BSD-3-Clause
"""STATUSTEXT: words for the pilot, to every client."""

from __future__ import annotations

from ..channel import Channel
from ..dialect import message
from .service import Service

TEXT_BYTES = 50
KIND = message("STATUSTEXT")


class StatusTextService(Service):
    """Texts longer than 50 bytes go out in numbered pieces.

    The last of which ends with a NUL (MAVLink 2 only).

    A MAVLink 1 client gets the first 50 bytes.
    """

    _id = 0

    def snapshot(self) -> int:
        return self._id

    def restore(self, state: int) -> None:
        self._id = state

    def say(self, severity: int, text: str) -> None:
        """Send ``text`` with a MAV_SEVERITY to every channel."""
        data = text.encode("ascii", "replace")
        for listener in self.bridge.listeners:
            listener.said(severity, text)
        pieces = self._pieces(severity, data)
        for channel in self.bridge.channels:
            self._send(channel, pieces)

    def _pieces(self, severity: int, data: bytes) -> list[bytes]:
        if len(data) <= TEXT_BYTES:
            return [KIND.payload(severity=severity, text=data)]
        self._id = self._id % 65535 + 1
        count = len(data) // TEXT_BYTES + 1  # a text of 100 bytes needs an empty third piece for its NUL
        parts = [data[k * TEXT_BYTES : (k + 1) * TEXT_BYTES] for k in range(count)]
        return [KIND.payload(severity=severity, text=p, id=self._id, chunk_seq=k) for k, p in enumerate(parts)]

    @staticmethod
    def _send(channel: Channel, pieces: list[bytes]) -> None:
        for payload in pieces if channel.version == 2 else pieces[:1]:
            channel.send(KIND, payload)
