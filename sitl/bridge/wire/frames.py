# SPDX-License-Identifier: BSD-3-Clause
"""Frames in the core: closed behind a payload, and cut out of the client's bytes.

Source: https://mavlink.io/en/guide/serialization.html (packet format, zero truncation, checksum).
"""

from __future__ import annotations

import numpy as np

from ...core.kernels import law
from ...core.memory import Bytes, bytes_at
from ..frame import CHECKSUM, HEADER_V1, HEADER_V2, MARK_V1, MARK_V2, SIGNATURE, SIGNED
from .port import INCOMING, OUT, OUT_BYTES, OUT_FRAMES, Port, note_sender
from .tables import BASE_SIZES, CRC_EXTRAS, PAYLOAD_MAX, SIZES, row_of

COMPONENT = 1
"""MAV_COMP_ID_AUTOPILOT1"""
FRAME_MAX = HEADER_V2 + PAYLOAD_MAX + CHECKSUM


def _crc_table() -> list[int]:
    table = []
    for byte in range(256):
        crc = byte
        for _ in range(8):
            crc = crc >> 1 ^ (0x8408 if crc & 1 else 0)
        table.append(crc)
    return table


_CRC = np.array(_crc_table())


@law
def crc_of(data: Bytes, start: int, end: int, extra: int) -> int:
    """CRC-16/MCRF4XX of bytes ``start`` .. ``end`` - 1 and the message's own seed."""
    crc = 0xFFFF
    for k in range(start, end):
        crc = crc >> 8 ^ int(_CRC[(crc ^ int(data[k])) & 0xFF])
    return crc >> 8 ^ int(_CRC[(crc ^ extra) & 0xFF])


@law
def has_room(port: Port) -> bool:
    """Whether the longest frame fits behind those that wait."""
    return port.out_count < OUT_FRAMES and port.out_size + FRAME_MAX <= OUT_BYTES


@law
def open_frame(port: Port, address: int) -> int:
    """Address of the payload of the next frame: zeros, at full length. There is room (``has_room``)."""
    header = HEADER_V2 if port.version == 2 else HEADER_V1
    start = address + OUT + port.out_size + header
    payload = bytes_at(start, PAYLOAD_MAX)
    for k in range(PAYLOAD_MAX):
        payload[k] = 0
    return start


@law
def close_frame(port: Port, address: int, number: int) -> None:
    """Send the message ``number`` whose payload has been written to ``open_frame``'s address."""
    row = row_of(number)
    start = port.out_size
    data = bytes_at(address + OUT + start, FRAME_MAX)
    if port.version == 2:
        size = int(SIZES[row])
        while size > 1 and data[HEADER_V2 + size - 1] == 0:
            size -= 1
        data[0] = MARK_V2
        data[1] = size
        data[2] = 0
        data[3] = 0
        data[4] = port.sequence
        data[5] = port.system
        data[6] = COMPONENT
        data[7] = number & 0xFF
        data[8] = number >> 8 & 0xFF
        data[9] = number >> 16
        end = HEADER_V2 + size
    elif number > 255:  # version 1 cannot carry it
        return
    else:
        size = int(BASE_SIZES[row])
        data[0] = MARK_V1
        data[1] = size
        data[2] = port.sequence
        data[3] = port.system
        data[4] = COMPONENT
        data[5] = number
        end = HEADER_V1 + size
    crc = crc_of(data, 1, end, int(CRC_EXTRAS[row]))
    data[end] = crc & 0xFF
    data[end + 1] = crc >> 8
    port.out_size += end + CHECKSUM
    port.out_end[port.out_count] = port.out_size
    port.out_count += 1
    port.sequence = (port.sequence + 1) & 0xFF
    port.sent += 1


@law
def next_frame(port: Port, address: int) -> bool:
    """Go to the next whole frame in what came in; False when there is none yet.

    A header that cannot be right (unknown message, payload longer than the message, unknown incompatibility flag) or a
    wrong checksum costs one byte: the search goes on right behind its start mark. Signed frames are accepted and their
    signature is not checked.
    """
    data = bytes_at(address + INCOMING, port.in_size)
    at = port.in_at
    while at < port.in_size:
        mark = data[at]
        if mark != MARK_V2 and mark != MARK_V1:
            at += 1
            continue
        version = 2 if mark == MARK_V2 else 1
        start = at + (HEADER_V2 if version == 2 else HEADER_V1)
        if start > port.in_size:
            break
        size = int(data[at + 1])
        flags, first = 0, at + 2  # of sequence, system, component, number
        number = int(data[at + 5])
        if version == 2:
            flags, first = int(data[at + 2]), at + 4
            number = int(data[at + 7]) | int(data[at + 8]) << 8 | int(data[at + 9]) << 16
        row = row_of(number)
        if row < 0 or size > SIZES[row] or flags & ~SIGNED != 0:
            at += 1
            continue
        stop = start + size
        after = stop + CHECKSUM + (SIGNATURE if flags != 0 else 0)
        if after > port.in_size:
            break
        if crc_of(data, at + 1, stop, int(CRC_EXTRAS[row])) != int(data[stop]) | int(data[stop + 1]) << 8:
            port.bad_checksums += 1
            at += 1
            continue
        port.frame_start = at
        port.frame_end = after
        port.frame_number = number
        port.frame_payload = start
        port.frame_payload_size = size
        port.frame_sequence = int(data[first])
        port.frame_sender = int(data[first + 1]) << 8 | int(data[first + 2])
        port.frame_version = version
        port.in_at = after
        port.received += 1
        note_sender(port, port.frame_sender, port.frame_sequence)
        if version == 2:
            port.heard_v2 = True
            port.version = 2
        elif not port.heard_v2:
            port.version = 1
        return True
    port.in_at = at
    return False
