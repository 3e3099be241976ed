# SPDX-License-Identifier: BSD-3-Clause
"""A firmware's parameters in one table, made from its record: the MAVLink service, .parm files and the docs page."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from .parameter import FLOAT, Parameter, rows
from .parameters import Parameters


class Table:
    """Parameters by position and by name.

    Args:
        record: its fields are in the order of the wire.

    Raises:
        ValueError: a name is there twice.
    """

    def __init__(self, record: type[Parameters]) -> None:
        self.record = record
        self.parameters = tuple(rows(record))
        self._by_name = {p.name: p for p in self.parameters}
        if len(self._by_name) != len(self.parameters):
            names = [p.name for p in self.parameters]
            raise ValueError(f"parameters defined twice: {sorted({n for n in names if names.count(n) > 1})}")

    def __iter__(self) -> Iterator[Parameter]:
        return iter(self.parameters)

    def __len__(self) -> int:
        return len(self.parameters)

    def __contains__(self, name: object) -> bool:
        return name in self._by_name

    def __getitem__(self, name: str) -> Parameter:
        return self._by_name[name]

    def at(self, index: int) -> Parameter:
        """The parameter at a position on the wire."""
        return self.parameters[index]

    def names(self) -> tuple[str, ...]:
        """All names, in the order of the wire."""
        return tuple(self._by_name)

    def set_defaults(self, params: Parameters) -> None:
        """Set every field of a params record to its default."""
        for p in self.parameters:
            params[p.name] = stored(p, p.default)


def stored(parameter: Parameter, value: float) -> float:
    """``value`` as the firmware keeps it: integers truncate, floats round to float32 as on the wire."""
    return float(np.float32(value)) if parameter.kind == FLOAT else float(int(value))
