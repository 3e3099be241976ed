# SPDX-License-Identifier: BSD-3-Clause
"""A law that is chosen by a number: of a flight mode, for instance."""

from __future__ import annotations

import linecache
from collections.abc import Callable, Mapping
from typing import Any, Concatenate, ParamSpec, TypeVar

from .kernels import law

P = ParamSpec("P")
R = TypeVar("R")


def by_number(
    name: str, laws: Mapping[int, Callable[P, R]], otherwise: Callable[P, R]
) -> Callable[Concatenate[int, P], R]:
    """A law ``name(number, *arguments)``: calls the law of that number, ``otherwise`` when it has none.

    The laws must take the same arguments and return the same type. What comes out is a plain function: a chain of
    ifs, with the laws as its globals, as if it were written by hand.
    """
    count = otherwise.__code__.co_argcount
    arguments = ", ".join(otherwise.__code__.co_varnames[:count])
    names: dict[str, Any] = {"otherwise": otherwise, "__name__": otherwise.__module__}
    lines = [f"def {name}(number, {arguments}):"]
    for number, chosen in laws.items():
        if chosen is not otherwise:
            names[f"law_{number}"] = chosen
            lines += [f"    if number == {number}:", f"        return law_{number}({arguments})"]
    lines.append(f"    return otherwise({arguments})")
    text = "\n".join(lines) + "\n"
    file = f"<{name} by number of {otherwise.__module__}: {', '.join(map(str, laws))}>"
    linecache.cache[file] = (len(text), None, text.splitlines(keepends=True), file)  # for Numba, and shipped.identity
    exec(compile(text, file, "exec"), names)
    made: Callable[Concatenate[int, P], R] = law(names[name])
    return made
