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

from .target_machines import Target, usable

FOLDER_VARIABLE = "SITL_SHIPPED_DIR"
"""Environment variable: another folder of libraries; empty: none is used, all is compiled here."""
CONTENTS = "sitl_contents"
"""Symbol of what the library holds, as JSON: name -> identity."""
SLOT = ".slot"
"""Ending of the symbol of a unit's slot: where calls of the unit go."""
TABLE = "sitl_python"
"""Symbol of the table of addresses that entries of kernels need of Python."""
PYTHON = (
    "PyErr_BadArgument", "PyErr_Occurred", "PyObject_IsTrue", "PyFloat_AsDouble", "PyFloat_FromDouble",
    "PyLong_AsLongLong", "PyLong_FromLongLong", "PyBool_FromLong", "Py_BuildValue", "empty format",
)  # fmt: skip
"""What is in the table: functions of Python's stable interface; and the text of a ``Py_BuildValue`` that gives None."""
_OWN, _CALL = ".own", ".call"
_METH_FASTCALL = 0x80
"""Python's: arguments are handed over as an array."""


class _MethodDef(ctypes.Structure):
    """Python's ``PyMethodDef``."""

    _fields_ = (
        ("name", ctypes.c_char_p), ("address", ctypes.c_void_p), ("flags", ctypes.c_int), ("doc", ctypes.c_char_p),
    )  # fmt: skip


def call_symbol(symbol: str) -> str:
    """Symbol of a kernel's entry that Python calls."""
    return symbol + _CALL


def own_symbol(symbol: str) -> str:
    """Symbol of a unit's own code; others call ``symbol``, which goes where the slot says."""
    return symbol + _OWN


def kernel_symbol(name: str) -> str:
    """Symbol of a kernel."""
    return "sitl_kernel_" + name.replace(".", "_")


def unit_key(name: str, path: str) -> str:
    """Name of a unit, for the record type at ``path``, in the contents."""
    return f"{name} {path}"


_keep_for_ever = ctypes.PYFUNCTYPE(None, ctypes.py_object)(("Py_IncRef", ctypes.pythonapi))
_new_function = ctypes.PYFUNCTYPE(ctypes.py_object, ctypes.c_void_p, ctypes.c_void_p, ctypes.c_void_p)(
    ("PyCFunction_NewEx", ctypes.pythonapi)
)


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
        no_format = ctypes.create_string_buffer(b"")
        _keep_for_ever(no_format)  # as the code does
        table = (ctypes.c_void_p * len(PYTHON)).in_dll(self._code, TABLE)
        for k, name in enumerate(PYTHON[:-1]):
            table[k] = ctypes.cast(getattr(ctypes.pythonapi, name), ctypes.c_void_p).value
        table[len(PYTHON) - 1] = ctypes.addressof(no_format)
        said = json.loads(ctypes.string_at(ctypes.addressof(self._at(CONTENTS))))
        self.identities: dict[str, str] = said["contents"]
        self.made_with: str = said["made with"]

    def _at(self, symbol: str) -> ctypes.c_char:
        return ctypes.c_char.in_dll(self._code, symbol)

    def function(self, symbol: str, arguments: list[Any], result: Any = None) -> Any:
        """A function of the library as one of Python; other threads run while it does.

        Args:
            symbol: its name.
            arguments: ctypes' types of them.
            result: that of what it returns; None: nothing.
        """
        found = self._code[symbol]  # a new object each time
        found.argtypes, found.restype = arguments, result
        return found

    def method(self, symbol: str) -> Any:
        """A kernel as a function of Python that takes numbers and arrays; other threads wait until it returns."""
        address = ctypes.addressof(self._at(call_symbol(symbol)))
        definition = _MethodDef(symbol.encode(), address, _METH_FASTCALL, None)
        _keep_for_ever(definition)  # Python reads it until the function goes, which may be after this module
        return _new_function(ctypes.addressof(definition), None, None)

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
    root = folder()
    if root is None or not _arrays_are_known():
        return None
    for target in usable():
        file = root / target.file
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
