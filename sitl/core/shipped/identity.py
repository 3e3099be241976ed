# SPDX-License-Identifier: BSD-3-Clause
"""Whether sources are those that shipped code was made from.

Another hash over all that a unit reaches than that of ``core/fingerprint.py``: it holds the text of functions instead
of their bytecode, and no versions, so that it is the same under every Python and NumPy and on every machine.
"""

from __future__ import annotations

import hashlib
import linecache
from collections.abc import Iterable
from functools import cache
from typing import Any

from ..fingerprint import borders, call_of, is_record, items, mentioned
from ..kernels import Unit
from ..numba_tuning import TRUST, law_options
from ..records import Record

_OPTIONS = f"{law_options()!r} {TRUST}"


class _Law:
    """What one function says, and what it uses."""

    def __init__(self, function: Any) -> None:
        own: list[str] = []
        self.functions: list[tuple[str, Any]] = []
        self.properties: list[Any] = []
        """Laws of properties that it may read: of any record that has one of that name."""
        self.records: list[tuple[str, type[Record]]] = []
        """Those that it makes of memory, by its names for them."""
        self.names = mentioned(function.__code__)
        for item in items(function, source_of, constant_text):
            if isinstance(item, str):
                own.append(item)
            elif is_record(item[1]):
                self.records.append(item)
            elif item[0]:
                self.functions.append(item)
            else:
                self.properties.append(item[1])
        own.sort()  # names come in another order from another Python
        self.digest = _hash(own)


_laws: dict[int, _Law] = {}
"""By the function's id: code does not change while a process runs."""


def identity(unit: Unit, made_by: str, records: Iterable[type[Record]]) -> str:
    """Hash of all that the machine code of a unit, or of a kernel, is made from.

    Args:
        unit: the unit.
        made_by: what it depends on besides the functions that it reaches.
        records: classes of the records that it is called with. Of them, and of those that laws make of memory, counts
            where the fields lie that some law mentions, and no other field.
    """
    records = tuple(records)
    others = borders(unit)
    found: set[str] = set()
    names: set[str] = set()
    made: set[tuple[str, type[Record]]] = set()
    seen: set[int] = set()
    known: set[Any] = set()  # laws of properties of the records that it reaches: what else is loaded does not count
    possible: list[Any] = []
    for record in records:
        known |= _properties(record)
    waiting = [unit.function]
    while waiting:
        function = waiting.pop()
        if id(function) in seen:
            continue
        seen.add(id(function))
        law = _laws.get(id(function))
        if law is None:
            law = _laws[id(function)] = _Law(function)
        found.add(law.digest)
        names |= law.names
        made.update(law.records)
        for name, used in law.functions:
            if id(used) in others:
                found.add(call_of(name, others[id(used)]))
            else:
                waiting.append(used)
        possible += law.properties
        for _, record in law.records:
            known |= _properties(record)
        if not waiting:
            waiting = [law for law in possible if law in known]
            possible = [law for law in possible if law not in known]
    found.update(f"{name} of {record.layout(names)}" for name, record in made)
    return _hash([_OPTIONS, made_by, *(record.layout(names) for record in records), *sorted(found)])


@cache
def _properties(record: type[Record]) -> frozenset[Any]:
    """Laws of the properties of a record and of those in it."""
    found = set(record.properties.values())
    for field in record.fields.values():
        if field.record is not None:
            found |= _properties(field.record)
    return frozenset(found)


def _hash(lines: list[str]) -> str:
    return hashlib.sha256("\n".join(lines).encode()).hexdigest()[:20]


def source_of(function: Any) -> str:
    """The text of a function, without empty lines and those that are comments."""
    code = function.__code__
    lines, position = _texts(code.co_filename)
    if code.co_firstlineno > len(position):
        return repr(code.co_consts)  # made by no file: nothing to read
    start = position[code.co_firstlineno - 1]
    end, margin, body = start + 1, _margin(lines[start]), lines[start].startswith("def ", _margin(lines[start]))
    while end < len(lines):
        line = lines[end]
        if _margin(line) <= margin and not line.lstrip().startswith((")", "]", "}")):
            if body:
                break
            body = line.lstrip().startswith("def ")  # the decorators are over
        end += 1
    return "\n".join(lines[start:end])


@cache
def _texts(file: str) -> tuple[list[str], list[int]]:
    """The lines of a file that say something, and for each of all its lines how many of these come before it."""
    kept: list[str] = []
    position: list[int] = []
    for line in linecache.getlines(file):
        text = line.rstrip()
        position.append(len(kept))
        if text and not text.lstrip().startswith("#"):
            kept.append(text)
    return kept, position


def _margin(line: str) -> int:
    return len(line) - len(line.lstrip())


def constant_text(value: Any) -> str:
    """A number, a text or a tuple of such, as any version of NumPy says it."""
    if isinstance(value, float):
        return float.__repr__(value)
    if isinstance(value, tuple):
        return f"{type(value).__name__}({', '.join(map(constant_text, value))})"
    return repr(value)
