# SPDX-License-Identifier: BSD-3-Clause
"""Frames in the core: closed behind a payload, and cut out of the client's bytes.

Source: https://mavlink.io/en/guide/serialization.html (packet format, zero truncation, checksum).
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from ...core.kernels import inlined, law
from ...core.memory import Bytes, bytes_at
from ..frame import CHECKSUM, HEADER_V1, HEADER_V2, MARK_V1, MARK_V2, SIGNATURE, SIGNED
from .dialect_rows import BASE_SIZES, CRC_EXTRAS, PAYLOAD_MAX, SIZES, row_of
from .port import INCOMING, OUT, OUT_BYTES, OUT_FRAMES, PAYLOAD_BYTES, Port, note_sender

COMPONENT = 1
"""MAV_COMP_ID_AUTOPILOT1"""
FRAME_MAX = HEADER_V2 + PAYLOAD_MAX + CHECKSUM


class Sender(NamedTuple):
    """Who sends a frame."""

    sequence: int
    system: int
    component: int


class Found(NamedTuple):
    """A frame in a row of bytes."""

    start: int
    """Where it begins; without a frame, where to go on when more has come."""
    end: int
    """Where it ends; 0: there is none."""
    version: int
    number: int
    """Of its message."""
    sender: Sender
    payload: int
    """Where its payload begins."""
    payload_size: int
    bad: int
    """Wrong checksums on the way."""


_AT_ONCE = 8
"""Bytes that go into a checksum at once."""


def _crc_tables() -> list[list[int]]:
    """What a byte does to the checksum: row k for a byte that k others follow."""
    table = []
    for byte in range(256):
        crc = byte
        for _ in range(8):
            crc = crc >> 1 ^ (0x8408 if crc & 1 else 0)
        table.append(crc)
    tables = [table]
    for _ in range(1, _AT_ONCE):
        tables.append([crc >> 8 ^ table[crc & 0xFF] for crc in tables[-1]])
    return tables


_CRC = np.array(_crc_tables(), np.int32)


@law
def crc_of(data: Bytes, start: int, end: int, extra: int) -> int:
    """CRC-16/MCRF4XX of bytes ``start`` .. ``end`` - 1 and the message's own seed."""
    crc, covered = 0xFFFF, data[start:end]  # from 0 on: an index that may be negative costs a test
    size = end - start
    whole = size // _AT_ONCE * _AT_ONCE
    for k in range(0, whole, _AT_ONCE):  # look-ups that do not wait for each other; six need not wait for ``crc``
        later = _CRC[5, covered[k + 2]] ^ _CRC[4, covered[k + 3]] ^ _CRC[3, covered[k + 4]]
        later ^= _CRC[2, covered[k + 5]] ^ _CRC[1, covered[k + 6]] ^ _CRC[0, covered[k + 7]]
        one, two = (crc ^ int(covered[k])) & 0xFF, (crc >> 8 ^ int(covered[k + 1])) & 0xFF
        crc = int(_CRC[7, one] ^ _CRC[6, two] ^ later)
    for k in range(whole, size):
        crc = crc >> 8 ^ int(_CRC[0, (crc ^ int(covered[k])) & 0xFF])
    return crc >> 8 ^ int(_CRC[0, (crc ^ extra) & 0xFF])


@law
def has_space(port: Port) -> bool:
    """Whether the longest frame fits behind those that wait."""
    return port.out_count < OUT_FRAMES and port.out_size + FRAME_MAX <= OUT_BYTES


@law
def open_frame(port: Port, address: int) -> int:
    """Address of the payload of the next frame: zeros, at full length. There is space (``has_space``)."""
    header = HEADER_V2 if port.version == 2 else HEADER_V1
    start = address + OUT + port.out_size + header
    payload = bytes_at(start, PAYLOAD_MAX)
    for k in range(PAYLOAD_MAX):
        payload[k] = 0
    return start


@law
def seal(frame: Bytes, version: int, number: int, sender: Sender) -> int:
    """Write header and checksum around a payload at full length that has been written behind the header's bytes.

    Trailing zeros of a MAVLink 2 payload are left out. Returns the length of the frame; 0: version 1 cannot carry it.
    """
    row = row_of(number)
    if version == 2:
        size = int(SIZES[row])
        while size > 1 and frame[HEADER_V2 + size - 1] == 0:
            size -= 1
        frame[0] = MARK_V2
        frame[1] = size
        frame[2] = 0
        frame[3] = 0
        frame[4] = sender.sequence
        frame[5] = sender.system
        frame[6] = sender.component
        frame[7] = number & 0xFF
        frame[8] = number >> 8 & 0xFF
        frame[9] = number >> 16
        end = HEADER_V2 + size
    elif number > 255:
        return 0
    else:
        size = int(BASE_SIZES[row])
        frame[0] = MARK_V1
        frame[1] = size
        frame[2] = sender.sequence
        frame[3] = sender.system
        frame[4] = sender.component
        frame[5] = number
        end = HEADER_V1 + size
    crc = crc_of(frame, 1, end, int(CRC_EXTRAS[row]))
    frame[end] = crc & 0xFF
    frame[end + 1] = crc >> 8
    return end + CHECKSUM


@law
def close_frame(port: Port, address: int, number: int) -> None:
    """Send the message ``number`` whose payload has been written to ``open_frame``'s address."""
    frame = bytes_at(address + OUT + port.out_size, FRAME_MAX)
    length = seal(frame, port.version, number, Sender(port.sequence, port.system, COMPONENT))
    if length == 0:
        return
    port.out_size += length
    port.out_end[port.out_count] = port.out_size
    port.out_count += 1
    port.sequence = (port.sequence + 1) & 0xFF
    port.sent += 1


@inlined
def number_at(data: Bytes, k: int) -> int:
    """A byte as an integer of full width: Numba keeps ``int(byte)`` at eight bits."""
    return data[k] + 0


@law
def find(data: Bytes, at: int, size: int) -> Found:
    """The next whole frame from ``at`` on in the first ``size`` bytes of ``data``.

    A header that cannot be right (unknown message, payload longer than the message, unknown incompatibility flag) or a
    wrong checksum costs one byte: the search goes on right behind its start mark. Signed frames are accepted and their
    signature is not checked.
    """
    bad = 0
    while at < size:
        mark = data[at]
        if mark != MARK_V2 and mark != MARK_V1:
            at += 1
            continue
        version = 2 if mark == MARK_V2 else 1
        start = at + (HEADER_V2 if version == 2 else HEADER_V1)
        if start > size:
            break
        length = number_at(data, at + 1)
        flags, first = 0, at + 2  # of sequence, system, component, number
        number = number_at(data, at + 5)
        if version == 2:
            flags, first = number_at(data, at + 2), at + 4
            number = number_at(data, at + 7) | number_at(data, at + 8) << 8 | number_at(data, at + 9) << 16
        row = row_of(number)
        if row < 0 or length > SIZES[row] or flags & ~SIGNED != 0:
            at += 1
            continue
        stop = start + length
        after = stop + CHECKSUM + (SIGNATURE if flags != 0 else 0)
        if after > size:
            break
        if crc_of(data, at + 1, stop, int(CRC_EXTRAS[row])) != number_at(data, stop) | number_at(data, stop + 1) << 8:
            bad += 1
            at += 1
            continue
        sender = Sender(number_at(data, first), number_at(data, first + 1), number_at(data, first + 2))
        return Found(at, after, version, number, sender, start, length, bad)
    return Found(at, 0, 0, 0, Sender(0, 0, 0), 0, 0, bad)


@law
def next_frame(port: Port, address: int) -> bool:
    """Go to the next whole frame in what came in; False when there is none yet."""
    found = find(bytes_at(address + INCOMING, port.in_size), port.in_at, port.in_size)
    port.bad_checksums += found.bad
    if found.end == 0:
        port.in_at = found.start
        return False
    sender = found.sender
    port.frame_start = found.start
    port.frame_end = found.end
    port.frame_number = found.number
    port.frame_payload = found.payload
    port.frame_payload_size = found.payload_size
    port.frame_sequence = sender.sequence
    port.frame_sender = sender.system << 8 | sender.component
    port.frame_version = found.version
    port.in_at = found.end
    port.received += 1
    note_sender(port, port.frame_sender, sender.sequence)
    if found.version == 2:
        port.received_v2 = True
        port.version = 2
    elif not port.received_v2:
        port.version = 1
    return True


@law
def copy_payload(data: Bytes, start: int, size: int, payload: Bytes) -> None:
    """A payload at full length, with the zeros that the sender left out."""
    sent = data[start : start + size]
    for k in range(size):
        payload[k] = sent[k]
    for k in range(size, PAYLOAD_BYTES):
        payload[k] = 0
