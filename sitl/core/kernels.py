# SPDX-License-Identifier: BSD-3-Clause
"""Laws and units: how plain Python functions on records become the compiled core.

*Law*: a plain function on records and floats. Outside the compiled core it stays plain Python (tests, the shell and a
debugger call it as it is); inside a unit Numba compiles it into the caller.

*Unit*: a law compiled on its own, with the C signature ``void(vehicles*, int64 count, int64 index, int64 ...)``, and
called by other units through its address. Units are the grain of compilation: editing a law recompiles the units that
reach it and no other, and units compile side by side in several processes.

With ``NUMBA_DISABLE_JIT=1`` nothing is compiled and the same functions run as plain Python.
"""

from __future__ import annotations

import os
from collections.abc import Callable
from dataclasses import dataclass
from typing import Any, TypeVar

F = TypeVar("F", bound=Callable[..., Any])

LAWS: list[Callable[..., Any]] = []
INLINED: set[Callable[..., Any]] = set()
"""Laws that are never calls."""
UNITS: dict[str, Unit] = {}


@dataclass(frozen=True)
class Unit:
    """One separately compiled function of the core."""

    name: str
    function: Callable[..., Any]
    integers: int
    """Number of int64 arguments after ``(fleet, index)``."""
    inline: bool = False
    """All its laws are compiled into one function: faster, where that does not take much longer to compile."""

    @property
    def symbol(self) -> str:
        """Name under which other units link to this one."""
        return "sitl_" + self.name.replace(".", "_")


def jit_disabled() -> bool:
    """Whether the user asked for plain Python (``NUMBA_DISABLE_JIT=1``, Numba's own switch)."""
    return os.environ.get("NUMBA_DISABLE_JIT", "0") not in ("", "0")


def law(function: F) -> F:
    """Mark a function as compilable into a unit; it is returned unchanged."""
    LAWS.append(function)
    return function


def inlined(function: F) -> F:
    """Mark a law that is never a call in the core: one of a few instructions, or one that runs every tick and is called
    in few places."""
    INLINED.add(function)
    return law(function)


def unit(function: F) -> F:
    """Mark ``function(fleet, index, *integers)`` as a separately compiled unit; it is returned unchanged."""
    return _unit(function, False)


def inline_unit(function: F) -> F:
    """The same for a unit that runs every tick and is small: all its laws are compiled into one function."""
    return _unit(function, True)


def _unit(function: F, inline: bool) -> F:
    name = function.__module__.removeprefix("sitl.") + "." + function.__name__
    UNITS[name] = Unit(name, function, function.__code__.co_argcount - 2, inline)
    return function
