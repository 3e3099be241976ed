# SPDX-License-Identifier: BSD-3-Clause
"""Tracks as bytes: whole quanta, second differences, zigzag, seven bits a byte, all in xz with its checksum.

Layout before xz: length of the header (4 bytes, little-endian), header (JSON: kind, home, events, number of samples),
then column by column. A flight of two minutes needs about 8 kB.
"""

from __future__ import annotations

import json
import lzma
from typing import Any, NamedTuple

import numpy as np

from ..core import documents
from ..vehicle.kinds import KINDS
from .track_columns import COLUMNS, LONGEST_S, QUANTA, STEP_US, Array, TrackError

MAGIC = b"SITLTRK\x01"
_PACKING = {"format": lzma.FORMAT_XZ, "check": lzma.CHECK_CRC32, "preset": 9 | lzma.PRESET_EXTREME}
_LONGEST = 1 << 26
"""Bytes of a track, unpacked: more are no flight of a vehicle."""
_MEMORY = 1 << 27
"""Bytes that unpacking needs besides: ours asks for 65 MiB."""
_LONGEST_NUMBER = 9
MOST_SAMPLES = int(LONGEST_S * 1e6) // STEP_US + 1
MOST_EVENTS = 1_000_000
"""Of each kind."""
_FAR = 1e12
"""No time, location or height is as far."""
_HEADER = ("kind", "home", "modes", "items", "texts", "armed", "samples")


class Content(NamedTuple):
    """What the bytes hold: fields of a ``Track``, under the same names."""

    kind: str
    home: tuple[float, float, float]
    modes: list[Any]
    items: list[Any]
    texts: list[Any]
    armed: list[Any]
    data: Array


def pack(track: Content) -> bytes:
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
        "samples": len(track.data),
    }
    text = json.dumps(header, separators=(",", ":")).encode()
    whole = np.round(track.data / QUANTA).astype(np.int64)
    columns = b"".join(_numbers(whole[:, k]) for k in range(len(COLUMNS)))
    return MAGIC + lzma.compress(len(text).to_bytes(4, "little") + text + columns, **_PACKING)  # type: ignore[arg-type]


def unpack(data: bytes) -> Content:
    """A track from bytes.

    Raises:
        TrackError: they are none, or damaged, or of more than a track holds (``LONGEST_S``, ``MOST_EVENTS``).
    """
    if not data.startswith(MAGIC):
        raise TrackError("these bytes are no track: they do not begin as one")
    try:
        unpacker = lzma.LZMADecompressor(lzma.FORMAT_XZ, memlimit=_MEMORY)
        raw = unpacker.decompress(data[len(MAGIC) :], _LONGEST)
        if not unpacker.eof:
            raise ValueError("it is too long, or incomplete")
        size = int.from_bytes(raw[:4], "little")
        header = documents.of_json(raw[4 : 4 + size])
        track, count = _of_header(header)
        track = track._replace(data=_columns(memoryview(raw)[4 + size :], count) * QUANTA)
        _check_times(track.data[:, 0])
    except (lzma.LZMAError, ValueError, KeyError, TypeError, EOFError, OverflowError) as error:
        raise TrackError(f"the track is damaged: {error}") from None
    return track


def _of_header(header: Any) -> tuple[Content, int]:
    """A track without samples, and how many it has."""
    kind, home, *events, count = (header[name] for name in _HEADER)
    if not isinstance(kind, str) or kind not in KINDS:
        raise ValueError(f"its vehicle is {kind!r}")
    if type(count) is not int or not 0 <= count <= MOST_SAMPLES:
        raise ValueError(f"it has {count!r} samples; 0 to {MOST_SAMPLES} are read")
    if not isinstance(home, list) or len(home) != 3 or not all(_is_number(value) for value in home):
        raise ValueError(f"its home is {home!r}")
    if not (abs(home[0]) <= 90.0 and abs(home[1]) <= 180.0):
        raise ValueError(f"its home is {home!r}")
    found: list[list[Any]] = []
    for name, types, rows in zip(_HEADER[2:], ((str,), (int,), (int, str), (bool,)), events, strict=False):
        if not isinstance(rows, list) or len(rows) > MOST_EVENTS:
            raise ValueError(f"its {name} are no list of at most {MOST_EVENTS}")
        for row in rows:
            if not isinstance(row, list) or len(row) != 1 + len(types) or not _is_number(row[0]):
                raise ValueError(f"one of its {name} is {row!r}")
            if any(type(value) is not type_ for value, type_ in zip(row[1:], types, strict=True)):
                raise ValueError(f"one of its {name} is {row!r}")
        found.append([tuple(row) for row in rows])
    modes, items, texts, armed = found
    location = (home[0], home[1], home[2])
    return Content(kind, location, modes, items, texts, armed, np.zeros((0, len(COLUMNS)))), count


def _is_number(value: Any) -> bool:
    return type(value) in (int, float) and abs(value) < _FAR


def _check_times(t: Array) -> None:
    if len(t) and not ((np.diff(t) > 0.0).all() and t[-1] - t[0] <= LONGEST_S and abs(t[0]) < _FAR):
        raise ValueError("the times of its samples do not rise, or go too far")


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


def _columns(raw: memoryview, count: int) -> Array:
    """(count, columns) whole numbers."""
    data = np.frombuffer(raw, np.uint8)
    ends = np.flatnonzero(data < 0x80) + 1
    if len(ends) != count * len(COLUMNS) or (len(ends) and ends[-1] != len(data)):
        raise ValueError(f"{len(ends)} numbers instead of {count * len(COLUMNS)}")
    whole = np.zeros((count, len(COLUMNS)), np.int64)
    begin = 0
    for k in range(len(COLUMNS) if count else 0):
        stops = ends[k * count : (k + 1) * count]
        values = _varints(data[begin : stops[-1]], stops - begin)
        begin = int(stops[-1])
        steps = np.where(values & 1, -(values >> 1) - 1, values >> 1)
        whole[:, k] = np.cumsum(np.cumsum(steps))
    return whole


def _varints(data: Array, ends: Array) -> Array:
    """Numbers of seven bits a byte that end before these offsets."""
    lengths = np.diff(ends, prepend=0)
    if int(lengths.max()) > _LONGEST_NUMBER:
        raise ValueError(f"a number of more than {_LONGEST_NUMBER} bytes")
    digit = np.arange(len(data)) - np.repeat(ends - lengths, lengths)
    return np.asarray(np.add.reduceat((data & np.uint8(0x7F)).astype(np.int64) << (7 * digit), ends - lengths))
