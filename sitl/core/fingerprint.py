# SPDX-License-Identifier: BSD-3-Clause
"""What a unit's machine code depends on, as one hash.

Numba's own cache looks only at the file of the entry point, so an edit to a law in another file would leave
stale code. Here the hash covers every function and constant that a unit reaches, to the last law (comments and
docstrings left out), where the fields lie that these mention, and the versions of the compilers. Other units are a
border: calling one depends on the symbol by which it is linked, and not on its inside.
"""

from __future__ import annotations

import hashlib
import types
from collections.abc import Callable, Iterable, Iterator, Mapping
from enum import IntEnum
from functools import cache
from types import MappingProxyType
from typing import Any, TypeGuard

import numpy as np

from .kernels import INLINED, UNITS, Unit
from .records import PROPERTIES, Record


class _Written(str):
    """A text that stands for itself in the ``repr`` of a tuple."""

    __repr__ = str.__str__


def _code(code: types.CodeType, doc: str | None = None) -> str:
    """A function's bytecode with its constants and names: no docstring, comments, layout or line numbers."""
    constants = tuple(_constant(c) for c in code.co_consts if c is None or c != doc)
    return f"{code.co_code.hex()} {constants!r} {code.co_names} {code.co_varnames} {code.co_argcount}"


def _constant(value: Any) -> Any:
    """A constant whose ``repr`` is the same in every process: that of code has an address, that of a set no order."""
    if isinstance(value, types.CodeType):
        return _Written(f"<{_code(value)}>")
    if isinstance(value, frozenset):
        return _Written(sorted(map(repr, value)))
    return value


def _referenced(function: types.FunctionType) -> Iterator[tuple[str, Any]]:
    """Global names, and attributes of global modules, that the function's bytecode mentions."""
    names = function.__code__.co_names
    for name in names:
        if name not in function.__globals__:
            continue
        value = function.__globals__[name]
        if isinstance(value, types.ModuleType):
            for attribute in names:
                if hasattr(value, attribute):
                    yield f"{name}.{attribute}", getattr(value, attribute)
        else:
            yield name, value


def items(
    function: Any, code: Callable[[Any], str], constant: Callable[[Any], str] = repr
) -> Iterator[str | tuple[str, Any]]:
    """What a law is, in order: texts, (name, another function that it uses), and (name, a record class).

    Args:
        function: the law.
        code: gives the text of a function's own code.
        constant: gives the text of a number, a text, or a tuple of such.
    """
    inlined = " inlined" if function in INLINED else ""
    yield f"def {function.__module__}.{function.__qualname__}{inlined} {code(function)}"
    for cell in function.__closure__ or ():  # a table that the function looks up
        if isinstance(cell.cell_contents, (bool, int, float, str, tuple)):
            yield f"closes over {constant(cell.cell_contents)}"
    for name in function.__code__.co_names:
        for law in PROPERTIES.get(name, ()):
            yield "", law
    for name, value in _referenced(function):
        if isinstance(value, types.FunctionType):
            yield name, value
        elif isinstance(value, IntEnum):  # its ``repr`` differs between versions of Python
            yield f"{name} = {int(value)}"
        elif isinstance(value, type) and issubclass(value, IntEnum):  # of its members, those that the law names
            for member in value:
                if member.name in function.__code__.co_names:
                    yield f"{name}.{member.name} = {int(member)}"
        elif isinstance(value, (bool, int, float, str, tuple)):
            yield f"{name} = {constant(value)}"
        elif isinstance(value, type) and issubclass(value, tuple):  # a named tuple, or a vector
            yield f"{name} of {getattr(value, '_fields', ())}"
        elif isinstance(value, type) and issubclass(value, Record):  # memory that the law looks at as this record
            yield name, value
        elif isinstance(value, np.ndarray):
            yield f"{name} = {value.dtype.str}{value.shape}{value.tobytes().hex()}"


def borders(unit: Unit) -> dict[int, Unit]:
    """All other units, by the ids of their functions."""
    return {id(other.function): other for other in UNITS.values() if other is not unit}


def call_of(name: str, unit: Unit) -> str:
    """The text of a call of a unit, which its caller knows as ``name``: a unit that has moved has another symbol, and
    machine code that asks for the old one ends the process."""
    return f"{name} is {unit.symbol} of {unit.integers} integers"


def mentioned(code: types.CodeType) -> set[str]:
    """Names that code mentions, and texts, which may be those of a ``getattr``: it uses no field of another name."""
    found = set(code.co_names)
    for constant in code.co_consts:
        if isinstance(constant, types.CodeType):
            found |= mentioned(constant)
        elif isinstance(constant, str):
            found.add(constant)
    return found


def is_record(value: Any) -> TypeGuard[type[Record]]:
    """Whether what a law uses (``items``) is the class of a record, and no function."""
    return isinstance(value, type)


def _bytecode(function: Any) -> str:
    return _code(function.__code__, function.__doc__)


class Reached:
    """What a function uses, with all functions that it reaches up to other units.

    Args:
        function: a law.
        units: those that are a border (``borders``).
    """

    def __init__(self, function: Any, units: Mapping[int, Unit] = MappingProxyType({})) -> None:
        self.lines: list[str] = []
        """Of code and constants, in order."""
        self.names: set[str] = set()
        """That the code mentions: a field of another name cannot be read or written by it."""
        self.records: dict[type[Record], str] = {}
        """Records that it makes of memory, with the name that it has for each."""
        self._units, self._seen = units, set[int]()
        self._walk(function)

    def _walk(self, function: Any) -> None:
        if id(function) in self._seen:
            return
        self._seen.add(id(function))
        self.names |= mentioned(function.__code__)
        for item in items(function, _bytecode):
            if isinstance(item, str):
                self.lines.append(item)
            elif is_record(item[1]):
                self.records[item[1]] = item[0]
            elif item[0] and id(item[1]) in self._units:
                self.lines.append(call_of(item[0], self._units[id(item[1])]))
            else:
                self._walk(item[1])

    def layouts(self, records: Iterable[type[Record]]) -> Iterator[str]:
        """Of these records, and of those that are made of memory, the fields that are mentioned."""
        for record in records:
            yield record.layout(self.names)
        for record, name in self.records.items():
            yield f"{name} of {record.layout(self.names)}"


def fingerprint(unit: Unit, records: Iterable[type[Record]], toolchain: str) -> str:
    """Hash (20 hex digits) of all that ``unit``'s machine code for ``records`` depends on: also of where the fields lie
    that it mentions, and of no others."""
    found = Reached(unit.function, borders(unit))
    lines = [toolchain, *found.lines, *found.layouts(records)]
    return hashlib.sha256("\n".join(lines).encode()).hexdigest()[:20]


@cache  # every new simulation asks, and code does not change while a process runs
def reached(entry: Callable[..., Any]) -> tuple[Unit, ...]:
    """The units that ``entry``, a unit itself, calls, directly or not: callees before callers, ``entry`` last."""
    by_function = {id(u.function): u for u in UNITS.values()}
    found: dict[str, Unit] = {}

    def visit(function: Any, seen: set[int]) -> None:
        if id(function) in seen:
            return
        seen.add(id(function))
        for _, value in _referenced(function):
            if isinstance(value, types.FunctionType):
                visit(value, seen)
        unit = by_function.get(id(function))
        if unit is not None:
            found[unit.name] = unit

    visit(entry, set())
    return tuple(found.values())
