# SPDX-License-Identifier: BSD-3-Clause
"""A listener that only writes down what it is sent."""

from __future__ import annotations

from typing import Protocol

from .link import Link, Peer


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

    def close(self) -> None:
        """No more frames."""
        ...


class _LogPeer(Peer):
    def __init__(self, name: str, writer: FrameWriter, clock: Clock) -> None:
        super().__init__(name)
        self._writer, self._clock = writer, clock

    def flush(self) -> None:
        if self.outbox:
            now = self._clock.time_us
            for raw in self.outbox:
                self._writer.frame(now, raw)
            self.outbox.clear()


class LogLink(Link):
    """With stream rates of its own, a log does not depend on what clients asked for."""

    def __init__(self, writer: FrameWriter, clock: Clock) -> None:
        super().__init__("log")
        self._writer = writer
        self.add_peer(_LogPeer(self.name, writer, clock))

    def close(self) -> None:
        self._writer.close()
        super().close()
