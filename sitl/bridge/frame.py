# SPDX-License-Identifier: BSD-3-Clause
"""MAVLink frames: payload to bytes, and a stream of bytes back to frames.

Source: https://mavlink.io/en/guide/serialization.html (packet format, zero truncation, checksum).
"""

from __future__ import annotations

import struct
from functools import partial
from typing import Any, NamedTuple

from .dialect import MessageType, crc_mcrf4xx, find_message

MARK_V1, MARK_V2 = 0xFE, 0xFD
HEADER_V1, HEADER_V2, CHECKSUM, SIGNATURE = 6, 10, 2, 13
_write_v2 = struct.Struct("<BxxBBB3s").pack
"""Behind the start mark: length, no flags, sequence, system, component, id."""
SIGNED = 0x01
"""Incompatibility flag: 13 bytes of signature follow the checksum."""


def encode_v2(kind: MessageType, payload: bytes, sequence: int, system: int, component: int) -> bytes:
    """A MAVLink 2 frame; trailing zeros of the payload are left out (one byte always stays)."""
    payload = payload.rstrip(b"\0") or b"\0"
    body = _write_v2(len(payload), sequence, system, component, kind.wire_id) + payload
    return b"\xfd" + body + crc_mcrf4xx(body + kind.crc_extra, 0xFFFF).to_bytes(2, "little")


def encode_v1(kind: MessageType, payload: bytes, sequence: int, system: int, component: int) -> bytes:
    """A MAVLink 1 frame (no extension fields).

    Empty for a message number above 255, which version 1 cannot carry.
    """
    if kind.id > 255:
        return b""
    payload = payload[: kind.base_size]
    body = bytes((len(payload), sequence, system, component, kind.id)) + payload
    return b"\xfe" + body + crc_mcrf4xx(body + kind.crc_extra, 0xFFFF).to_bytes(2, "little")


class Frame(NamedTuple):
    """A frame whose checksum is right."""

    kind: MessageType
    payload: bytes
    sequence: int
    system: int
    component: int
    version: int
    raw: bytes


_frame = partial(tuple.__new__, Frame)
"""A Frame from a tuple of its fields; three times as fast as ``Frame(...)``."""
_read_v2 = struct.Struct("<BBxBBBHB").unpack_from
"""Behind the start mark: length, incompatibility flags, sequence, system, component, id (low 16 bits, high 8)."""
_read_v1 = struct.Struct("<BBBBB").unpack_from


class Splitter:
    """Cuts frames out of a stream of bytes, whatever the stream contains.

    A header that cannot be right (unknown message, payload of version 1 longer than the message, unknown
    incompatibility flag) or a wrong checksum costs one byte: the search goes on right behind its start mark, so a good
    frame that follows, or that stands inside what looked like a frame, is found. A longer payload of version 2 has
    extension fields that are newer than this dialect; they are left out. Signed frames are accepted and their
    signature is not checked.
    """

    def __init__(self) -> None:
        self.rest = b""
        """The beginning of a frame that is not whole yet."""
        self.bad_checksums = 0

    def feed(self, data: bytes) -> list[Frame]:
        """All frames completed by ``data``, in order. Never raises."""
        return list(map(_frame, self.cut(data)))

    def cut(self, data: bytes) -> list[tuple[Any, ...]]:
        """The same as plain tuples, with the fields of a ``Frame``: quicker."""
        buffer = self.rest + data if self.rest else bytes(data)
        frames: list[tuple[Any, ...]] = []
        at, end = 0, len(buffer)
        while at < end:
            mark = buffer[at]
            if mark == MARK_V2:
                start = at + HEADER_V2
                if start > end:
                    break
                size, flags, sequence, system, component, low, high = _read_v2(buffer, at + 1)
                number, version = low | high << 16, 2
            elif mark == MARK_V1:
                start = at + HEADER_V1
                if start > end:
                    break
                size, sequence, system, component, number = _read_v1(buffer, at + 1)
                flags, version = 0, 1
            else:
                at = self._next_mark(buffer, at + 1)
                continue
            kind = find_message(number)
            if kind is None or (version == 1 and size > kind.size) or flags & ~SIGNED:
                at += 1
                continue
            stop = start + size
            after = stop + CHECKSUM + (SIGNATURE if flags else 0)
            if after > end:
                break
            if crc_mcrf4xx(buffer[at + 1 : stop] + kind.crc_extra, 0xFFFF) != buffer[stop] | buffer[stop + 1] << 8:
                self.bad_checksums += 1
                at += 1
                continue
            payload = buffer[start : start + min(size, kind.size)]
            frames.append((kind, payload, sequence, system, component, version, buffer[at:after]))
            at = after
        self.rest = buffer[at:]
        return frames

    @staticmethod
    def _next_mark(buffer: bytes, at: int) -> int:
        """Index of the next start mark at or behind ``at``, or the end."""
        one, two = buffer.find(b"\xfd", at), buffer.find(b"\xfe", at)
        if one < 0 and two < 0:
            return len(buffer)
        return min(i for i in (one, two) if i >= 0)
