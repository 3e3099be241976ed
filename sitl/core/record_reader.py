# SPDX-License-Identifier: BSD-3-Clause
"""Fast reads of a few fields of a vehicle record.

Attribute access on a ``numpy`` record costs about a microsecond a field. Here the offset of each field in
memory is worked out once, and one ``struct`` call then gives all of them as Python numbers (about 0.3 us for
ten fields).
"""

from __future__ import annotations

import struct
from collections.abc import Callable
from functools import partial
from operator import getitem, itemgetter
from typing import Any

import numpy as np

from ..errors import SitlError

_CODES = {"<f8": "d", "<i8": "q", "<f4": "f", "<i4": "i", "<i2": "h", "<u2": "H"}


class UnknownFieldError(SitlError, KeyError):
    """A path that is not in the record."""


def locate(dtype: np.dtype[Any], path: str) -> tuple[int, str, int]:
    """(offset [bytes], struct code, number of elements) of a field: "autopilot.estimate.vel", "radio.RC[0].MIN"."""
    offset = 0
    for part in path.split("."):
        name, _, index = part.removesuffix("]").partition("[")
        if dtype.fields is None or name not in dtype.fields:
            raise UnknownFieldError(f"no field {name!r} of {path!r} in the record; it has {list(dtype.names or ())}")
        dtype, step = dtype.fields[name][:2]
        offset += step
        if index:
            base, shape = dtype.subdtype if dtype.subdtype is not None else (dtype, ())
            if len(shape) != 1 or not index.isdigit() or int(index) >= shape[0]:
                raise UnknownFieldError(f"no element [{index}] of {name!r} in {path!r}; its shape is {shape}")
            dtype, offset = base, offset + int(index) * base.itemsize
    base, shape = dtype.subdtype if dtype.subdtype is not None else (dtype, ())
    if base.str not in _CODES:
        raise UnknownFieldError(f"{path!r} is a {base}, not a number or an array of numbers")
    return offset, _CODES[base.str], int(np.prod(shape, dtype=int)) if shape else 1


def offset_of(dtype: np.dtype[Any], path: str) -> int:
    """Offset of a record or field in a record [bytes]: "physics.body"."""
    offset = 0
    for name in path.split("."):
        if dtype.fields is None or name not in dtype.fields:
            raise UnknownFieldError(f"no field {name!r} of {path!r} in the record; it has {list(dtype.names or ())}")
        dtype, step = dtype.fields[name][:2]
        offset += step
    return offset


def addresses(fleet: np.ndarray[Any, Any], index: int, *paths: str) -> tuple[int, ...]:
    """Addresses in memory of records or fields of vehicle ``index`` of a fleet, which must stay where it is."""
    at = fleet.ctypes.data + index * fleet.dtype.itemsize
    return tuple(at + offset_of(fleet.dtype, path) for path in paths)


class RecordReader:
    """Reads fields of vehicle ``index`` of ``fleet``; arrays come element by element.

    The fleet's memory must stay where it is (resets and restores write into it).
    """

    def __init__(self, fleet: np.ndarray[Any, Any], index: int) -> None:
        self._dtype = fleet.dtype
        self._memory: Any = fleet.view("u1").data
        self._base = index * fleet.dtype.itemsize

    def fields(self, *paths: str) -> Callable[[], tuple[Any, ...]]:
        """A function that returns the present values of ``paths``, in that order, flattened."""
        fields = [locate(self._dtype, path) for path in paths]
        layout, at = "<", 0
        slots: list[int] = []
        start = min(offset for offset, _, _ in fields)
        number_of: dict[int, int] = {}
        for k in sorted(range(len(fields)), key=lambda i: fields[i][0]):
            offset, code, count = fields[k]
            gap = offset - start - at
            if gap < 0:
                raise UnknownFieldError(f"{paths[k]!r} is asked for twice")
            layout += (f"{gap}x" if gap else "") + f"{count}{code}"
            at = offset - start + count * struct.calcsize("<" + code)
            number_of[k] = len(slots)
            slots.extend([k] * count)
        order = [number_of[k] + j for k in range(len(paths)) for j in range(fields[k][2])]
        unpack_from = struct.Struct(layout).unpack_from
        memory, first = self._memory, self._base + start
        if order == list(range(len(order))):
            return partial(unpack_from, memory, first)  # no Python frame for a read
        pick = itemgetter(*order)
        return lambda: pick(unpack_from(memory, first))

    def field(self, path: str) -> Callable[[], Any]:
        """A function that returns one scalar."""
        offset, code, count = locate(self._dtype, path)
        size = struct.calcsize("<" + code)
        if count != 1 or len(self._memory) % size:
            read = self.fields(path)
            return lambda: read()[0]
        return partial(getitem, self._memory.cast(code), (self._base + offset) // size)
