# SPDX-License-Identifier: BSD-3-Clause
"""Calls of kernels that came with the package."""

from __future__ import annotations

import ctypes
from collections.abc import Callable, Iterator
from functools import partial
from typing import Any

import numpy as np

from .library import Library, kernel_symbol
from .signature import NUMBERS, ArrayLeaf, hints_of, leaves, put_together

_TYPES: dict[type, Any] = {float: ctypes.c_double, int: ctypes.c_int64, bool: ctypes.c_bool}


class Calls:
    """A kernel of a library, as functions that take what its law takes.

    Args:
        library: where the machine code is.
        name: the kernel's.
        law: what it was made of.
        lets_others_run: other threads of Python run meanwhile.
    """

    def __init__(self, library: Library, name: str, law: Callable[..., Any], lets_others_run: bool) -> None:
        self._name = name
        self._names = law.__code__.co_varnames[: law.__code__.co_argcount]
        self._hints, self._result = hints_of(law)
        self._parts = 0 if self._result in (*NUMBERS, type(None)) else len(list(leaves(self._result)))
        symbol = kernel_symbol(name)
        if lets_others_run and not self._parts:
            types = [
                _TYPES.get(leaf, ctypes.py_object)  # type: ignore[arg-type]
                for hint in self._hints
                for _, leaf in leaves(hint)
            ]
            self._entry = library.function(symbol, types, _TYPES.get(self._result))
        else:
            self._entry = library.method(symbol)
        self.checked, self.unchecked = self._function(True), self._function(False)
        if not self._parts and all(len(list(leaves(hint))) == 1 for hint in self._hints):
            self.unchecked = self._entry  # nothing to take apart

    def bind(self, *arguments: Any) -> Callable[..., Any]:
        """A function of the other arguments only, whose types are not looked at.

        Raises:
            TypeError: these are not of the kernel's types.
        """
        count = len(arguments)
        check: dict[str, Any] = {}
        exec(self._source(self._names[:count], self._hints[:count], True, "return [{}]"), self._space(), check)
        flat = check["call"](*arguments)
        rest = [list(leaves(hint)) for hint in self._hints[count:]]
        if self._parts or any(len(one) != 1 for one in rest):
            return partial(self.unchecked, *arguments)
        return partial(self._entry, *flat)

    def _function(self, checked: bool) -> Callable[..., Any]:
        space = self._space()
        made: dict[str, Any] = {}
        if self._parts:
            whole = (f"r[{k}]" if leaf is float else f"{leaf.__name__}(r[{k}])" for k, leaf in self._result_leaves())
            found = put_together(self._result, whole, space)
            space["empty"] = np.empty
            body = f"r = empty({self._parts})\n    entry({{}}, r)\n    r = r.tolist()\n    return {found}"
        else:
            body = "return entry({})"
        exec(self._source(self._names, self._hints, checked, body), space, made)
        return made["call"]  # type: ignore[no-any-return]

    def _result_leaves(self) -> Iterator[tuple[int, Any]]:
        for k, (_, leaf) in enumerate(leaves(self._result)):
            yield k, leaf

    def _space(self) -> dict[str, Any]:
        """What the source of a function refers to."""
        arrays = {f"array_{k}": leaf for k, leaf in enumerate(self._arrays())}
        return {"entry": self._entry, "refuse": self._refuse, **arrays}

    def _arrays(self) -> Iterator[ArrayLeaf]:
        for hint in self._hints:
            for _, leaf in leaves(hint):
                if isinstance(leaf, ArrayLeaf):
                    yield leaf

    def _source(self, names: tuple[str, ...], hints: list[Any], checked: bool, body: str) -> str:
        """A function ``call`` that takes arguments apart; in ``body`` are its lines, with a placeholder for the
        parts."""
        lines, parts, number = [f"def call({', '.join(names)}):"], [], 0
        tests = []
        for name, hint in zip(names, hints):
            for expression, leaf in leaves(hint, name):
                parts.append(expression)
                if isinstance(leaf, ArrayLeaf):
                    tests.append(f"array_{number}.takes({expression})")
                    number += 1
        if checked and tests:
            lines += [
                "    try:",
                f"        good = {' and '.join(tests)}",
                "    except AttributeError:",
                "        good = False",
                "    if not good:",
                f"        refuse({', '.join(names)})",
            ]
        lines.append("    " + body.format(", ".join(parts)))
        return "\n".join(lines) + "\n"

    def _refuse(self, *given: Any) -> None:
        wanted = ", ".join(_said(hint) for hint in self._hints[: len(given)])
        got = ", ".join(f"{value.dtype}, {value.ndim} axes" if hasattr(value, "dtype") else type(value).__name__
                        for value in given)  # fmt: skip
        raise TypeError(f"{self._name} takes ({wanted}), not ({got})")


def _said(hint: Any) -> str:
    found = [leaf for _, leaf in leaves(hint)]
    if len(found) == 1 and isinstance(found[0], ArrayLeaf):
        return str(found[0])
    return str(hint.__name__)
