# SPDX-License-Identifier: BSD-3-Clause
"""Splits a MAVLink stream into frames without decoding them, so that unknown dialects pass."""

from __future__ import annotations

from ..bridge.frame import CHECKSUM, HEADER_V1, HEADER_V2, MARK_V1, MARK_V2, SIGNATURE, SIGNED

_STARTS = bytes((MARK_V1, MARK_V2))


class Cutter:
    """Splits a stream into frames by start mark and length. TCP loses nothing, so that it stays in step; what
    does not begin with a start mark is left out."""

    def __init__(self) -> None:
        self._rest = b""

    def feed(self, data: bytes) -> list[bytes]:
        """The frames completed by ``data``."""
        buffer = self._rest + data
        frames: list[bytes] = []
        at, end = 0, len(buffer)
        while at < end:
            if buffer[at] not in _STARTS:
                at += 1
                continue
            header = HEADER_V2 if buffer[at] == MARK_V2 else HEADER_V1
            if at + header > end:
                break
            size = header + buffer[at + 1] + CHECKSUM
            if header == HEADER_V2 and buffer[at + 2] & SIGNED:
                size += SIGNATURE
            if at + size > end:
                break
            frames.append(buffer[at : at + size])
            at += size
        self._rest = buffer[at:]
        return frames
