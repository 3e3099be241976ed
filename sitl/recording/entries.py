# SPDX-License-Identifier: BSD-3-Clause
"""What happened to a vehicle from outside, entry by entry, in the order in which it happened."""

from __future__ import annotations

from collections.abc import Iterator
from enum import IntEnum
from typing import NamedTuple


class Kind(IntEnum):
    """Kind of an entry; ``number`` is that of a channel, or the index of a link in the order of their addition."""

    LINK = 1
    """A way for clients was opened; data: JSON [kind, name]."""
    UNLINK = 2
    """A link was closed."""
    CAME = 3
    """A client came; data: number of its link."""
    HEARD = 4
    """Bytes of a client were read; data: they."""
    ACTED = 5
    """All bytes read were acted on (``Bridge.receive``)."""
    ATTENDED = 6
    """Requests were answered while time stood still (``Simulation.advance_to`` the present)."""
    LEFT = 7
    """A client left; data: why."""
    CONGESTED = 8
    """A client began (data 1) or ceased (0) to read too slowly; then how many bytes it had been sent."""
    STREAMS = 9
    """Stream groups for every client of a link; data: JSON {ending: Hz}."""
    LOCKSTEP = 10
    """Clients push the clock from now on; data 0: no more."""
    ANSWERED = 11
    """Their grants that were due were answered."""
    BEAT = 12
    """A HEARTBEAT went out while time stood."""
    CHECK = 13
    """Digests of the vehicle's record and of all telemetry (4 + 4 bytes), to find where a replay goes astray."""
    BROKEN = 14
    """An action that no replay can repeat: the vehicle was restored to a snapshot; data: description."""
    LOGS = 15
    """On-board logs are kept from now on, and clients can download them."""


class Entry(NamedTuple):
    """One entry."""

    time_us: int
    """Simulated time since the start of the simulation [us]."""
    kind: Kind
    number: int = 0
    data: bytes = b""


def varint(value: int) -> bytes:
    """A number from 0 on, seven bits a byte, least first."""
    out = bytearray()
    while value > 0x7F:
        out.append(value & 0x7F | 0x80)
        value >>= 7
    out.append(value)
    return bytes(out)


def read_varint(data: bytes, at: int) -> tuple[int, int]:
    """(The number at ``at``, where it ends).

    Raises:
        IndexError: it does not end.
    """
    value = shift = 0
    while True:
        byte = data[at]
        at += 1
        value |= (byte & 0x7F) << shift
        if byte < 0x80:
            return value, at
        shift += 7


def encode(entry: Entry, before_us: int) -> bytes:
    """One entry as bytes: time since the entry before, kind, number, length of the data, data."""
    _, kind, number, data = entry
    return varint(entry.time_us - before_us) + bytes([kind]) + varint(number) + varint(len(data)) + data


def decode(data: bytes, before_us: int) -> Iterator[Entry]:
    """Entries of a block; ``before_us`` is the time of the entry before.

    Raises:
        ValueError: the bytes are no entries.
    """
    at = 0
    while at < len(data):
        try:
            step, at = read_varint(data, at)
            kind = Kind(data[at])
            number, at = read_varint(data, at + 1)
            size, at = read_varint(data, at)
        except IndexError:
            raise ValueError("an entry is incomplete") from None
        if at + size > len(data):
            raise ValueError("an entry is incomplete")
        before_us += step
        yield Entry(before_us, kind, number, data[at : at + size])
        at += size
