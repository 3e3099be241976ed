# SPDX-License-Identifier: BSD-3-Clause
"""Records, bytes and arrays at an address: what laws need to work on memory that is not in their records.

An address is an integer; who gives it to a law keeps the memory behind it where it is, for as long as laws may use it.
In plain Python the same functions give views of the same memory.
"""

from __future__ import annotations

from ctypes import CFUNCTYPE, c_int64, c_uint8
from typing import Protocol, TypeVar, overload

import numpy as np

from .records import FloatRows, Floats, Ints, Record

R = TypeVar("R", bound=Record)


class Bytes(Protocol):
    """Bytes, by index."""

    @overload
    def __getitem__(self, index: int, /) -> int: ...
    @overload
    def __getitem__(self, index: slice[int, int, None], /) -> Bytes: ...
    def __setitem__(self, index: int, value: int, /) -> None: ...
    def __len__(self) -> int: ...


def _memory(address: int, size: int) -> memoryview[int]:
    return memoryview((c_uint8 * size).from_address(int(address))).cast("B")  # NumPy's integers, too


def record_at(cls: type[R], address: int) -> R:
    """The record of class ``cls`` at an address."""
    return cls(_memory(address, cls.dtype.itemsize))


def bytes_at(address: int, count: int) -> Bytes:
    """The bytes at an address."""
    return _memory(address, count)


def floats_at(address: int, count: int) -> Floats:
    """The float64 numbers at an address, shape (count,)."""
    return np.ndarray((count,), np.float64, _memory(address, 8 * count))


def table_at(address: int, rows: int, columns: int) -> FloatRows:
    """The float64 numbers at an address, row by row, shape (rows, columns)."""
    return np.ndarray((rows, columns), np.float64, _memory(address, 8 * rows * columns))


def ints_at(address: int, count: int) -> Ints:
    """The int64 numbers at an address, shape (count,)."""
    return np.ndarray((count,), np.int64, _memory(address, 8 * count))


def words_of(record: Record) -> Ints:
    """A record's memory as int64 numbers, whatever its fields are: to copy all of it."""
    return np.ndarray((record.dtype.itemsize // 8,), np.int64, record._bytes)


def call_unit(address: int, fleet: int, count: int, index: int, n0: int, n1: int, n2: int) -> None:
    """Call a compiled unit that takes three numbers.

    Args:
        address: of its machine code.
        fleet: address of the vehicles' records.
        count: how many there are.
        index, n0, n1, n2: what the unit takes.
    """
    CFUNCTYPE(None, *[c_int64] * 6)(address)(fleet, count, index, n0, n1, n2)


def fetch_ahead(record: Record, offset: int) -> None:
    """Ask the processor to bring the line of memory with a byte of a record nearer: it is needed soon."""
