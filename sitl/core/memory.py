# SPDX-License-Identifier: BSD-3-Clause
"""Records and bytes at an address: what laws need to read and write messages in a buffer.

An address is an integer; who gives it to a law keeps the memory behind it where it is. In plain Python the same
functions give views of the same memory.
"""

from __future__ import annotations

from ctypes import c_uint8
from typing import Protocol, TypeVar

from .records import Record

R = TypeVar("R", bound=Record)


class Bytes(Protocol):
    """Bytes, by index."""

    def __getitem__(self, index: int, /) -> int: ...
    def __setitem__(self, index: int, value: int, /) -> None: ...
    def __len__(self) -> int: ...


def record_at(cls: type[R], address: int) -> R:
    """The record of class ``cls`` at an address."""
    return cls(memoryview((c_uint8 * cls.dtype.itemsize).from_address(address)).cast("B"))


def bytes_at(address: int, count: int) -> Bytes:
    """The bytes at an address."""
    return memoryview((c_uint8 * count).from_address(address)).cast("B")
