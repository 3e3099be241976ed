# SPDX-License-Identifier: BSD-3-Clause
"""A record with attribute access for everything that is plain Python: the shell, tests, laws in a debugger.

``numpy`` builds a new object for every step of ``v.autopilot.modes.number`` (several microseconds); here the
nested objects exist once and a number is read straight from memory as a Python number (0.1 us). The fleet's
memory must stay where it is.
"""

from __future__ import annotations

from functools import cache
from operator import attrgetter
from typing import Any

import numpy as np

_NUMBERS = {"<f8": ("_f8", 8), "<i8": ("_i8", 8), "<f4": ("_f4", 4), "<i4": ("_i4", 4)}


class RecordView:
    """Base of the generated classes: one for each record type."""

    __slots__ = ("_at", "_at4", "_at8", "_f4", "_f8", "_i4", "_i8", "_memory")
    dtype: np.dtype[Any]
    """Of the record."""
    _nested: tuple[tuple[str, type[RecordView], int], ...] = ()
    _arrays: tuple[tuple[str, np.dtype[Any], tuple[int, ...], int], ...] = ()

    def __init__(self, memory: np.ndarray[Any, Any], at: int) -> None:
        view: Any = memory.data
        self._memory, self._at = memory, at
        self._f8, self._i8, self._f4, self._i4 = (view.cast(c) for c in "dqfi")
        self._at8, self._at4 = at // 8, at // 4
        for name, kind, offset in self._nested:
            setattr(self, "_" + name, kind(memory, at + offset))
        for name, base, shape, offset in self._arrays:
            setattr(self, "_" + name, np.ndarray(shape, base, memory.data, at + offset))

    def __getitem__(self, name: str) -> Any:
        return getattr(self, name)

    def __setitem__(self, name: str, value: Any) -> None:
        setattr(self, name, value)

    def assign(self, value: Any) -> None:
        """Copy a whole record of the same type (``numpy``'s or a view) into this one's memory."""
        self._memory[self._at : self._at + self.dtype.itemsize] = as_bytes(value, self.dtype)


def as_bytes(value: Any, dtype: np.dtype[Any]) -> np.ndarray[Any, Any]:
    """The bytes of a record; TypeError when it is of another type."""
    if getattr(value, "dtype", None) != dtype:
        raise TypeError(f"a record of {dtype.names} cannot become one of {getattr(value, 'dtype', type(value))}")
    if isinstance(value, RecordView):
        return value._memory[value._at : value._at + value.dtype.itemsize]
    return np.frombuffer(np.asarray(value, dtype).tobytes(), "u1")


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


def _nested(name: str) -> property:
    get = attrgetter("_" + name)
    return property(get, lambda self, value: get(self).assign(value))


def _array(name: str) -> property:
    get = attrgetter("_" + name)

    def write(self: RecordView, value: Any) -> None:
        get(self)[...] = value

    return property(get, write)


@cache
def _view_class(dtype: np.dtype[Any]) -> type[RecordView]:
    assert dtype.fields is not None
    members: dict[str, Any] = {"dtype": dtype}
    nested, arrays = [], []
    for name in dtype.names or ():
        field, offset = dtype.fields[name][:2]
        if field.names is not None:
            nested.append((name, _view_class(field), offset))
            members[name] = _nested(name)
        elif field.subdtype is not None:
            arrays.append((name, *field.subdtype, offset))
            members[name] = _array(name)
        else:
            members[name] = _number(*_NUMBERS[field.str], offset)
    members["__slots__"] = tuple("_" + n[0] for n in (*nested, *arrays))
    members["_nested"], members["_arrays"] = tuple(nested), tuple(arrays)
    return type("RecordView", (RecordView,), members)


def view(fleet: np.ndarray[Any, Any], index: int) -> Any:
    """Record ``index`` of ``fleet`` with attribute access; writes go to the fleet, arrays are ``numpy`` views.

    Raises:
        ValueError: the fleet is not one block of memory.
    """
    if not fleet.flags.c_contiguous:
        raise ValueError("the fleet must be one block of memory")
    memory = np.frombuffer(fleet.data, "u1")
    return _view_class(fleet.dtype)(memory, range(len(fleet))[index] * fleet.dtype.itemsize)
