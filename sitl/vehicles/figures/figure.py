# SPDX-License-Identifier: BSD-3-Clause
"""One figure of a vehicle as data, and the record type of many."""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import Any, NamedTuple

import numpy as np

from ...core.records import record


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


def figures_dtype(figures: Sequence[Figure]) -> np.dtype[Any]:
    """A record with one field for each figure, under its name."""
    fields: list[tuple[Any, ...]] = []
    for figure in figures:
        form = "i8" if figure.whole else "f8"
        fields.append((figure.name, form) if figure.length == 1 else (figure.name, form, figure.length))
    return record(*fields)
