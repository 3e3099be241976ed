# SPDX-License-Identifier: BSD-3-Clause
"""One figure of a vehicle as data, and the record type of many."""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import Any, NamedTuple

from ...core.records import Record, array


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


def figures_record(kind: str, figures: Sequence[Figure]) -> type[Record]:
    """A record with one field for each figure, under its name; ``kind`` of vehicle, "Copter", names the record."""
    members: dict[str, Any] = {"__annotations__": {f.name: int if f.whole else float for f in figures}}
    for figure in figures:
        if figure.length > 1:
            members[figure.name] = array(figure.length, stored="i8" if figure.whole else "f8")
    return type(f"{kind}Figures", (Record,), {**members, "__module__": __name__})
