# SPDX-License-Identifier: BSD-3-Clause
"""Signatures of MAVLink 2 frames: made, and checked against forgery and replay.

Source: https://mavlink.io/en/guide/message_signing.html
"""

from __future__ import annotations

import hashlib
from typing import NamedTuple

from .dialect import crc_mcrf4xx, find_message
from .frame import HEADER_V2, MARK_V2, SIGNATURE, SIGNED, Frame

KEY_BYTES = 32
EPOCH_US = 1_420_070_400_000_000
"""Time stamps count from 2015-01-01 UTC: Unix time [us]."""
UNIT_US = 10
WINDOW = 6_000_000
"""A stream that is new may be this much behind: one minute [10 us]."""
LAST = (1 << 48) - 1
"""The last time stamp there is [10 us]: the own one stays there."""
MAX_STREAMS = 256


class Stream(NamedTuple):
    """Whose time stamps may only rise."""

    link: int
    """As the sender numbers it."""
    system: int
    component: int


class SigningState(NamedTuple):
    """What signing goes on with: immutable."""

    key: bytes
    """32 bytes; empty: nothing is signed or checked."""
    timestamp: int
    """Of the next frame [10 us since 2015-01-01 UTC]."""
    streams: tuple[tuple[Stream, int], ...] = ()
    """The last time stamp of each."""


OFF = SigningState(b"", 0)


class Signing:
    """The key of a vehicle, its time stamp, and the last one of each stream that it has received."""

    def __init__(self, state: SigningState = OFF) -> None:
        self.key, self.timestamp = state.key, min(max(state.timestamp, 0), LAST)
        self._streams = dict(state.streams)

    def state(self) -> SigningState:
        """To go on from here."""
        return SigningState(self.key, self.timestamp, tuple(self._streams.items()))

    @property
    def is_on(self) -> bool:
        """Whether there is a key."""
        return bool(self.key)

    def set_key(self, key: bytes, timestamp: int) -> None:
        """Sign and check from now on; a key of zeros with time stamp 0 ends it.

        The own time stamp begins a minute later: what was sent with this key before is not taken again. (ArduPilot.)
        """
        is_off = timestamp == 0 and not any(key)
        self.key, self.timestamp = (b"", 0) if is_off else (bytes(key), min(timestamp + WINDOW, LAST))
        self._streams.clear()

    def follow_date(self, unix_us: int) -> None:
        """The time stamp is not behind this date [us]."""
        self.timestamp = max(self.timestamp, (unix_us - EPOCH_US) // UNIT_US)

    def signed(self, frame: bytes, link: int) -> bytes:
        """A frame with signature; one of MAVLink 1 cannot have one and comes back as it is."""
        if frame[0] != MARK_V2:
            return frame
        body = _checked(frame[:-2], SIGNED)
        stamp = bytes((link & 0xFF,)) + self.timestamp.to_bytes(6, "little")
        self.timestamp = min(self.timestamp + 1, LAST)
        return body + stamp + self._signature(body, stamp)

    def accepts(self, raw: bytes, system: int, component: int) -> bool:
        """Whether a signed frame is from somebody with the key, and later than all before it in its stream."""
        body, tail = raw[:-SIGNATURE], raw[-SIGNATURE:]
        if self._signature(body, tail[:7]) != tail[7:]:
            return False
        stream, timestamp = Stream(tail[0], system, component), int.from_bytes(tail[1:7], "little")
        last = self._streams.get(stream)
        if last is None:
            if timestamp + WINDOW < self.timestamp or len(self._streams) >= MAX_STREAMS:
                return False
        elif timestamp <= last:
            return False
        self._streams[stream] = timestamp
        self.timestamp = max(self.timestamp, timestamp)
        return True

    def _signature(self, body: bytes, stamp: bytes) -> bytes:
        return hashlib.sha256(self.key + body + stamp).digest()[:6]


def is_signed(frame: Frame) -> bool:
    """Whether a frame carries a signature."""
    return frame.version == 2 and bool(frame.raw[2] & SIGNED)


def unsigned(frame: Frame) -> bytes:
    """A signed frame without its signature."""
    return _checked(frame.raw[: HEADER_V2 + len(frame.payload)], 0)


def _checked(frame: bytes, flags: int) -> bytes:
    """Header and payload with these flags and the checksum that belongs to them."""
    kind = find_message(int.from_bytes(frame[7:10], "little"))
    assert kind is not None
    frame = frame[:2] + bytes((flags,)) + frame[3:]
    return frame + crc_mcrf4xx(frame[1:] + kind.crc_extra, 0xFFFF).to_bytes(2, "little")
