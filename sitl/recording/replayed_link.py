# SPDX-License-Identifier: BSD-3-Clause
"""The links of a recording, without what was at their other ends."""

from __future__ import annotations

from typing import NamedTuple

from ..bridge.links.inprocess import Clock, FrameWriter
from ..bridge.links.link import Link, Peer


class Flip(NamedTuple):
    """A client began or ceased to read too slowly."""

    time_us: int
    sent: int
    """Bytes that it had been sent by then."""
    congested: bool


class ReplayedPeer(Peer):
    """A client of the recording, or its log: it is sent frames, and reads as slowly as it did."""

    def __init__(
        self, name: str, clock: Clock, flips: list[Flip], is_log: bool = False, writer: FrameWriter | None = None
    ) -> None:
        super().__init__(name)
        self.is_log = is_log
        self._clock, self._flips, self._writer = clock, flips, writer
        self._sent = 0
        self._congested = False

    @property
    def congested(self) -> bool:
        return self._congested

    def flush(self) -> None:
        now = self._clock.time_us
        if self._writer is not None:
            for raw in self.outbox:
                self._writer.frame(now, raw)
        self._sent += sum(map(len, self.outbox))
        self.outbox.clear()
        while self._flips and now >= self._flips[0].time_us and self._sent >= self._flips[0].sent:
            self._congested = self._flips.pop(0).congested


class ReplayedLink(Link):
    """A link of the recording.

    Args:
        kind: what it was (``recorder.kind_of``).
        name: its name then.
        writer: gets what its clients are sent: the log of the replay.
    """

    def __init__(self, kind: str, name: str, writer: FrameWriter | None = None) -> None:
        super().__init__(name)
        self.kind, self.writer = kind, writer

    def close(self) -> None:
        if self.writer is not None:
            self.writer.close()
        super().close()
