# SPDX-License-Identifier: BSD-3-Clause
"""Samples of a vehicle's record: the numbers that a log needs, taken all at once, read back as columns.

To look at a vehicle costs a microsecond or two: the 8-byte words that hold the numbers are copied into a row. What
they mean is worked out later, for hundreds of rows at a time.
"""

from __future__ import annotations

import re
from typing import Any

import numpy as np

from ...vehicle.sampler import Sampler

Array = np.ndarray[Any, Any]
_PATH = re.compile(r"([\w.]+)(?:\[([\d,]+)\])?$")
_KINDS = {"<f8": "<f8", "<i8": "<i8", "<f4": "<f4", "<i4": "<i4"}


def located(dtype: np.dtype[Any], path: str) -> tuple[int, str]:
    """(offset [bytes], type) of one number of a record: "autopilot.estimate.vel[2]", "autopilot.ekf.P[3,3]".

    Raises:
        KeyError: the record has no such number.
    """
    found = _PATH.match(path)
    if found is None:
        raise KeyError(f"{path!r} is not the path of a number")
    offset, here = 0, dtype
    for name in found[1].split("."):
        if here.fields is None or name not in here.fields:
            raise KeyError(f"no field {name!r} of {path!r} in the record")
        here, step = here.fields[name][:2]
        offset += step
    base, shape = here.subdtype if here.subdtype is not None else (here, ())
    at = tuple(int(n) for n in found[2].split(",")) if found[2] else ()
    if base.str not in _KINDS or len(at) != len(shape) or any(k >= n for k, n in zip(at, shape)):
        raise KeyError(f"{path!r} is not a number of the record")
    return offset + (int(np.ravel_multi_index(at, shape)) if at else 0) * base.itemsize, _KINDS[base.str]


class Samples:
    """Rows of the numbers of one vehicle.

    Args:
        fleet, index: the vehicle; its memory must stay where it is.
        capacity: rows that there is space for.
    """

    def __init__(self, fleet: Array, index: int, capacity: int) -> None:
        self._dtype = fleet.dtype
        self._words = fleet.view("<i8").reshape(len(fleet), -1)[index]
        self._located: dict[str, tuple[int, str]] = {}
        self._capacity = capacity
        self.sampler = Sampler()
        """With it the core takes rows."""
        self._columns: dict[str, tuple[int, str, slice]] = {}
        self._table = np.zeros((0, 0), "<i8")
        self._read: dict[str, Array] = {}
        self._taken = np.zeros(0, np.intp)
        self.rows = np.zeros((0, 0), "<i8")

    def want(self, *paths: str) -> None:
        """Have these numbers in every row, too.

        Raises:
            KeyError: the record has no such number.
        """
        for path in paths:
            if path not in self._located:
                self._located[path] = located(self._dtype, path)

    def probe(self, path: str) -> Array:
        """Present value as a column of one, wanted from now on: what a function of the samples may be tried with."""
        self.want(path)
        offset, kind = self._located[path]
        return self._words[offset // 8 : offset // 8 + 1].view(kind)[offset % 8 // int(kind[2]) :][:1].astype("f8")

    def begin(self) -> None:
        """Everything is wanted that ever will be: make the rows (one more than ``capacity``, see ``carry``)."""
        words = sorted({offset // 8 for offset, _ in self._located.values()})
        self._taken = np.array(words, np.intp)
        self.rows = np.zeros((self._capacity + 1, len(words)), "<i8")
        self._memory = Sampler.fleet(1)
        self.sampler = s = Sampler.of(self._memory, 0)
        s.rows, s.count, s.words, s.to = self._capacity, len(words), self._taken.ctypes.data, self.rows.ctypes.data
        s.source, s.source_words = self._words.ctypes.data, len(self._words)
        number = {word: k for k, word in enumerate(words)}
        for path, (offset, kind) in self._located.items():
            size = int(kind[2])
            self._columns[path] = number[offset // 8], kind, slice(offset % 8 // size, None, 8 // size)

    @property
    def address(self) -> int:
        """Of the sampler."""
        return int(self._memory.ctypes.data)

    def take(self, k: int) -> None:
        """Write the vehicle's present numbers into row ``k``."""
        self._words.take(self._taken, out=self.rows[k], mode="clip")
        self.sampler.row = k

    def turn(self, count: int) -> None:
        """Make columns of the rows 0 .. ``count``, in one piece each."""
        self._table = np.ascontiguousarray(self.rows[: count + 1].T)
        self._read.clear()

    def column(self, path: str) -> Array:
        """One number of all rows that were turned into columns, as it is in the record."""
        found = self._read.get(path)
        if found is None:
            row, kind, part = self._columns[path]
            found = self._read[path] = self._table[row].view(kind)[part]
        return found
