# SPDX-License-Identifier: BSD-3-Clause
"""Links without a socket: a pair of byte queues in one process, and a listener that writes down what it is sent."""

from __future__ import annotations

from collections.abc import Callable
from typing import Protocol

from .link import Link, Peer

Drop = Callable[[bytes], bool]
"""Given what is sent, says whether the link loses it."""


class _VehicleEnd(Peer):
    is_signed = False

    def __init__(self, name: str, drop: Drop | None) -> None:
        super().__init__(name)
        self.drop = drop
        self.sent: list[bytes] = []
        self.joins_frames = self.waits = drop is None

    def is_idle(self) -> bool:
        return self.waits and not self.outbox

    def accept(self, frames: bytes) -> None:
        self.sent.append(frames)

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


class Clock(Protocol):
    """Anything with simulated time; a simulation is one (a bridge is not: a reboot replaces it)."""

    @property
    def time_us(self) -> int:
        """Simulated time since the start of the simulation [us]."""
        ...


class FrameWriter(Protocol):
    """Keeps frames, for example ``sitl.logs.tlog.TlogWriter``."""

    def frame(self, time_us: int, raw: bytes) -> None:
        """One frame sent at ``time_us``."""
        ...

    def write(self, data: bytes) -> None:
        """Frames that stand behind their times already."""
        ...

    def close(self) -> None:
        """No more frames."""
        ...


class _LogPeer(Peer):
    waits = spools = stamps = is_log = True
    is_signed = False

    def __init__(self, name: str, writer: FrameWriter, clock: Clock) -> None:
        super().__init__(name)
        self._writer, self._clock = writer, clock

    def spooled(self, data: bytes) -> None:
        self.flush()
        self._writer.write(data)

    def flush(self) -> None:
        if self.outbox:
            now = self._clock.time_us
            for raw in self.outbox:
                self._writer.frame(now, raw)
            self.outbox.clear()


class LogLink(Link):
    """A log has streams at rates of its own, whatever clients asked for, and all that they are answered."""

    def __init__(self, writer: FrameWriter, clock: Clock) -> None:
        super().__init__("log")
        self._writer = writer
        self.add_peer(_LogPeer(self.name, writer, clock))

    def close(self) -> None:
        self._writer.close()
        super().close()
