# SPDX-License-Identifier: BSD-3-Clause
"""The machine code that came with the package: a shared library for each target, loaded without a compiler.

It says itself what it holds: for each unit and kernel the identity (``identity.py``) of the sources that it was made
from. What has another identity now is compiled instead (``core/compile.py``), and calls of it from shipped code go
there, through a slot that each unit has.
"""

from __future__ import annotations

import ctypes
import json
import os
import struct
import sys
from collections.abc import Callable
from functools import cache
from pathlib import Path
from typing import Any

import numpy as np

from .targets import Target, usable

FOLDER_VARIABLE = "SITL_SHIPPED_DIR"
"""Environment variable: another folder of libraries; empty: none is used, all is compiled here."""
CONTENTS = "sitl_contents"
"""Symbol of what the library holds, as JSON: name -> identity."""
SLOT = ".slot"
"""Ending of the symbol of a unit's slot: where calls of the unit go."""
_OWN = ".own"


def own_symbol(symbol: str) -> str:
    """Symbol of a unit's own code; others call ``symbol``, which goes where the slot says."""
    return symbol + _OWN


def kernel_symbol(name: str) -> str:
    """Symbol of a kernel."""
    return "sitl_kernel_" + name.replace(".", "_")


def unit_key(name: str, path: str) -> str:
    """Name of a unit, for the record type at ``path``, in the contents."""
    return f"{name} {path}"


class Library:
    """One shared library.

    Args:
        file: the library.
        target: what it is for.

    Raises:
        OSError: the system cannot load it.
        ValueError: it is no library of the core.
    """

    def __init__(self, file: Path, target: Target) -> None:
        self.file, self.target = file, target
        if not _is_whole(file):
            raise ValueError(f"{file} is not a whole library")
        self._code = ctypes.CDLL(str(file))
        self._code_with_lock = ctypes.PyDLL(str(file))
        said = json.loads(ctypes.string_at(ctypes.addressof(self._at(CONTENTS))))
        self.identities: dict[str, str] = said["contents"]
        self.made_with: str = said["made with"]

    def _at(self, symbol: str) -> ctypes.c_char:
        return ctypes.c_char.in_dll(self._code, symbol)

    def function(self, symbol: str, arguments: list[Any], result: Any = None, keep_lock: bool = False) -> Any:
        """A function of the library as one of Python.

        Args:
            symbol: its name.
            arguments: ctypes' types of them.
            result: that of what it returns; None: nothing.
            keep_lock: other threads of Python wait until it returns: quicker to call.
        """
        found = (self._code_with_lock if keep_lock else self._code)[symbol]  # a new object each time
        found.argtypes, found.restype = arguments, result
        return found

    def redirect(self, symbol: str, address: int) -> None:
        """Let shipped code call what is at ``address`` instead of the unit ``symbol``."""
        ctypes.c_void_p.in_dll(self._code, symbol + SLOT).value = address


def folder() -> Path | None:
    """Where the libraries are."""
    chosen = os.environ.get(FOLDER_VARIABLE)
    if chosen is not None:
        return Path(chosen) if chosen else None
    return Path(__file__).parent / "libraries"


@cache
def library() -> Library | None:
    """The library for this machine; None: there is none, or it does not work here."""
    place = folder()
    if place is None or not _arrays_are_known():
        return None
    for target in usable():
        file = place / target.file
        if file.exists():
            try:
                return Library(file, target)
            except (OSError, ValueError):
                continue
    return None


def is_shipped(key: str, identity: Callable[[], str]) -> bool:
    """Whether there is machine code of this name that was made from the sources whose identity is given."""
    shipped = library()
    return shipped is not None and key in shipped.identities and shipped.identities[key] == identity()


def redirect(key: str, symbol: str, address: int) -> None:
    """Let shipped code, if there is any, call the unit that was compiled to ``address`` instead of its own."""
    shipped = library()
    if shipped is not None and key in shipped.identities:
        shipped.redirect(symbol, address)


def _is_whole(file: Path) -> bool:
    """Whether an ELF file ends where its list of sections does; the system would not look, and crash."""
    with file.open("rb") as opened:
        head = opened.read(64)
        end = opened.seek(0, os.SEEK_END)
    if len(head) < 64 or not head.startswith(b"\x7fELF"):
        return False
    (start,) = struct.unpack_from("<Q", head, 40)
    size, count = struct.unpack_from("<HH", head, 58)
    return bool(start + size * count <= end)


def _arrays_are_known() -> bool:
    """Whether NumPy's arrays lie in memory as kernels expect: address, axes, shape, strides, after CPython's header."""
    if sys.implementation.name != "cpython" or sys.maxsize != 2**63 - 1 or sys.byteorder != "little":
        return False
    probe = np.zeros((2, 3))
    word = ctypes.c_int64
    header = object.__basicsize__
    if header != 16:
        return False
    data, _, shape, strides = (word * 4).from_address(id(probe) + header)
    return (
        data == probe.ctypes.data
        and tuple((word * 2).from_address(shape)) == probe.shape
        and tuple((word * 2).from_address(strides)) == probe.strides
    )
