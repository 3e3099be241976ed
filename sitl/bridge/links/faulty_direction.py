# SPDX-License-Identifier: BSD-3-Clause
"""One direction of a link with faults: frames go in, and come out when their simulated time has come."""

from __future__ import annotations

import heapq
import math
import struct
from collections.abc import Iterable
from typing import NamedTuple

from sitl.core.constants import NEVER
from sitl.core.elementary import log1p

from ...core import rng
from ..frame import CHECKSUM, HEADER_V1, HEADER_V2, MARK_V1, MARK_V2, SIGNATURE, SIGNED
from .faults import LinkFaults

NONE = LinkFaults()
LATE_S = 0.2
"""A frame that is overtaken comes later by up to so much [s]."""
FULL_S, LOST_S = 0.25, 4.0
"""With frames for so long in wait, telemetry is held back; with so much, frames are lost [s]."""
_COMMAND_INT, _COMMAND_ACK = 75, 77
_COMMAND_AT = {_COMMAND_INT: 28, _COMMAND_ACK: 0}
"""Offset of the command's number in the payload."""
CLOCK_COMMANDS = (31010, 31011)
"""Grants of time and new seeds (services/commands.py), which no radio carries: they pass unharmed."""


class DirectionState(NamedTuple):
    """What a direction needs to go on from a snapshot."""

    faults: LinkFaults
    generator: bytes
    in_flight: tuple[tuple[int, int, bytes], ...]
    sent: int
    free_us: int
    last_us: int
    rest: bytes
    passes: bool


class FaultyDirection:
    """Frames from one end of a link to the other.

    Args:
        faults: what happens to them; may be changed while frames are in flight.
        stream: number of its random numbers, which no other direction has.
    """

    def __init__(self, faults: LinkFaults, stream: int = 0) -> None:
        self.faults = faults
        self.passes = False
        """Whether frames pass unharmed: time stands, and this client has not pushed it yet."""
        self.is_full = False
        """Whether telemetry should wait."""
        self._rng = rng.Rng()
        rng.seed(self._rng, (faults.seed << 32) + stream)
        self._in_flight: list[tuple[int, int, bytes]] = []
        """Heap of (time of arrival [us], number, frame)."""
        self._sent = 0
        self._free_us = self._last_us = 0
        """When the last frame has been sent; when the last one that keeps its order arrives."""
        self._rest = b""

    @property
    def due_us(self) -> int:
        """When the next frame arrives, simulated time since the start [us]; NEVER: none is in flight."""
        return self._in_flight[0][0] if self._in_flight else NEVER

    @property
    def is_idle(self) -> bool:
        """Whether nothing is in flight, and nothing will happen to later frames."""
        return self.faults == NONE and not self._in_flight and not self._rest

    def carry(self, frames: Iterable[bytes], now_us: int) -> list[bytes]:
        """Send frames at a simulated time since the start [us]; gives those that arrive at once, with earlier ones."""
        for frame in frames:
            if self.passes or is_of_clock(frame):
                self._arrive(frame, now_us)
            else:
                self._send(frame, now_us)
        return self.arrived(now_us)

    def carry_bytes(self, data: bytes, now_us: int) -> list[bytes]:
        """The same with a stream of bytes, which is cut into frames; a beginning of one waits for the rest."""
        frames, self._rest = cut(self._rest + data)
        return self.carry(frames, now_us)

    def arrived(self, now_us: int) -> list[bytes]:
        """Frames that have arrived by now, in order."""
        out: list[bytes] = []
        while self._in_flight and self._in_flight[0][0] <= now_us:
            out.append(heapq.heappop(self._in_flight)[2])
        self.is_full = self._free_us - now_us > FULL_S * 1e6
        return out

    def _send(self, frame: bytes, now_us: int) -> None:
        faults = self.faults
        if any(begin * 1e6 <= now_us < end * 1e6 for begin, end in faults.cuts):
            return
        sent_us = now_us
        if faults.bandwidth is not None:
            if self._free_us - now_us > LOST_S * 1e6:
                return
            sent_us = self._free_us = max(self._free_us, now_us) + math.ceil(len(frame) / faults.bandwidth * 1e6)
        if self._happens(faults.loss):
            return
        if faults.corruption:
            frame = self._corrupt(frame, faults.corruption)
        again = self._happens(faults.duplicates)
        due_us = max(sent_us + self._delay_us(), now_us)
        if self._happens(faults.reordering):
            due_us += round(rng.uniform(self._rng) * LATE_S * 1e6)
        else:
            due_us = self._last_us = max(due_us, self._last_us)
        self._arrive(frame, due_us)
        if again:
            self._arrive(frame, max(sent_us + self._delay_us(), now_us))

    def _arrive(self, frame: bytes, due_us: int) -> None:
        heapq.heappush(self._in_flight, (due_us, self._sent, frame))
        self._sent += 1

    def _happens(self, share: float) -> bool:
        return share > 0.0 and rng.uniform(self._rng) < share

    def _delay_us(self) -> int:
        low, high = self.faults.delays
        late = low if low == high else low + (high - low) * rng.uniform(self._rng)
        if self.faults.jitter:
            late += self.faults.jitter * (2.0 * rng.uniform(self._rng) - 1.0)
        return round(late * 1e6)

    def _corrupt(self, frame: bytes, probability: float) -> bytes:
        """Each bit is turned over with a probability: from one such bit to the next it is a geometric deviate."""
        bits, at = bytearray(frame), -1
        while True:
            if probability < 1.0:
                at += int(min(log1p(-rng.uniform(self._rng)) / log1p(-probability), 1e9))
            at += 1
            if at >= 8 * len(bits):
                return bytes(bits)
            bits[at >> 3] ^= 1 << (at & 7)

    def snapshot(self) -> DirectionState:
        """Frames in flight, and what becomes of later ones."""
        return DirectionState(
            self.faults, bytes(self._rng._bytes), tuple(self._in_flight), self._sent, self._free_us, self._last_us,
            self._rest, self.passes,
        )  # fmt: skip

    @classmethod
    def restored(cls, state: DirectionState) -> FaultyDirection:
        """The direction as it was."""
        direction = cls(state.faults)
        direction._rng._bytes[:] = state.generator
        direction._in_flight, direction._sent = list(state.in_flight), state.sent
        direction._free_us, direction._last_us, direction._rest, direction.passes = state[4:]
        return direction


class Directions(NamedTuple):
    """Both directions of one client's link."""

    to_vehicle: FaultyDirection
    to_client: FaultyDirection

    @property
    def due_us(self) -> int:
        """When the next frame arrives at either end [us]."""
        return min(direction.due_us for direction in self)

    def hold(self, passes: bool) -> None:
        """Whether the client's frames pass unharmed, because it has not pushed a clock that stands."""
        for direction in self:
            direction.passes = passes

    def snapshot(self) -> tuple[DirectionState, DirectionState]:
        """Of both."""
        return self.to_vehicle.snapshot(), self.to_client.snapshot()


def is_of_clock(frame: bytes) -> bool:
    """Whether a frame is a client's push of the clock, or the answer to one."""
    v2 = frame[0] == MARK_V2
    number = int.from_bytes(frame[7:10], "little") if v2 else frame[5] if len(frame) > 5 else 0
    at = _COMMAND_AT.get(number)
    if at is None:
        return False
    at += HEADER_V2 if v2 else HEADER_V1
    return len(frame) >= at + 2 and struct.unpack_from("<H", frame, at)[0] in CLOCK_COMMANDS


def cut(data: bytes) -> tuple[list[bytes], bytes]:
    """Cut bytes at the ends of frames, by their marks and lengths alone; gives the pieces, and a beginning of one.

    What is no frame is a piece of its own, up to the next mark.
    """
    pieces: list[bytes] = []
    at = 0
    while at < len(data):
        if data[at] == MARK_V2:
            if len(data) - at < HEADER_V2:
                break
            size = HEADER_V2 + data[at + 1] + CHECKSUM + (SIGNATURE if data[at + 2] & SIGNED else 0)
        elif data[at] == MARK_V1:
            if len(data) - at < HEADER_V1:
                break
            size = HEADER_V1 + data[at + 1] + CHECKSUM
        else:
            marks = [found for mark in (b"\xfd", b"\xfe") if (found := data.find(mark, at)) >= 0]
            size = min(marks, default=len(data)) - at
        if at + size > len(data):
            break
        pieces.append(data[at : at + size])
        at += size
    return pieces, data[at:]
