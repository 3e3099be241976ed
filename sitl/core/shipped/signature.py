# SPDX-License-Identifier: BSD-3-Clause
"""How Python hands a kernel's arguments to its machine code: as numbers and arrays, one after another.

Named tuples and vectors are taken apart here and put together again in machine code, and the other way round for a
result. An array is handed over as the object that it is.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from typing import Annotated, Any, NamedTuple, get_args, get_origin, get_type_hints

import numpy as np

from ..records import Record, Records
from ..vectors import Value

NUMBERS = (float, int, bool)
HEADER = 16
"""Bytes before an array's own fields: CPython's of every object, 64 bit. ``library.py`` looks whether it is so."""


class ArrayLeaf(NamedTuple):
    """An array among the arguments."""

    dtype: np.dtype[Any]
    axes: int
    any_order: bool

    def takes(self, array: Any) -> bool:
        """Whether ``array`` can be handed over as it is."""
        dtype, axes, any_order = self
        if (array.dtype is not dtype and array.dtype != dtype) or array.ndim != axes:
            return False
        return array.flags.behaved if any_order else array.flags.carray  # type: ignore[no-any-return]

    def __str__(self) -> str:
        return f"{self.dtype}, {self.axes} axes"


Leaf = type | ArrayLeaf
"""``float``, ``int``, ``bool``, or an array."""


def hints_of(law: Callable[..., Any]) -> tuple[list[Any], Any]:
    """The annotations of a kernel's arguments, and that of its result."""
    hints = get_type_hints(law, include_extras=True)
    result = hints.pop("return")
    return list(hints.values()), result


def _array(hint: Any) -> ArrayLeaf | None:
    if get_origin(hint) is Annotated:
        layout = get_args(hint)[1]
        return ArrayLeaf(np.dtype(layout.code), layout.axes, layout.order == "A")
    if get_origin(hint) is Records:
        return ArrayLeaf(get_args(hint)[0].dtype, 1, False)
    return None


def _parts(hint: Any) -> dict[str, Any]:
    """Name -> annotation, of what a tuple or a vector is made of."""
    if issubclass(hint, Value):
        return dict.fromkeys(hint.NAMES, float)
    return get_type_hints(hint, include_extras=True)


def leaves(hint: Any, expression: str = "") -> Iterator[tuple[str, Leaf]]:
    """(Expression in Python, what it is) of each number and array that a value is made of."""
    array = _array(hint)
    if array is not None or hint in NUMBERS:
        yield expression, array if array is not None else hint
        return
    for name, part in _parts(hint).items():
        yield from leaves(part, f"{expression}.{name}")


def put_together(hint: Any, given: Iterator[str], classes: dict[str, type]) -> str:
    """An expression that makes a value of its leaves.

    Args:
        hint: annotation of the value.
        given: expressions of the leaves.
        classes: takes up the names that the expression needs.
    """
    if _array(hint) is not None or hint in NUMBERS:
        return next(given)
    name = f"{hint.__name__}_{len(classes)}"
    classes[name] = hint
    return f"{name}({', '.join([put_together(part, given, classes) for part in _parts(hint).values()])})"


def records_of(law: Callable[..., Any]) -> Iterator[type[Record]]:
    """Classes of the records among a kernel's arguments."""

    def inside(hint: Any) -> Iterator[type[Record]]:
        if get_origin(hint) is Records:
            yield get_args(hint)[0]
        elif _array(hint) is None and hint not in NUMBERS:
            for part in _parts(hint).values():
                yield from inside(part)

    for hint in hints_of(law)[0]:
        yield from inside(hint)


def described(law: Callable[..., Any]) -> str:
    """What the machine code of a kernel's entry depends on besides its law and the layouts of records, as text."""
    arguments, result = hints_of(law)
    found = [_described(hint) for hint in arguments]
    return f"({', '.join(found)}) -> {'none' if result is type(None) else _described(result)}"


def _described(hint: Any) -> str:
    if get_origin(hint) is Records:
        return f"records {get_args(hint)[0].__qualname__}"
    array = _array(hint)
    if array is not None:
        return f"{array.dtype.str}{array.axes}{'A' if array.any_order else 'C'}"
    if hint in NUMBERS:
        return str(hint.__name__)
    return f"{hint.__name__}({', '.join(f'{name}: {_described(part)}' for name, part in _parts(hint).items())})"
