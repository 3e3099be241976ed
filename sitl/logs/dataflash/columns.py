# SPDX-License-Identifier: BSD-3-Clause
"""A DataFlash log as NumPy columns: long logs, read fast (``reader`` gives the messages of one in their order).

The file is read in pieces. In each, NumPy finds the heads of messages; a message counts when another head, or the end
of the file, follows it. So pieces that a card lost, and marks that happen to stand within a message, are passed over.
"""

from __future__ import annotations

import os
from collections.abc import Callable, Collection, Iterator
from pathlib import Path
from typing import Any, BinaryIO

import numpy as np

from .. import firmwares
from ..tlog import LogError
from .formats import FMT, FMT_NUMBER, HEAD, READ_DIVISORS, TYPES, UNITS
from .reader import FAR_S, DataFlash

Array = np.ndarray[Any, Any]
Progress = Callable[[int, int], None]
"""Called with the bytes that are read, and all there are."""

_NUMPY = {letter: kind for letter, (kind, _, _) in TYPES.items()} | {"a": "(32,)<i2", "g": "<f2"}
_FMT, _FMT_LENGTH = np.dtype(FMT.columns()), FMT.packer.size
_HELP = ("FMTU", "UNIT", "MULT", "PARM", "MSG", "VER")
"""Read besides those that are asked for."""
_INSTANCES = ("I", "C", "IMU", "Instance", "Id")
_PIECE = 1 << 21
"""Bytes that are read at once."""
_LONGEST = 256
"""More than any message has."""


class Table:
    """The messages of one name.

    Args:
        name: of the message.
        raw: as they are in the file, a structured array.
        letters: field -> letter of its type.
        units: field -> unit, as far as the log has it.
    """

    def __init__(self, name: str, raw: Array, letters: dict[str, str], units: dict[str, str]) -> None:
        self.name, self.raw, self.letters, self.units = name, raw, letters, units

    def __len__(self) -> int:
        return len(self.raw)

    def __contains__(self, field: object) -> bool:
        return field in self.letters

    @property
    def fields(self) -> tuple[str, ...]:
        """Names of its fields."""
        return tuple(self.letters)

    def __getitem__(self, field: str) -> Array:
        """A column: numbers as float64, degrees for latitudes and longitudes; texts as ``str``.

        Raises:
            LogError: the messages have no such field.
        """
        if field not in self.letters:
            raise LogError(f"{self.name} of this log has no field {field!r}; it has {', '.join(self.letters)}")
        column, letter = self.raw[field], self.letters[field]
        if column.dtype.kind == "S":
            return np.char.decode(column, "utf-8", "replace")
        if column.dtype.kind == "U":
            return column
        values = column.astype(np.float64)
        return values / READ_DIVISORS[letter] if letter in READ_DIVISORS else values

    @property
    def time(self) -> Array:
        """Since the autopilot's boot [s]; empty when the messages have none."""
        for name, scale in (("TimeUS", 1e-6), ("TimeMS", 1e-3)):
            if name in self.letters:
                return self.raw[name].astype(np.float64) * scale
        return np.zeros(0)

    def instance(self, number: int = 0) -> Table:
        """The messages of one sensor, filter ...; all of them when they have no number."""
        label = next((label for label in _INSTANCES if label in self.letters), None)
        if label is None or not len(self):
            return self
        return self.where(self.raw[label] == number)

    def where(self, which: Array) -> Table:
        """Those messages that a mask, a slice or numbers say."""
        return Table(self.name, self.raw[which], self.letters, self.units)

    @property
    def rate(self) -> float:
        """Messages a second: the median over the log [Hz]; 0 with less than two."""
        steps = np.diff(self.time)
        steps = steps[steps > 0.0]
        return float(1.0 / np.median(steps)) if len(steps) else 0.0


class Columns:
    """A log.

    Args:
        path: of a .bin, or a .log as text.
        names: messages that are wanted; None: all.
        progress: is told how far it is.

    Raises:
        LogError: it cannot be read, or is no DataFlash log.
    """

    def __init__(
        self, path: str | Path, names: Collection[str] | None = None, progress: Progress | None = None
    ) -> None:
        self.path = Path(path)
        self.skipped = 0
        """Bytes that are no messages."""
        self.left_out = 0
        """Messages whose time cannot be."""
        self.truncated = False
        """Whether the file ends within a message."""
        log = DataFlash(path)
        wanted = None if names is None else {*names, *_HELP}
        try:
            self._tables = _of_text(log, wanted) if log.is_text else self._of_binary(wanted, progress)
        except OSError as error:
            raise LogError(f"log {str(path)!r} cannot be read: {error.strerror or error}") from None
        self._drop_odd_times()
        self._set_units()

    def __contains__(self, name: object) -> bool:
        return name in self._tables and len(self._tables[str(name)]) > 0

    def __iter__(self) -> Iterator[str]:
        return (name for name, table in self._tables.items() if len(table))

    def __getitem__(self, name: str) -> Table:
        """The messages of a name.

        Raises:
            LogError: the log has none; the message lists those there are.
        """
        if name not in self:
            raise LogError(f"log {str(self.path)!r} has no {name}; it has {', '.join(sorted(self)) or 'nothing'}")
        return self._tables[name]

    # ------------------------------------------------------------------ what it is of

    @property
    def parameters(self) -> dict[str, float]:
        """The last value of each."""
        if "PARM" not in self:
            return {}
        table = self["PARM"]
        return dict(zip(table["Name"].tolist(), table["Value"].tolist()))

    @property
    def texts(self) -> list[tuple[float, str]]:
        """(Time [s], text) of all MSG; one that was cut into pieces is in pieces."""
        if "MSG" not in self:
            return []
        table = self["MSG"]
        return list(zip(table.time.tolist(), table["Message"].tolist()))

    @property
    def firmware(self) -> str:
        """As it names itself: "ArduCopter V4.6.3 (3fc7011a)"; "" when the log does not say it."""
        named = next((text for _, text in self.texts if any(firmwares.of_text(text))), "")
        if named or "VER" not in self or "FWS" not in self["VER"]:
            return named
        return str(self["VER"]["FWS"][0])

    @property
    def kind(self) -> str:
        """Kind of vehicle.

        Raises:
            LogError: the log does not say it, or it is one that the simulator does not have.
        """
        found = [firmwares.of_text(text) for _, text in self.texts]
        if "VER" in self and "BU" in self["VER"]:
            found.append(firmwares.of_build(int(self["VER"]["BU"][0])))
        found += [firmwares.of_parameter(name) for name in self.parameters]
        kind, other = next((one for one in found if any(one)), ("", ""))
        if other:
            raise LogError(f"log {str(self.path)!r} is of {other}; logs of copters and rovers are taken")
        if not kind:
            raise LogError(
                f"log {str(self.path)!r} does not say what vehicle it is of: it has no MSG, VER or PARM of it"
            )
        return kind

    # ------------------------------------------------------------------ binary

    def _of_binary(self, wanted: set[str] | None, progress: Progress | None) -> dict[str, Table]:
        formats = _Formats()
        parts: dict[int, list[Array]] = {}
        with self.path.open("rb") as file:
            total = os.fstat(file.fileno()).st_size
            for piece, is_last in _pieces(file, self):
                for kind, rows in formats.split(piece, is_last, self, wanted):
                    parts.setdefault(kind, []).append(rows)
                if progress is not None:
                    progress(file.tell(), total)
        tables: dict[str, Table] = {}
        for kind in list(parts):
            of = formats.known[kind]
            raw = np.concatenate(parts.pop(kind))
            if of.name in tables:  # two numbers of one name: the longer table counts
                if len(tables[of.name]) >= len(raw):
                    continue
            tables[of.name] = Table(of.name, raw, of.letters, {})
        return tables

    def _drop_odd_times(self) -> None:
        """Leave out messages whose time cannot be: those far from the times of the most frequent message."""
        timed = [table for table in self._tables.values() if len(table.time)]
        if not timed:
            return
        times = np.sort(max(timed, key=len).time)
        middle = len(times) // 2
        gaps = np.flatnonzero(np.diff(times) > FAR_S) + 1
        begin = times[max([0, *gaps[gaps <= middle]])] - FAR_S
        end = times[min([len(times), *gaps[gaps > middle]]) - 1] + FAR_S
        for table in timed:
            odd = (table.time < begin) | (table.time > end)
            if odd.any():
                self.left_out += int(odd.sum())
                self._tables[table.name] = table.where(~odd)

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

    def __init__(self, name: str, letters: dict[str, str]) -> None:
        self.name, self.letters = name, letters
        self.dtype = np.dtype([(label, _NUMPY[letter]) for label, letter in letters.items()])


class _Formats:
    """The formats that are known so far, and the messages of a piece by them."""

    def __init__(self) -> None:
        self.known: dict[int, _Format] = {FMT_NUMBER: _Format("FMT", {field.label: field.kind for field in FMT.fields})}
        self._lengths = np.zeros(256, np.int64)
        self._lengths[FMT_NUMBER] = _FMT_LENGTH

    def split(self, piece: _Piece, is_last: bool, log: Columns, wanted: set[str] | None) -> Iterator[tuple[int, Array]]:
        """(Number of the message, its rows) for all that are in a piece; sets how much of the piece is used."""
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
            log.truncated = 0 < len(data) - used < _LONGEST and bool(np.any(data[used:]))
        piece.used = used if is_last or len(data) - used < 4 * _LONGEST else len(data) - 2 * _LONGEST
        log.skipped += max(piece.used - int((ends - heads).sum()), 0)
        order = np.argsort(kinds, kind="stable")
        sorted_kinds = kinds[order]
        for kind in np.unique(sorted_kinds).tolist():
            of = self.known[kind]
            if wanted is not None and of.name not in wanted and of.name != "FMT":
                continue
            begin, end = np.searchsorted(sorted_kinds, [kind, kind + 1])
            yield kind, _gather(data, heads[order[begin:end]] + 3, of.dtype)

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
            found = _Format(name, dict(zip(columns, letters)))
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
    """Rows that begin at these places."""
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


def _of_text(log: DataFlash, wanted: set[str] | None) -> dict[str, Table]:
    """A log as text has no types of numbers: all are taken for float64."""
    rows: dict[str, list[dict[str, Any]]] = {}
    letters: dict[str, dict[str, str]] = {}
    for row in log.rows(_Everything() if wanted is None else wanted):
        rows.setdefault(row.name, []).append(row.fields)
        letters[row.name] = row.letters
    tables = {}
    for name, found in rows.items():
        kinds = {label: "U64" if letter in "nNZa" else "f8" for label, letter in letters[name].items()}
        raw = np.zeros(len(found), np.dtype(list(kinds.items())))
        for label, kind in kinds.items():
            empty = "" if kind == "U64" else np.nan
            raw[label] = [_plain(fields.get(label, empty), kind) for fields in found]
        plain = {label: "Z" if kind == "U64" else "d" for label, kind in kinds.items()}
        tables[name] = Table(name, raw, plain, {})
    return tables


def _plain(value: Any, kind: str) -> Any:
    if kind == "U64":
        return str(value)
    try:
        return float(value)
    except (TypeError, ValueError):
        return np.nan


class _Everything(Collection[str]):
    """Every name."""

    def __contains__(self, name: object) -> bool:
        return True

    def __iter__(self) -> Iterator[str]:
        return iter(())

    def __len__(self) -> int:
        return 0
