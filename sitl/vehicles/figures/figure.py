# SPDX-License-Identifier: BSD-3-Clause
"""One figure of a vehicle as data, and its declaration as a field of a record."""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import Any, NamedTuple

from ...core.records import Record, array, noted


class Figure(NamedTuple):
    """A figure: a number, or a vector of ``length`` numbers."""

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
    """Values of the kind's model figure that need it; empty: all do."""


def figure(
    unit: str, meaning: str, low: float = 0.0, high: float = math.inf, default: float | Sequence[float] | None = None,
    *, models: tuple[int, ...] = (), count: int = 0,
) -> Any:  # fmt: skip
    """Declares a figure as a field of a record: ``mass: float = figure("kg", "everything included", 1e-3, 1e4)``.

    Args:
        unit, meaning, low, high, default, models: as of ``Figure``.
        count: ``speeds: Floats = figure(..., count=8)`` declares an array.
    """
    return noted(Figure("", unit, meaning, low, high, default, models=models), array(count) if count else None)


def figures(record: type[Record]) -> tuple[Figure, ...]:
    """All figures that a record declares, in its order."""
    return tuple(
        field.note._replace(name=name, length=field.shape[0] if field.shape else 1, whole=field.value is int)
        for name, field in record.fields.items()
    )
