# SPDX-License-Identifier: BSD-3-Clause
"""A DataFlash log, binary (.bin) or text (.log), as NumPy columns: long logs of any version, read fast.

A log describes itself (FMT), and each version of ArduPilot has other messages and fields; nothing here knows them.
A binary file is read in pieces. In each, NumPy finds the heads of messages; a message counts when another head, or the
end of the file, follows it. So pieces that a card lost, and marks that happen to stand within a message, are passed
over.
"""

from __future__ import annotations

import os
from collections.abc import Callable, Collection, Iterator, Mapping
from pathlib import Path
from typing import Any, BinaryIO

import numpy as np
from numpy.lib import recfunctions

from ..tlog import LogError
from . import text
from .formats import CLOCK_FIELDS, FMT, FMT_NUMBER, HEAD, TYPES, UNITS, clock, is_binary, is_text
from .tables import Array, Table, Tables

Progress = Callable[[int, int], None]
"""Called with the bytes that are read, and all there are."""

_NUMPY = {letter: kind for letter, (kind, _, _) in TYPES.items()} | {"a": "(32,)<i2", "g": "<f2"}
_FMT, _FMT_LENGTH = np.dtype(FMT.columns()), FMT.packer.size
_HELP = ("FMTU", "UNIT", "MULT", "PARM", "MSG", "VER")
"""Read besides those that are asked for."""
_START = 1 << 16
"""Bytes that tell whether a file is a log."""
MOST_BYTES = 1 << 32
"""Of a log."""
_PIECE = 1 << 21
"""Bytes that are read at once."""
_PAGE_BYTES = 4096
"""A log may end within a page of the card that was not filled."""
_LONGEST = 256
"""More than any message has."""


class Columns(Tables):
    """A log.

    Args:
        path: of a .bin, or a .log as text.
        names: messages that are wanted; None: all. A mapping says of each which fields are kept; None: all of them.
        progress: called with how far it is.

    Raises:
        LogError: it cannot be read, is longer than ``MOST_BYTES``, or is no DataFlash log.
    """

    def __init__(
        self,
        path: str | Path,
        names: Collection[str] | Mapping[str, Collection[str] | None] | None = None,
        progress: Progress | None = None,
    ) -> None:
        super().__init__(path)
        self.skipped = 0
        """Bytes that are no messages."""
        self.truncated = False
        """Whether the file ends within a message."""
        wanted = None if names is None else {*names, *_HELP}
        self._fields = {name: set(kept) for name, kept in names.items() if kept} if isinstance(names, Mapping) else {}
        try:
            if self._is_text():
                found = text.read(self.path, wanted)
                self._tables, self.formats, self.skipped = found.tables, found.formats, found.skipped
            else:
                self._tables = self._of_binary(wanted, progress)
        except OSError as error:
            raise LogError(f"log {str(path)!r} cannot be read: {error.strerror or error}") from None
        self._drop_odd_times()
        self._set_units()

    def _is_text(self) -> bool:
        with self.path.open("rb") as file:
            size, start = os.fstat(file.fileno()).st_size, file.read(_START)
        if size > MOST_BYTES:
            raise LogError(f"log {str(self.path)!r} has {size} bytes; at most {MOST_BYTES} are read")
        if not is_text(start) and not is_binary(start):
            raise LogError(f"log {str(self.path)!r} is no DataFlash log: it has no FMT that describes its messages")
        return is_text(start)

    # ------------------------------------------------------------------ binary

    def _of_binary(self, wanted: set[str] | None, progress: Progress | None) -> dict[str, Table]:
        formats = _Formats(self._fields)
        parts: dict[int, list[Array]] = {}
        times: dict[int, list[Array]] = {}
        with self.path.open("rb") as file:
            total = os.fstat(file.fileno()).st_size
            for piece, is_last in _pieces(file, self):
                for kind, rows, before in formats.split(piece, is_last, self, wanted):
                    parts.setdefault(kind, []).append(rows)
                    if before is not None:
                        times.setdefault(kind, []).append(before)
                if progress is not None:
                    progress(file.tell(), total)
        tables: dict[str, Table] = {}
        for kind in list(parts):
            of = formats.known[kind]
            raw = np.concatenate(parts.pop(kind))
            if of.name in tables:  # two numbers of one name: the longer table counts
                if len(tables[of.name]) >= len(raw):
                    continue
            letters = {name: of.letters[name] for name in raw.dtype.names or ()}
            before = None
            if kind in times and formats.began is not None:
                before = np.nan_to_num(np.concatenate(times[kind]), nan=formats.began)
            tables[of.name] = Table(of.name, raw, letters, {}, before)
        self.formats = {of.name for of in formats.known.values()}
        return tables

    def _set_units(self) -> None:
        if "FMTU" not in self or "FMT" not in self or "UnitIds" not in self._tables["FMTU"]:
            return
        kinds = dict(zip(self["FMT"]["Type"].astype(int).tolist(), self["FMT"]["Name"].tolist()))
        table = self["FMTU"]
        for kind, letters in zip(table["FmtType"].astype(int).tolist(), table["UnitIds"].tolist()):
            name = kinds.get(kind)
            if name in self._tables:
                found = self._tables[name]
                found.units = {field: UNITS.get(unit, "") for field, unit in zip(found.letters, letters)}


class _Format:
    """What an FMT says of a message."""

    def __init__(self, name: str, letters: dict[str, str], fields: Collection[str] = ()) -> None:
        self.name, self.letters = name, letters
        self.dtype = np.dtype([(label, _NUMPY[letter]) for label, letter in letters.items()])
        self.kept = [label for label in letters if label in fields or label in CLOCK_FIELDS] if fields else None
        """Fields that are kept, where not all are."""
        self.clock = clock(letters)


class _Formats:
    """The formats that are known so far, and the messages of a piece by them."""

    def __init__(self, fields: Mapping[str, Collection[str]]) -> None:
        self._fields = fields
        self.known: dict[int, _Format] = {FMT_NUMBER: _Format("FMT", {field.label: field.kind for field in FMT.fields})}
        self._lengths = np.zeros(256, np.int64)
        self._lengths[FMT_NUMBER] = _FMT_LENGTH
        self.began: float | None = None
        """Time of the first message that has one [s]."""
        self._time = np.nan
        """Of the last one."""

    def split(
        self, piece: _Piece, is_last: bool, log: Columns, wanted: set[str] | None
    ) -> Iterator[tuple[int, Array, Array | None]]:
        """(Number of the message, its rows, the times before them if they have none) for all that are in a piece; sets
        how much of the piece is used."""
        data = piece.data
        marks = np.zeros(len(data) + _LONGEST, bool)
        marks[: max(len(data) - 2, 0)] = (data[:-2] == HEAD[0]) & (data[1:-1] == HEAD[1])
        heads = np.flatnonzero(marks)
        kinds = data[heads + 2]
        self._learn(data, heads[kinds == FMT_NUMBER], marks)
        lengths = self._lengths[kinds]
        ends = heads + lengths
        # A head of an unknown message is a mark that may follow another message, and no message itself.
        good = (lengths > 0) & (ends <= len(data))
        closes = marks[np.minimum(ends, len(marks) - 1)]
        at_end = (ends > len(data) - 3) & (is_last | (ends < len(data) - 2))
        good &= closes | at_end
        heads, kinds, ends = heads[good], kinds[good], ends[good]
        keep = _chain(heads, ends)
        heads, kinds, ends = heads[keep], kinds[keep], ends[keep]
        used = int(ends[-1]) if len(ends) else 0
        if is_last:
            rest = len(data) - used
            log.truncated = 0 < rest < _LONGEST and bool(np.any(data[used:]))
            log.skipped += rest if rest > _PAGE_BYTES else 0
        piece.used = used if is_last or len(data) - used < 4 * _LONGEST else len(data) - 2 * _LONGEST
        log.skipped += max(piece.used - int((ends - heads).sum()), 0)
        order = np.argsort(kinds, kind="stable")
        sorted_kinds = kinds[order]
        there = [
            (kind, self.known[kind])
            for kind in np.unique(sorted_kinds).tolist()
            if wanted is None or kind == FMT_NUMBER or self.known[kind].name in wanted
        ]
        times = self._times(data, heads, kinds, any(of.clock is None and of.name != "FMT" for _, of in there))
        for kind, of in there:
            begin, end = np.searchsorted(sorted_kinds, [kind, kind + 1])
            which = order[begin:end]
            rows = _gather(data, heads[which] + 3, of.dtype)
            before = None if times is None or of.clock is not None or kind == FMT_NUMBER else times[which]
            yield kind, rows if of.kept is None else recfunctions.repack_fields(rows[of.kept]), before

    def _times(self, data: Array, heads: Array, kinds: Array, are_needed: bool) -> Array | None:
        """Of each message, its own or that of the one before; None where they are not needed."""
        is_timed = np.array([number in self.known and self.known[number].clock is not None for number in range(256)])
        timed = np.flatnonzero(is_timed[kinds])
        if not len(timed):
            return np.full(len(heads), self._time) if are_needed else None
        if not are_needed:  # the first and the last one tell what later pieces need
            timed = timed[[0, -1]]
        found = np.zeros(len(timed))
        for kind in np.unique(kinds[timed]).tolist():
            of = self.known[kind]
            assert of.clock is not None
            field, scale = of.clock
            which = kinds[timed] == kind
            found[which] = _gather(data, heads[timed[which]] + 3, of.dtype)[field].astype(np.float64) * scale
        if self.began is None:
            self.began = float(found[0])
        before, self._time = self._time, float(found[-1])
        if not are_needed:
            return None
        last = np.searchsorted(timed, np.arange(len(heads)), "right") - 1
        return np.where(last >= 0, found[np.maximum(last, 0)], before)

    def _learn(self, data: Array, heads: Array, marks: Array) -> None:
        heads = heads[heads + _FMT_LENGTH <= len(data)]
        heads = heads[marks[heads + _FMT_LENGTH] | (heads + _FMT_LENGTH > len(data) - 3)]
        for row in _gather(data, heads, _FMT):
            kind, length = int(row["Type"]), int(row["Length"])
            name, letters, labels = (row[f].decode("ascii", "replace") for f in ("Name", "Format", "Columns"))
            columns = labels.split(",") if labels else []
            if kind in self.known or len(columns) != len(letters) or len(set(columns)) != len(columns):
                continue
            if not all(letter in _NUMPY for letter in letters):
                continue
            found = _Format(name, dict(zip(columns, letters)), self._fields.get(name, ()))
            if 3 + found.dtype.itemsize == length:
                self.known[kind], self._lengths[kind] = found, length


def _chain(heads: Array, ends: Array) -> Array:
    """Which of the heads are messages, when each begins where one before has ended, or later."""
    keep = np.ones(len(heads), bool)
    following = np.searchsorted(heads, ends)
    at = 0
    for k in np.flatnonzero(following != np.arange(1, len(heads) + 1)).tolist():
        if k >= at:
            at = int(following[k])
            keep[k + 1 : at] = False
    return keep


def _gather(data: Array, at: Array, dtype: np.dtype[Any]) -> Array:
    """Rows that begin at these offsets."""
    size = dtype.itemsize
    if not len(at) or not size:
        return np.zeros(len(at), dtype)
    windows = np.lib.stride_tricks.as_strided(data, (len(data) - size + 1, size), (1, 1), writeable=False)
    return np.ascontiguousarray(windows[at]).view(dtype)[:, 0]


class _Piece:
    """Bytes of a file."""

    def __init__(self, data: Array) -> None:
        self.data = data
        self.used = 0
        """How many of them were messages, or are given up."""


def _pieces(file: BinaryIO, log: Columns) -> Iterator[tuple[_Piece, bool]]:
    """(Piece, whether it is the last); what one did not use begins the next."""
    rest = b""
    while True:
        block = file.read(_PIECE)
        is_last = len(block) < _PIECE
        piece = _Piece(np.frombuffer(rest + block, np.uint8))
        yield piece, is_last
        if is_last:
            return
        rest = piece.data[piece.used :].tobytes()
