# SPDX-License-Identifier: BSD-3-Clause
"""The physics end of the JSON interface: what a datagram of an autopilot asks for. Neither socket nor clock.

Lockstep: an autopilot sends a frame of servos and waits for the line that answers it. The count of frames goes up by
one with each line that it has taken, so that

| count | means | physics |
|---|---|---|
| one more than the last | go on | steps, answers |
| the same | our answer was lost, or is late | does not step; answers with the same line |
| lower | the autopilot has been started anew | back to power-on, steps, answers |
| higher by more than one | frames were lost, or physics has been started anew | steps once, answers |

An answer too many would be taken as the answer to the next frame, and the autopilot would from then on be one step
ahead of its physics. So of frames that wait together only the newest counts, and a repeated one that comes right after
our answer, which must have crossed it, is not answered.

An autopilot that asks for more steps a second than physics has ticks (``lines``) gets the lines of a tick at once.
The first one answers the frame that was stepped, the others answer the frames that follow, before they come.
"""

from __future__ import annotations

from collections.abc import Hashable, Sequence
from enum import Enum
from typing import NamedTuple

from ...core.constants import TICK_HZ
from ...core.kernels import inlined
from .servos import COUNT_AT, COUNT_MASK, ServoError, Servos, decode, is_frame

MOST_TICKS = 8
"""A step is no longer than 20 ms, the period of a rover's loop."""
MOST_LINES = 5
"""A step is no shorter than 500 us."""
CROSSED_S = 0.5
"""Autopilots repeat a frame after a second or more without an answer [s]."""
ALIVE_S = 0.25
"""An autopilot heard within this time is still there when another one calls [s]."""


class Asked(Enum):
    """What a datagram asks for."""

    STEP = "step"
    RESTART = "power-on, then step"
    REPEAT = "the same line again"
    AHEAD = "a line that was sent before it"
    NOTHING = "nothing"


class Request(NamedTuple):
    """A datagram, understood."""

    asked: Asked
    servos: Servos | None = None
    note: str = ""
    """Something that people should be told."""


_AHEAD = Request(Asked.AHEAD)


@inlined
def ticks(rate: int) -> int:
    """Ticks of 2500 us to step for a frame: the whole ones in 1 / ``rate`` [Hz], at least one, at most 20 ms."""
    return min(max(TICK_HZ // rate, 1), MOST_TICKS) if rate > 0 else 1


@inlined
def lines(rate: int) -> int:
    """Lines that a tick is told in: as often as 1 / ``rate`` [Hz] goes into it, at least one, at most five.

    ArduPilot takes the step that it is given and from then on asks for 1 Hz more than it got: that gives the same
    number again.
    """
    return min(max(rate // TICK_HZ, 1), MOST_LINES)


def named(peer: Hashable) -> str:
    """An address for people."""
    return ":".join(map(str, peer)) if isinstance(peer, tuple) else str(peer)


class PhysicsEnd:
    """Which frames came, and from whom."""

    def __init__(self) -> None:
        self.peer: Hashable | None = None
        """Where the autopilot is."""
        self.count: int | None = None
        """Of the last frame."""
        self.lines: Sequence[bytes] = ()
        """The last answers: to the frame that was stepped, and to those that follow it."""
        self._first = 0
        """Count of the frame that was stepped."""
        self.refused = 0
        """Datagrams that were no frames, or of another autopilot."""
        self._received_at = self._answered_at = float("-inf")
        self._reported: set[str] = set()

    def is_answered(self, datagram: bytes, peer: Hashable, now: float) -> bool:
        """Whether a datagram is a frame whose line was sent before it: nothing is to be done."""
        if self.ahead and peer == self.peer and is_frame(datagram):
            number = int.from_bytes(datagram[COUNT_AT], "little")
            if 0 < (number - (self.count or 0)) & COUNT_MASK <= self.ahead:
                self.count, self._received_at = number, now
                return True
        return False

    @property
    def ahead(self) -> int:
        """Number of lines that were sent before the frames that they answer."""
        if self.count is None or not self.lines:
            return 0
        number = (self._first + len(self.lines) - 1 - self.count) & COUNT_MASK
        return number if number < len(self.lines) else 0

    def receive(self, datagram: bytes, peer: Hashable, now: float) -> Request:
        """What a datagram from ``peer`` at wall time ``now`` [s] asks for; ``answer`` follows, if it is a step."""
        if self.is_answered(datagram, peer, now):
            return _AHEAD
        try:
            servos = decode(datagram)
        except ServoError as error:
            return self._refuse(f"a datagram from {named(peer)} is no frame of servos: {error}", "datagram")
        note = ""
        if peer != self.peer:
            if self.peer is not None and now - self._received_at < ALIVE_S:
                return self._refuse(
                    f"a second autopilot, at {named(peer)}, is not served: there is one at {named(self.peer)}", peer
                )
            note = f"autopilot at {named(peer)}" + (f", before at {named(self.peer)}" if self.peer is not None else "")
        moved, self.peer, self._received_at = peer != self.peer, peer, now
        before, self.count = self.count, servos.number
        known = (servos.number - self._first) & COUNT_MASK < len(self.lines)
        if before is None:
            asked = Asked.STEP
        elif servos.number == before and not moved:
            if now - self._answered_at < CROSSED_S:
                return Request(Asked.NOTHING, servos)
            asked = Asked.REPEAT if known else Asked.STEP
        elif servos.number <= before and (before - servos.number) < 1 << 31:
            asked, note = Asked.RESTART, note or "the autopilot has been started anew"
        else:
            asked = Asked.STEP
        return Request(asked, servos, note)

    def answer(self, lines: Sequence[bytes], now: float) -> None:
        """Keep the answers to the last frame and those that follow, for when one is asked for again."""
        self.lines, self._answered_at = lines, now
        self._first = self.count or 0

    def go_on(self, first: int, count: int, lines: Sequence[bytes], now: float) -> None:
        """Frames were received and answered elsewhere.

        Args:
            first: count of the frame that was stepped last.
            count: of the last frame.
            lines: see ``answer``.
            now: wall time [s].
        """
        self.lines, self._first, self.count = lines, first, count
        self._received_at = self._answered_at = now

    def repeat(self, now: float) -> bytes:
        """The answer to the last frame once more; ``now``: wall time [s]."""
        self._answered_at = now
        return self.lines[((self.count or 0) - self._first) & COUNT_MASK]

    def _refuse(self, note: str, kind: Hashable) -> Request:
        """Count, and tell each kind once."""
        self.refused += 1
        key = str(kind)
        if key in self._reported:
            return Request(Asked.NOTHING)
        if len(self._reported) < 16:
            self._reported.add(key)
        return Request(Asked.NOTHING, None, note)
