# SPDX-License-Identifier: BSD-3-Clause
"""Tracks as bytes: whole quanta, second differences, zigzag, seven bits a byte, all in xz with its checksum.

Layout before xz: length of the header (4 bytes, little-endian), header (JSON: kind, home, events, number of samples),
then column by column. A flight of two minutes needs about 8 kB.
"""

from __future__ import annotations

import json
import lzma
from typing import Any

import numpy as np

from ..core import documents
from .track import COLUMNS, QUANTA, Array, Track, TrackError

MAGIC = b"SITLTRK\x01"
_PACKING = {"format": lzma.FORMAT_XZ, "check": lzma.CHECK_CRC32, "preset": 9 | lzma.PRESET_EXTREME}
_LONGEST = 1 << 26
"""Bytes of a track, unpacked: more are no flight of a vehicle."""
_HEADER = ("kind", "home", "modes", "items", "texts", "armed", "samples")


def pack(track: Track) -> bytes:
    """A track as bytes; equal tracks give equal bytes."""

    def rounded(events: list[Any]) -> list[Any]:
        return [[round(event[0], 4), *event[1:]] for event in events]

    header = {
        "kind": track.kind,
        "home": list(track.home),
        "modes": rounded(track.modes),
        "items": rounded(track.items),
        "texts": rounded(track.texts),
        "armed": rounded(track.armed),
        "samples": len(track),
    }
    text = json.dumps(header, separators=(",", ":")).encode()
    whole = np.round(track.data / QUANTA).astype(np.int64)
    columns = b"".join(_numbers(whole[:, k]) for k in range(len(COLUMNS)))
    return MAGIC + lzma.compress(len(text).to_bytes(4, "little") + text + columns, **_PACKING)  # type: ignore[arg-type]


def unpack(data: bytes) -> Track:
    """A track from bytes.

    Raises:
        TrackError: they are none, or damaged.
    """
    if not data.startswith(MAGIC):
        raise TrackError("these bytes are no track: they do not begin as one")
    try:
        unpacker = lzma.LZMADecompressor(lzma.FORMAT_XZ)
        raw = unpacker.decompress(data[len(MAGIC) :], _LONGEST)
        if not unpacker.eof:
            raise ValueError("it is too long, or incomplete")
        size = int.from_bytes(raw[:4], "little")
        header = documents.of_json(raw[4 : 4 + size])
        kind, home, modes, items, texts, armed, count = (header[name] for name in _HEADER)
        whole = _columns(raw[4 + size :], int(count))
    except (lzma.LZMAError, ValueError, KeyError, TypeError, EOFError) as error:
        raise TrackError(f"the track is damaged: {error}") from None
    return Track(
        kind,
        whole * QUANTA,
        tuple(home),
        [(t, mode) for t, mode in modes],
        [(t, seq) for t, seq in items],
        [(t, severity, text) for t, severity, text in texts],
        [(t, bool(state)) for t, state in armed],
    )


def _numbers(column: Array) -> bytes:
    """Whole numbers whose steps are alike, as bytes."""
    steps = np.diff(column, n=2, prepend=np.zeros(2, np.int64))
    values = np.where(steps < 0, -2 * steps - 1, 2 * steps)
    out = bytearray()
    for value in values.tolist():
        while value > 0x7F:
            out.append(value & 0x7F | 0x80)
            value >>= 7
        out.append(value)
    return bytes(out)


def _columns(raw: bytes, count: int) -> Array:
    """(count, columns) whole numbers."""
    data = np.frombuffer(raw, np.uint8).astype(np.int64)
    last = data < 0x80
    if int(last.sum()) != count * len(COLUMNS):
        raise ValueError(f"{int(last.sum())} numbers instead of {count * len(COLUMNS)}")
    number = np.concatenate(([0], np.cumsum(last)[:-1])) if len(data) else np.zeros(0, np.int64)
    begin = np.concatenate(([0], np.flatnonzero(last)[:-1] + 1)) if len(data) else np.zeros(0, np.int64)
    place = np.arange(len(data)) - begin[number] if len(data) else number
    if len(place) and int(place.max()) > 8:
        raise ValueError("a number of more than nine bytes")
    values = np.zeros(count * len(COLUMNS), np.int64)
    np.add.at(values, number, (data & 0x7F) << (7 * place))
    steps = np.where(values & 1, -(values >> 1) - 1, values >> 1).reshape(len(COLUMNS), count)
    return np.cumsum(np.cumsum(steps, axis=1), axis=1).T
