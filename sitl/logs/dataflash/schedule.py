# SPDX-License-Identifier: BSD-3-Clause
"""From samples to bytes: which messages are due in which row, and what is in them.

Messages with the same rate and condition make a group; all its messages of one row stand together, so that one array
of a packed type holds the whole group.
"""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from typing import Any

import numpy as np

from ...autopilot.inertial_ring import INERTIAL_RING
from .formats import HEAD, RING, TYPES, Field, Message, Source
from .samples import Array, Samples

TIME = "time_us"
_INERTIAL = "autopilot.inertial."
_HEAD = int.from_bytes(HEAD, "little")


class Columns:
    """Columns of the rows from 1 to ``count``, or of chosen ones (0: the first of these)."""

    def __init__(self, samples: Samples, count: int, rows: Array | None = None) -> None:
        self._samples, self._count, self._rows = samples, count, rows

    def __call__(self, path: str) -> Array:
        """One column, as floats."""
        found = self.raw(path)
        return found if found.dtype == np.float64 else found.astype(np.float64)

    def raw(self, path: str) -> Array:
        """A column in the record's own type."""
        column = self._samples.column(path)[1 : self._count + 1]
        return column if self._rows is None else column[self._rows]

    def before(self, path: str) -> Array:
        """The column of the rows before these, shape (rows,), in its unit."""
        return self._samples.column(path)[: self._count]


class RingColumns(Columns):
    """Columns of the ring's samples that came with the rows from 1 to ``count``; other numbers are those of the row.

    ``rows``: the row of each, 0 the first of these.
    """

    def __init__(self, samples: Samples, count: int) -> None:
        counts = samples.column(_INERTIAL + "count")[: count + 1]
        new = np.clip(counts[1:] - counts[:-1], 0, INERTIAL_RING)
        self.rows = np.repeat(np.arange(count), new)
        first = np.repeat(counts[1:] - new, new)
        step = np.arange(len(self.rows)) - np.repeat(np.cumsum(new) - new, new)
        self._at = (first + step) % INERTIAL_RING
        super().__init__(samples, count, self.rows)

    def raw(self, path: str) -> Array:
        if path == TIME:
            path = RING + TIME
        if not path.startswith(RING):
            return super().raw(path)
        return np.choose(self._at, [super(RingColumns, self).raw(each) for each in in_ring(path)])


def in_ring(path: str) -> list[str]:
    """The paths in the record of a number of the ring, one for each slot in it."""
    name, _, inner = path.removeprefix(RING).partition("[")
    inner = f",{inner}" if inner else "]"
    return [f"{_INERTIAL}{name}[{k}{inner}" for k in range(INERTIAL_RING)]


class Group:
    """Messages that come together."""

    def __init__(self, messages: Sequence[Message], numbers: dict[str, int]) -> None:
        first = messages[0]
        self.period_us = round(1e6 / first.rate)
        self.ring, self.time = first.ring, first.time
        self.when, self.change = first.when, first.change
        self.messages = tuple(messages)
        self.dtype = np.dtype([(m.name, m.columns()) for m in messages])
        self.template = np.zeros((), self.dtype)
        self._jobs: list[tuple[str, Field]] = []
        for m in messages:
            self.template[m.name]["head"], self.template[m.name]["number"] = _HEAD, numbers[m.name]
            for f in m.all_fields:
                if isinstance(f.source, int | float):
                    self.template[m.name][f.label] = f.source * TYPES[f.kind][2]
                else:
                    self._jobs.append((m.name, f))

    def due(self, s: Columns, periods: Array, before: Array) -> Array:
        """Rows of ``s`` in which the group is written; ``periods``, ``before``: time of the row, and the one before."""
        if self.change:
            due = s.raw(self.change) != s.before(self.change)
        else:
            due = periods // self.period_us != before // self.period_us
        if callable(self.when):
            due &= self.when(s) != 0
        elif isinstance(self.when, str):
            due &= s.raw(self.when) != 0
        return np.flatnonzero(due)

    def encode(self, s: Columns, count: int) -> list[bytes]:
        """The bytes of each of ``count`` rows, all that ``s`` has."""
        out = np.empty(count, self.dtype)
        out[:] = self.template
        for name, f in self._jobs:
            out[name][f.label] = values(f, s)
        data, size = out.tobytes(), self.dtype.itemsize
        return [data[at : at + size] for at in range(0, len(data), size)]


def values(f: Field, s: Columns) -> Array:
    """A field's column as it is stored: scaled, rounded, kept within the type's limits (the least for no number)."""
    kind, _, factor = TYPES[f.kind]
    source = f.source
    x: Array = source(s) if callable(source) else s.raw(str(source))
    scale = f.scale * factor
    target = np.dtype(kind)
    if target.kind == "f":
        return x * scale if scale != 1.0 else x
    if scale == 1.0 and x.dtype.kind == "i" and target.itemsize == 8:
        return x
    limits = np.iinfo(target)
    return np.fmin(np.fmax(np.rint(x * scale), limits.min), limits.max)


class Plan:
    """Messages that are written from the samples of one vehicle."""

    def __init__(self, messages: Iterable[Message], numbers: dict[str, int], samples: Samples) -> None:
        sorted_out: dict[tuple[Any, ...], list[Message]] = {}
        for m in messages:
            sorted_out.setdefault((m.rate, m.when, m.change, m.ring, m.time), []).append(m)
        self.groups = [Group(found, numbers) for found in sorted_out.values()]
        self.periods_us = sorted({g.period_us for g in self.groups if not g.ring})
        """Periods of the samples: one is needed at each multiple [us]."""
        self._samples = samples
        samples.want(TIME)
        for g in self.groups:
            _want(samples, g.when)
            samples.want(g.time, *((g.change,) if g.change else ()))
            if g.ring:
                samples.want(_INERTIAL + "count", *in_ring(RING + TIME))
            for m in g.messages:
                for f in m.fields:
                    _want(samples, f.source)

    def write(self, count: int, notes: Sequence[tuple[int, int, bytes]]) -> bytes:
        """The rows 1 .. ``count`` as bytes. Row 0 is the one before them.

        Args:
            notes: (row, time [us], bytes) of other messages, which come before what else is of this row and time;
                row ``count + 1``: after all.
        """
        samples = self._samples
        times = samples.column(TIME)[: count + 1]
        s = Columns(samples, count)
        pieces = [note for _, _, note in notes]
        keys = [np.array([(time_us, row, -1) for row, time_us, _ in notes], np.int64).reshape(-1, 3)]
        for number, g in enumerate(self.groups):
            chosen: Columns
            if g.ring:
                chosen = ring = RingColumns(samples, count)
                rows, when = ring.rows, ring.raw(TIME)
            else:
                rows = g.due(s, times[1:], times[:-1])
                chosen = s if len(rows) == count else Columns(samples, count, rows)
                when = samples.column(g.time)[rows + 1]
            if not len(rows):
                continue
            pieces += g.encode(chosen, len(rows))
            keys.append(np.stack((when, rows + 1, np.full(len(rows), number)), axis=1))
        when, row, number = np.concatenate(keys).T
        order = np.argsort((when * (count + 2) + row) * (len(self.groups) + 1) + number, kind="stable")
        return b"".join(map(pieces.__getitem__, order.tolist()))


def _want(samples: Samples, source: Source) -> None:
    if callable(source):
        source(_Probe(samples))
    elif isinstance(source, str):
        _Probe(samples).raw(source)


class _Probe:
    """Stands for the columns while it is found out which ones a function needs."""

    def __init__(self, samples: Samples) -> None:
        self._samples = samples

    def raw(self, path: str) -> Array:
        """A column of one, wanted from now on."""
        if path.startswith(RING):
            return np.concatenate([self._samples.probe(each) for each in in_ring(path)])[:1]
        return self._samples.probe(path)

    __call__ = raw
