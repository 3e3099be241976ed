# SPDX-License-Identifier: BSD-3-Clause
"""Messages of a DataFlash log, binary (.bin) or text (.log), by the names of the fields that it says it has.

A log describes itself (FMT), and each version of ArduPilot has other messages and fields; nothing here knows them.
Cards lose pieces of logs: what is no message is passed over up to the next one, and so is a message whose time cannot
be.
"""

from __future__ import annotations

import mmap
import struct
from collections.abc import Collection, Iterator
from pathlib import Path
from typing import Any, BinaryIO, NamedTuple

from ..tlog import LogError
from .formats import FMT, FMT_NUMBER, HEAD, READ_DIVISORS, TYPES

MOST_BYTES = 1 << 32
"""Of a log."""
FAR_S = 600.0
"""A message that is later than the one before by more than this is right only if the next one agrees [s]."""
BACK_S = 2.0
"""Messages come in the order of their times, but for this [s]."""
_FMT_BYTES = FMT.packer.size
_CODES = {letter: code for letter, (_, code, _) in TYPES.items()} | {"a": "64s", "g": "e"}
_TEXTS = "nNZ"
_NO_TEXTS = "nNZa"
_LONGEST_LINE = 4096
_PAGE_BYTES = 4096
"""A log may end within a page that was not filled."""


class Row(NamedTuple):
    """One message."""

    name: str
    time: float | None
    """Since the autopilot's boot [s]; None: it has none of its own (ArduPilot 3.1)."""
    fields: dict[str, Any]
    """Values in the units of the log's documentation; degrees for latitudes and longitudes."""
    letters: dict[str, str]
    """Field -> the letter of its type."""


class Format(NamedTuple):
    """What an FMT says of a message."""

    name: str
    length: int
    """Bytes of a message with its head."""
    letters: dict[str, str]
    packed: struct.Struct


class DataFlash:
    """A log.

    Args:
        path: of the file.

    Raises:
        LogError: it cannot be read, is longer than ``MOST_BYTES``, or is no DataFlash log.
    """

    def __init__(self, path: str | Path) -> None:
        self.path = Path(path)
        self.skipped = 0
        """Bytes that are no messages."""
        self.left_out = 0
        """Messages whose time cannot be."""
        self.names: set[str] = set()
        """Messages that it has a format of."""
        try:
            size = self.path.stat().st_size
            with self.path.open("rb") as file:
                start = file.read(1 << 16)
        except OSError as error:
            raise LogError(f"log {str(path)!r} cannot be read: {error.strerror or error}") from None
        if size > MOST_BYTES:
            raise LogError(f"log {str(path)!r} has {size} bytes; at most {MOST_BYTES} are read")
        self.is_text = is_text(start)
        if not self.is_text and not is_binary(start):
            raise LogError(f"log {str(path)!r} is no DataFlash log: it has no FMT that describes its messages")

    def rows(self, names: Collection[str]) -> Iterator[Row]:
        """Messages of these names, in their order.

        Raises:
            LogError: the file cannot be read.
        """
        self.skipped = self.left_out = 0
        read = self._of_text if self.is_text else self._of_binary
        try:
            with self.path.open("rb") as file:
                yield from self._steady(read(file, names))
        except OSError as error:
            raise LogError(f"log {str(self.path)!r} cannot be read: {error.strerror or error}") from None

    def _steady(self, rows: Iterator[Row]) -> Iterator[Row]:
        """Without the messages whose time is far from those before and after."""
        last: float | None = None
        doubtful: Row | None = None
        for row in rows:
            if row.time is None:
                yield row
                continue
            if doubtful is not None and doubtful.time is not None:
                if abs(row.time - doubtful.time) <= FAR_S:
                    yield doubtful
                    last = doubtful.time
                else:
                    self.left_out += 1
                doubtful = None
            if last is None or not -BACK_S <= row.time - last <= FAR_S:
                doubtful = row
                continue
            last = max(last, row.time)
            yield row
        if doubtful is not None:
            self.left_out += 1

    # ------------------------------------------------------------------ binary

    def _of_binary(self, file: BinaryIO, names: Collection[str]) -> Iterator[Row]:
        with mmap.mmap(file.fileno(), 0, access=mmap.ACCESS_READ) as data:
            yield from self._scan(data, names)

    def _scan(self, data: mmap.mmap, names: Collection[str]) -> Iterator[Row]:
        formats: dict[int, Format] = {}
        lengths = [0] * 256
        lengths[FMT_NUMBER] = _FMT_BYTES
        at, size = 0, len(data)
        while at + 3 <= size:
            kind = data[at + 2]
            length = lengths[kind]
            if not length or data[at : at + 2] != HEAD:
                at = self._next(data, at + 1, lengths)
                continue
            if at + length > size:  # cut short
                return
            if kind == FMT_NUMBER:
                self._learn(data[at : at + _FMT_BYTES], formats, lengths)
            else:
                found = formats[kind]
                if found.name in names:
                    yield _row(found, data[at + 3 : at + length])
            at += length

    def _next(self, data: mmap.mmap, at: int, lengths: list[int]) -> int:
        """Where a message begins that another one, or the end, follows."""
        begin, size = at - 1, len(data)
        while True:
            at = data.find(HEAD, at)
            if at < 0 or at + 3 > size:
                self.skipped += size - begin if size - begin > _PAGE_BYTES else 0
                return size
            end = at + lengths[data[at + 2]]
            if end > at and (end >= size or data[end : end + 2] == HEAD[: size - end]):
                self.skipped += at - begin
                return at
            at += 1

    def _learn(self, body: bytes, formats: dict[int, Format], lengths: list[int]) -> None:
        *_, kind, length, name, letters, labels = FMT.packer.unpack(body)
        found = _format(_text(name), _text(letters), _text(labels))
        if kind != FMT_NUMBER and found is not None and found.length == length:
            formats[kind], lengths[kind] = found, length
            self.names.add(found.name)

    # ------------------------------------------------------------------ text

    def _of_text(self, file: BinaryIO, names: Collection[str]) -> Iterator[Row]:
        formats: dict[str, Format] = {}
        first = True
        while line := file.readline(_LONGEST_LINE):
            name, *values = (value.strip() for value in line.decode(errors="replace").split(","))
            if name == "FMT" and len(values) > 4:
                found = _format(values[2], values[3], ",".join(values[4:]).strip('"').replace(" ", ""))
                if found is not None:
                    formats[found.name] = found
                    self.names.add(found.name)
            elif name in formats and name in names:
                row = _text_row(formats[name], values)
                if row is None:
                    self.skipped += len(line)
                else:
                    yield row
            elif first and name and "MSG" in names:  # the firmware, before all else (ArduPilot 3.1)
                yield Row("MSG", None, {"Message": name}, {})
            first = first and not name


def is_binary(start: bytes) -> bool:
    """Whether a file that begins so is a binary log."""
    return HEAD + bytes([FMT_NUMBER]) in start


def is_text(start: bytes) -> bool:
    """Whether a file that begins so is a log as text."""
    return b"FMT, 128," in start and not start.startswith(HEAD)


def _format(name: str, letters: str, labels: str) -> Format | None:
    """None: it makes no sense."""
    columns = labels.split(",") if labels else []
    if len(columns) != len(letters) or len(set(columns)) != len(columns) or not all(c in _CODES for c in letters):
        return None
    packed = struct.Struct("<" + "".join(_CODES[letter] for letter in letters))
    return Format(name, 3 + packed.size, dict(zip(columns, letters, strict=True)), packed)


def _row(of: Format, body: bytes) -> Row:
    fields: dict[str, Any] = {}
    for (label, letter), value in zip(of.letters.items(), of.packed.unpack(body), strict=True):
        if letter in READ_DIVISORS:
            value /= READ_DIVISORS[letter]
        fields[label] = _text(value) if letter in _TEXTS else value
    return Row(of.name, _time(fields), fields, of.letters)


def _text_row(of: Format, values: list[str]) -> Row | None:
    if len(values) > len(of.letters) > 0:  # a text with commas
        kept = len(of.letters) - 1
        values = [*values[:kept], ", ".join(values[kept:])]
    fields: dict[str, Any] = {}
    for (label, letter), value in zip(of.letters.items(), values, strict=False):
        try:
            fields[label] = value if letter in _NO_TEXTS or (letter == "M" and not value.isdigit()) else float(value)
        except ValueError:
            return None
    return Row(of.name, _time(fields), fields, of.letters)


def _text(value: bytes) -> str:
    return value.split(b"\0", 1)[0].decode("utf-8", "replace")


def _time(fields: dict[str, Any]) -> float | None:
    """The time of a message, under the name that its version of ArduPilot has for it [s]."""
    if "T" in fields and "Week" in fields:  # of a GPS; its TimeMS is that of the week (ArduPilot 3.2)
        name = "T"
    else:  # Time: of a GPS, of the week (ArduPilot 3.0)
        name = next((name for name in ("TimeUS", "TimeMS", "Time") if name in fields), "")
    value = fields.get(name)
    return value * (1e-6 if name == "TimeUS" else 1e-3) if isinstance(value, (int, float)) else None
