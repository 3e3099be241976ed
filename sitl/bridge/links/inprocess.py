# SPDX-License-Identifier: BSD-3-Clause
"""A link without a socket: a pair of byte queues in one process, deterministic to the byte."""

from __future__ import annotations

from collections.abc import Callable

from .link import Link, Peer

Drop = Callable[[bytes], bool]
"""Given what is sent, says whether the link loses it."""


class _VehicleEnd(Peer):
    def __init__(self, name: str, drop: Drop | None) -> None:
        super().__init__(name)
        self.drop = drop
        self.sent: list[bytes] = []

    def flush(self) -> None:
        if self.outbox:
            self.sent.extend(self.outbox if self.drop is None else [f for f in self.outbox if not self.drop(f)])
            self.outbox.clear()


class InProcessLink(Link):
    """``send`` and ``receive`` are the client's end; the vehicle's end is the link's only peer.

    ``drop_to_client`` and ``drop_to_vehicle`` make it a lossy link: each frame (or ``send``) for which they
    are true is lost.
    """

    def __init__(
        self, name: str = "inprocess", drop_to_client: Drop | None = None, drop_to_vehicle: Drop | None = None
    ) -> None:
        super().__init__(name)
        self._end = _VehicleEnd(name, drop_to_client)
        self._drop = drop_to_vehicle
        self.add_peer(self._end)

    def send(self, data: bytes) -> None:
        """Client to vehicle."""
        if self._drop is None or not self._drop(data):
            self._end.deliver(bytes(data))

    def receive(self) -> bytes:
        """All bytes from the vehicle since the last call."""
        data = b"".join(self._end.sent)
        self._end.sent.clear()
        return data
