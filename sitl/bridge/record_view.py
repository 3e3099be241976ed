# SPDX-License-Identifier: BSD-3-Clause
"""A vehicle record with fast attribute access, for laws that the shell calls as plain Python.

``numpy`` builds a new object for every step of ``v.autopilot.modes.number`` (several microseconds); here the
nested objects exist once and a number is read straight from memory (0.1 us). The fleet's memory must stay
where it is.
"""

from __future__ import annotations

from functools import cache
from typing import Any

import numpy as np

_NUMBERS = {"<f8": ("_f8", 8), "<i8": ("_i8", 8), "<f4": ("_f4", 4), "<i4": ("_i4", 4)}


class RecordView:
    """Base of the generated classes: one for each record type."""

    __slots__ = ("_at4", "_at8", "_f4", "_f8", "_i4", "_i8")
    _nested: tuple[tuple[str, type[RecordView], int], ...] = ()
    _arrays: tuple[tuple[str, np.dtype[Any], tuple[int, ...], int], ...] = ()

    def __init__(self, memory: np.ndarray[Any, Any], at: int) -> None:
        view: Any = memory.data
        self._f8, self._i8, self._f4, self._i4 = (view.cast(c) for c in "dqfi")
        self._at8, self._at4 = at // 8, at // 4
        for name, kind, offset in self._nested:
            setattr(self, name, kind(memory, at + offset))
        for name, base, shape, offset in self._arrays:
            setattr(self, name, np.ndarray(shape, base, memory.data, at + offset))

    def __getitem__(self, name: str) -> Any:
        return getattr(self, name)

    def __setitem__(self, name: str, value: Any) -> None:
        setattr(self, name, value)


def _number(store: str, size: int, offset: int) -> property:
    at, k = f"_at{size}", offset // size
    whole = store in ("_i8", "_i4")

    def read(self: RecordView) -> Any:
        return getattr(self, store)[getattr(self, at) + k]

    def write(self: RecordView, value: Any) -> None:
        getattr(self, store)[getattr(self, at) + k] = int(value) if whole else value

    def read_f8(self: RecordView) -> Any:
        return self._f8[self._at8 + k]

    def read_i8(self: RecordView) -> Any:
        return self._i8[self._at8 + k]

    return property({"_f8": read_f8, "_i8": read_i8}.get(store, read), write)


@cache
def _view_class(dtype: np.dtype[Any]) -> type[RecordView]:
    assert dtype.fields is not None
    members: dict[str, Any] = {}
    nested, arrays = [], []
    for name in dtype.names or ():
        field, offset = dtype.fields[name][:2]
        if field.names is not None:
            nested.append((name, _view_class(field), offset))
        elif field.subdtype is not None:
            arrays.append((name, *field.subdtype, offset))
        else:
            members[name] = _number(*_NUMBERS[field.str], offset)
    members["__slots__"] = tuple(n[0] for n in (*nested, *arrays))
    members["_nested"], members["_arrays"] = tuple(nested), tuple(arrays)
    return type("RecordView", (RecordView,), members)


def record_view(fleet: np.ndarray[Any, Any], index: int) -> Any:
    """Vehicle ``index`` of ``fleet``; writes go to the fleet, arrays are ``numpy`` views."""
    memory = np.frombuffer(fleet.data, "u1") if fleet.flags.c_contiguous else None
    if memory is None:
        raise ValueError("the fleet must be one block of memory")
    return _view_class(fleet.dtype)(memory, index * fleet.dtype.itemsize)
