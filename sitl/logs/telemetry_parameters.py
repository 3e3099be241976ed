# SPDX-License-Identifier: BSD-3-Clause
"""Parameters that a ground station got as a file by FTP, put together again from the frames of a telemetry log.

Sources: https://mavlink.io/en/services/ftp.html (the payload), and ArduPilot's page on its file of parameters
(``@PARAM/param.pck``): https://github.com/ArduPilot/ardupilot/tree/master/libraries/AP_Filesystem.
"""

from __future__ import annotations

import struct
from collections.abc import Iterable

_HEAD = struct.Struct("<HBBBBBBI")
"""Sequence, session, opcode, size, requested opcode, whether a burst is complete, padding, offset."""
_ACK, _OPEN, _READ, _BURST = 128, 4, 5, 15
_MAGICS = (b"\x1b\x67", b"\x1c\x67")
_MOST_BYTES = 1 << 20
_VALUES = {number: struct.Struct("<" + code) for number, code in ((1, "b"), (2, "h"), (3, "i"), (4, "f"))}


def by_ftp(payloads: Iterable[object]) -> dict[str, float]:
    """Name -> value, of the last file with parameters that is whole; empty: there is none.

    Args:
        payloads: of FILE_TRANSFER_PROTOCOL messages that the vehicle sent, in their order.
    """
    found: dict[str, float] = {}
    pieces: dict[int, bytes] = {}
    for payload in payloads:
        data = bytes(payload)  # type: ignore[call-overload]
        _, _, opcode, size, asked, _, _, offset = _HEAD.unpack_from(data)
        if opcode != _ACK or asked not in (_OPEN, _READ, _BURST):
            continue
        if asked == _OPEN:  # another file
            found = _decoded(pieces) or found
            pieces = {}
        else:
            pieces[offset] = data[_HEAD.size : _HEAD.size + size]
    return _decoded(pieces) or found


def _decoded(pieces: dict[int, bytes]) -> dict[str, float]:
    if not pieces.get(0, b"").startswith(_MAGICS):
        return {}
    data = bytearray()
    for offset in sorted(pieces):
        if offset > len(data) or offset > _MOST_BYTES:  # a piece is missing
            return {}
        data[offset : offset + len(pieces[offset])] = pieces[offset]
    return _unpacked(bytes(data))


def _unpacked(data: bytes) -> dict[str, float]:
    """Name -> value of the file; empty when it is damaged."""
    has_defaults = data[:2] == _MAGICS[1]
    count, at, name = int.from_bytes(data[2:4], "little"), 6, b""
    found: dict[str, float] = {}
    try:
        while at < len(data) and len(found) < count:
            if not data[at]:  # padding
                at += 1
                continue
            kind, lengths = data[at], data[at + 1]
            end = at + 3 + (lengths >> 4)
            name = name[: lengths & 15] + data[at + 2 : end]
            value = _VALUES[kind & 15]
            found[name.decode("ascii")] = float(value.unpack_from(data, end)[0])
            at = end + value.size * (2 if has_defaults and kind >> 4 & 1 else 1)
    except (KeyError, IndexError, struct.error, UnicodeDecodeError):
        return {}
    return found if len(found) == count and at <= len(data) else {}
