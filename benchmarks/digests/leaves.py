# SPDX-License-Identifier: BSD-3-Clause
"""The leaves of a record: each number or array of numbers under its path.

Paths and values do not depend on the layout: a vector is one leaf, be it an array or a record of x, y and z; an array
of records gives a leaf for each field; a parameter has ArduPilot's name, however its record is nested.
"""

from __future__ import annotations

from collections.abc import Iterator
from functools import cache
from typing import Any, NamedTuple

import numpy as np

VECTORS = {("x", "y"), ("x", "y", "z"), ("w", "x", "y", "z"), ("roll", "pitch", "yaw"), ("n", "e"), ("n", "e", "d")}
"""Fields of records that are one value."""
PARAMETERS = "autopilot.params."


class Leaf(NamedTuple):
    """A number, or an array of numbers."""

    path: str
    """"autopilot.estimate.vel"."""
    number: np.dtype[Any]
    """Type of one number."""
    offsets: tuple[int, ...]
    """Where its runs of numbers begin [bytes]."""
    length: int
    """Numbers in a run."""

    def value(self, record: bytes) -> np.ndarray[Any, Any]:
        """Its numbers."""
        runs = [np.frombuffer(record, self.number, self.length, offset) for offset in self.offsets]
        return runs[0] if len(runs) == 1 else np.concatenate(runs)

    def wide(self, record: bytes) -> bytes:
        """Its value as float64, integers, too: their width does not count."""
        if len(self.offsets) == 1 and self.number == np.float64:
            return record[self.offsets[0] : self.offsets[0] + 8 * self.length]
        return self.value(record).astype(np.float64).tobytes()


@cache
def leaves(record: np.dtype[Any]) -> list[Leaf]:
    """All leaves of a record type, in memory order."""
    return [_named(leaf) for leaf in _walk(record, "", (0,))]


def _walk(record: np.dtype[Any], path: str, offsets: tuple[int, ...]) -> Iterator[Leaf]:
    assert record.names is not None and record.fields is not None
    for name in sorted(record.names, key=lambda each: record.fields[each][1]):  # type: ignore[index]
        kind, at = record.fields[name][:2]
        yield from _leaf_or_walk(kind, f"{path}.{name}" if path else name, tuple(start + at for start in offsets))


def _leaf_or_walk(kind: np.dtype[Any], path: str, offsets: tuple[int, ...]) -> Iterator[Leaf]:
    base, count = kind.base, int(np.prod(kind.shape, dtype=int))
    if kind.shape and path.startswith(PARAMETERS):
        for k in range(count):  # FLTMODE[0] is FLTMODE1, RC[0].MIN is RC1_MIN
            yield from _leaf_or_walk(base, f"{path}{k + 1}", tuple(start + k * base.itemsize for start in offsets))
        return
    if base.names is None:
        yield Leaf(path, base, offsets, count)
        return
    if kind.shape:
        offsets = tuple(start + k * base.itemsize for start in offsets for k in range(count))
    fields = [base.fields[name][0] for name in base.names]  # type: ignore[index]
    packed = sum(field.itemsize for field in fields) == base.itemsize
    if base.names in VECTORS and packed and fields[0].kind in "biuf" and len(set(fields)) == 1:
        yield Leaf(path, fields[0], offsets, len(fields))
    else:
        yield from _walk(base, path, offsets)


def _named(leaf: Leaf) -> Leaf:
    before, params, name = leaf.path.partition(PARAMETERS)
    return leaf._replace(path=before + params + name.replace(".", "_")) if params else leaf
