# SPDX-License-Identifier: BSD-3-Clause
"""A DataFlash log as text (.log), as tools write it: a line for each message, values as they are meant."""

from __future__ import annotations

from pathlib import Path
from typing import Any, NamedTuple

import numpy as np

from .formats import TYPES, clock
from .tables import Table

_TEXTS = "nNZa"
_LETTERS = {*TYPES, "a", "g"}
_LONGEST_LINE = 4096


class TextLog(NamedTuple):
    """What is in a file."""

    tables: dict[str, Table]
    formats: set[str]
    """Names of messages that it has a format of."""
    skipped: int
    """Bytes of lines that are no messages."""


class _Lines:
    """The messages of one name."""

    def __init__(self, name: str, letters: dict[str, str]) -> None:
        self.name, self.letters = name, letters
        self.clock = clock(letters)
        self.rows: list[list[str | float]] = []
        self.times: list[float] = []
        """Of the message, or of the one before it; not a number: there was none."""

    def take(self, values: list[str], time: float) -> float | None:
        """One message, and the time of the one before; returns the time of this one. None: it makes no sense."""
        if len(values) > len(self.letters) > 0:  # a text with commas
            kept = len(self.letters) - 1
            values = [*values[:kept], ", ".join(values[kept:])]
        if len(values) < len(self.letters):
            return None
        row: list[str | float] = []
        for letter, value in zip(self.letters.values(), values, strict=True):
            try:
                is_word = letter in _TEXTS or (letter == "M" and not value.isdigit())
                row.append(value if is_word else float(value))
            except ValueError:
                return None
        if self.clock is not None:
            field, scale = self.clock
            own = row[list(self.letters).index(field)]
            time = own * scale if isinstance(own, float) else time
        self.rows.append(row)
        self.times.append(time)
        return time

    def table(self, began: float | None) -> Table:
        """All of them as columns."""
        columns: list[Any] = list(zip(*self.rows, strict=True)) or [()] * len(self.letters)
        is_word = [any(isinstance(value, str) for value in column) for column in columns]
        kinds = [(label, "U64" if word else "f8") for label, word in zip(self.letters, is_word, strict=True)]
        raw = np.zeros(len(self.rows), np.dtype(kinds))
        for label, column in zip(self.letters, columns, strict=True):
            raw[label] = column
        times = None if self.clock is not None or began is None else np.nan_to_num(self.times, nan=began)
        return Table(self.name, raw, self.letters, {}, times)


def read(path: Path, wanted: set[str] | None) -> TextLog:
    """A file.

    Args:
        path: of it.
        wanted: names of the messages that are kept; None: all.

    Raises:
        OSError: it cannot be read.
    """
    known: dict[str, _Lines] = {}
    heading, skipped, time = "", 0, np.nan
    began: float | None = None
    with path.open("rb") as file:
        while line := file.readline(_LONGEST_LINE):
            name, *values = (value.strip() for value in line.decode(errors="replace").split(","))
            if name == "FMT" and len(values) > 4:
                found = _format(values[2], values[3], ",".join(values[4:]).strip('"').replace(" ", ""))
                if found is not None:
                    known.setdefault(found.name, found)
            elif name in known:
                now = known[name].take(values, time)
                skipped += len(line) if now is None else 0
                time = time if now is None else now
                began = now if began is None and now is not None and np.isfinite(now) else began
            elif not known and not heading and not name.isdigit():  # the firmware, before all else (ArduPilot 3.1)
                heading = name
    if heading:
        message = known.setdefault("MSG", _Lines("MSG", {"Message": "Z"}))
        if list(message.letters) == ["Message"]:
            message.rows.insert(0, [heading])
            message.times.insert(0, np.nan)
    tables = {
        name: lines.table(began) for name, lines in known.items() if lines.rows and (wanted is None or name in wanted)
    }
    return TextLog(tables, set(known), skipped)


def _format(name: str, letters: str, labels: str) -> _Lines | None:
    """None: it makes no sense."""
    columns = labels.split(",") if labels else []
    if len(columns) != len(letters) or len(set(columns)) != len(columns) or not set(letters) <= _LETTERS:
        return None
    return _Lines(name, dict(zip(columns, letters, strict=True)))
