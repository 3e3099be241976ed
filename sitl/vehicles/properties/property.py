# SPDX-License-Identifier: BSD-3-Clause
"""One property of a vehicle as data, and its declaration as a field of a record."""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import Any, NamedTuple

from ...core.records import Record, array, noted


class Property(NamedTuple):
    """A property: a number, or a vector of ``length`` numbers."""

    name: str
    unit: str
    """"" for a number without one."""
    meaning: str
    low: float = 0.0
    """Smallest value of each element."""
    high: float = math.inf
    default: float | Sequence[float] | None = None
    """What it is when it is left out; None: it must be given."""
    length: int = 1
    whole: bool = False
    """Kept as an integer."""
    models: tuple[int, ...] = ()
    """Values of the kind's model property that need it; empty: all do."""


def described(
    unit: str, meaning: str, low: float = 0.0, high: float = math.inf, default: float | Sequence[float] | None = None,
    *, models: tuple[int, ...] = (), count: int = 0,
) -> Any:  # fmt: skip
    """Declares a property as a field of a record: ``mass: float = property("kg", "everything included", 1e-3, 1e4)``.

    Args:
        unit, meaning, low, high, default, models: as of ``Property``.
        count: ``speeds: Floats = property(..., count=8)`` declares an array.
    """
    return noted(Property("", unit, meaning, low, high, default, models=models), array(count) if count else None)


def properties(record: type[Record]) -> tuple[Property, ...]:
    """All properties that a record declares, in its order."""
    return tuple(
        field.note._replace(name=name, length=field.shape[0] if field.shape else 1, whole=field.value is int)
        for name, field in record.fields.items()
    )
