# SPDX-License-Identifier: BSD-3-Clause
"""Entries of a recording: the inputs of a vehicle from outside, in order."""

from __future__ import annotations

import hashlib
import struct
import zlib
from collections.abc import Iterator
from enum import IntEnum
from functools import partial
from typing import Any, NamedTuple

from ..errors import SitlError
from ..simulation import Simulation


class RecordingError(SitlError, ValueError):
    """A recording that cannot be written, read or flown; the message names the file, the place and the reason."""


class EntryKind(IntEnum):
    """EntryKind of an entry; ``number`` is that of a channel, or the index of a link in the order of their addition."""

    LINK = 1
    """A link was opened; data: JSON [kind, name]."""
    UNLINK = 2
    """A link was closed."""
    CONNECTED = 3
    """A client connected; data: number of its link."""
    RECEIVED = 4
    """Bytes of a client were read; data: the bytes."""
    PROCESSED = 5
    """All bytes read were processed (``Bridge.receive``)."""
    SERVED = 6
    """Requests were answered while time stood still (``Simulation.advance_to`` the present)."""
    DISCONNECTED = 7
    """A client disconnected; data: the reason."""
    CONGESTED = 8
    """A client started (data 1) or stopped (0) reading too slowly; then the number of bytes sent to it."""
    STREAMS = 9
    """Stream rates for every client of a link; data: JSON {stream group: Hz}."""
    LOCKSTEP = 10
    """Clients advance the clock from now on; data 0: no longer."""
    GRANTED = 11
    """The clients' time grants that were due were answered."""
    HEARTBEAT = 12
    """A HEARTBEAT was sent while time stood still."""
    CHECK = 13
    """Digests of the vehicle's record and of all telemetry (4 + 4 bytes), to locate differences of a replay."""
    NOT_REPLAYABLE = 14
    """An action that no replay can repeat: the vehicle was restored to a snapshot; data: description."""
    LOGS = 15
    """On-board logs are kept from now on, and clients can download them."""
    FAULT = 16
    """A fault was ordered (data: its text) or repaired ("-" and its unit)."""


class Entry(NamedTuple):
    """One entry."""

    time_us: int
    """Simulated time since the start of the simulation [us]."""
    kind: EntryKind
    number: int = 0
    data: bytes = b""


_entry = partial(tuple.__new__, Entry)
"""An Entry from a tuple of its fields, quickly."""
_KINDS = {int(kind): kind for kind in EntryKind}
_LAST_SHIFT = 63
_LATEST_US = (1 << 63) - 1


def varint(value: int) -> bytes:
    """An unsigned integer as a varint: seven bits a byte, least significant first."""
    out = bytearray()
    while value > 0x7F:
        out.append(value & 0x7F | 0x80)
        value >>= 7
    out.append(value)
    return bytes(out)


def read_varint(data: bytes, at: int) -> tuple[int, int]:
    """(The integer at offset ``at``, the offset after it).

    Raises:
        IndexError: the data ends within it.
        ValueError: it does not fit 64 bits.
    """
    value = shift = 0
    while True:
        byte = data[at]
        at += 1
        value |= (byte & 0x7F) << shift
        if byte < 0x80:
            if value < 1 << 64:
                return value, at
            break
        shift += 7
        if shift > _LAST_SHIFT:
            break
    raise ValueError("a number that does not fit 64 bits")


def encode(entry: Entry, before_us: int) -> bytes:
    """One entry as bytes: time since the entry before, kind, number, length of the data, data."""
    _, kind, number, data = entry
    return varint(entry.time_us - before_us) + bytes([kind]) + varint(number) + varint(len(data)) + data


def decode(data: bytes, before_us: int) -> Iterator[Entry]:
    """Entries of a block; ``before_us`` is the time of the entry before.

    Raises:
        ValueError: the bytes are no entries.
    """
    at, end = 0, len(data)
    while at < end:
        try:
            step, at = (data[at], at + 1) if data[at] < 0x80 else read_varint(data, at)
            kind = _KINDS[data[at]]
            at += 1
            number, at = (data[at], at + 1) if data[at] < 0x80 else read_varint(data, at)
            size, at = (data[at], at + 1) if data[at] < 0x80 else read_varint(data, at)
        except IndexError:
            raise ValueError("an entry is incomplete") from None
        except KeyError as error:
            raise ValueError(f"an entry of kind {error}, which no recording has") from None
        if at + size > end:
            raise ValueError("an entry is incomplete")
        before_us += step
        if before_us > _LATEST_US:
            raise ValueError(f"an entry at {before_us} us: no run is as long")
        yield _entry((before_us, kind, number, data[at : at + size]))
        at += size


_TIME = struct.Struct("<q")
_LONGEST = 1 << 16


class Sent:
    """Digest of all frames to one client, with their simulated times."""

    def __init__(self) -> None:
        self.count = 0
        """Bytes that were sent."""
        self._hash = hashlib.sha256()
        self._pending: list[bytes] = []
        self._size = 0
        self._last = -1

    def add(self, time_us: int, frames: list[bytes]) -> None:
        """Frames that go out at ``time_us``."""
        pending = self._pending
        if time_us != self._last:
            self._last = time_us
            pending.append(_TIME.pack(time_us))
        pending += frames
        size = sum(map(len, frames))
        self.count += size
        self._size += size
        if self._size > _LONGEST:
            self._take()

    def _take(self) -> None:
        self._hash.update(b"".join(self._pending))
        self._pending.clear()
        self._size = 0

    def digest(self) -> bytes:
        """Digest of all bytes so far."""
        self._take()
        return self._hash.digest()


def of_state(simulation: Simulation) -> str:
    """Digest of the vehicle's whole record: body, sensors, autopilot."""
    record: Any = simulation.fleet.view("u1")
    return hashlib.sha256(record).hexdigest()


def check(simulation: Simulation, sent: dict[int, Sent]) -> bytes:
    """Four bytes of the record's digest and four of all telemetry's."""
    state = zlib.crc32(simulation.fleet.view("u1"))  # type: ignore[arg-type]
    telemetry = 0
    for number in sorted(sent):
        telemetry = zlib.crc32(sent[number].digest(), telemetry)
    return struct.pack("<II", state, telemetry)
