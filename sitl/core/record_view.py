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
_CODES = {"_f8": "d", "_i8": "q", "_f4": "f", "_i4": "i"}


class RecordView:
    """Base of the generated classes: one for each record type."""

    __slots__ = ("_bytes", "_f4", "_f8", "_i4", "_i8")
    _f8: Any
    _i8: Any
    dtype: np.dtype[Any]
    """Of the record."""
    _stores: tuple[str, ...] = ()
    _nested: tuple[tuple[str, type[RecordView], int], ...] = ()
    _arrays: tuple[tuple[str, np.dtype[Any], tuple[int, ...], int], ...] = ()

    def __init__(self, memory: Any) -> None:
        self._bytes = memory
        for store in self._stores:
            setattr(self, store, memory.cast(_CODES[store]))
        for name, kind, offset in self._nested:
            setattr(self, "_" + name, kind(memory[offset : offset + kind.dtype.itemsize]))
        for name, base, shape, offset in self._arrays:
            setattr(self, "_" + name, np.ndarray(shape, base, memory, offset))

    def __getitem__(self, name: str) -> Any:
        return getattr(self, name)

    def __setitem__(self, name: str, value: Any) -> None:
        setattr(self, name, value)

    def assign(self, value: Any) -> None:
        """Copy a whole record of the same type (``numpy``'s or a view) into this one's memory."""
        self._bytes[:] = as_bytes(value, self.dtype)


def as_bytes(value: Any, dtype: np.dtype[Any]) -> Any:
    """The bytes of a record; TypeError when it is of another type."""
    if getattr(value, "dtype", None) != dtype:
        raise TypeError(f"a record of {dtype.names} cannot become one of {getattr(value, 'dtype', type(value))}")
    return value._bytes if isinstance(value, RecordView) else np.asarray(value, dtype).tobytes()


def _number(store: str, size: int, offset: int) -> property:
    k = offset // size

    def write_f8(self: RecordView, value: Any) -> None:
        self._f8[k] = value

    def write_i8(self: RecordView, value: Any) -> None:
        try:
            self._i8[k] = value
        except TypeError:  # its fraction is cut off, as in the core
            self._i8[k] = int(value)

    def write_small(self: RecordView, value: Any) -> None:
        getattr(self, store)[k] = int(value) if store == "_i4" else value

    writes = {"_f8": write_f8, "_i8": write_i8}
    reads = {
        "_f8": lambda self: self._f8[k],
        "_i8": lambda self: self._i8[k],
        "_f4": lambda self: self._f4[k],
        "_i4": lambda self: self._i4[k],
    }
    return property(reads[store], writes.get(store, write_small))


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
    nested, arrays, stores = [], [], set()
    for name in dtype.names or ():
        field, offset = dtype.fields[name][:2]
        if field.names is not None:
            nested.append((name, _view_class(field), offset))
            members[name] = _nested(name)
        elif field.subdtype is not None:
            arrays.append((name, *field.subdtype, offset))
            members[name] = _array(name)
        else:
            store, size = _NUMBERS[field.str]
            members[name] = _number(store, size, offset)
            stores.add(store)
    stored = [name for name, _, _ in nested] + [name for name, *_ in arrays]
    members["__slots__"] = tuple("_" + name for name in stored)
    members["_stores"], members["_nested"], members["_arrays"] = tuple(stores), tuple(nested), tuple(arrays)
    return type("RecordView", (RecordView,), members)


def view(fleet: np.ndarray[Any, Any], index: int) -> Any:
    """Record ``index`` of ``fleet`` with attribute access; writes go to the fleet, arrays are ``numpy`` views.

    Raises:
        ValueError: the fleet is not one block of memory.
    """
    if not fleet.flags.c_contiguous:
        raise ValueError("the fleet must be one block of memory")
    size = fleet.dtype.itemsize
    at = range(len(fleet))[index] * size
    return _view_class(fleet.dtype)(np.frombuffer(fleet.data, "u1").data[at : at + size])
