# SPDX-License-Identifier: BSD-3-Clause
"""A firmware's parameters in one table: it makes the record, the MAVLink service, .parm files and the docs page.

Each group file holds the parameters of one subsystem. ``groups`` here are those that every firmware has; a firmware's
own are in its ``parameters`` package. Their order in the table, by the group's name, is their order on the wire.
"""

from __future__ import annotations

import importlib
import pkgutil
from collections.abc import Iterator, Mapping
from types import ModuleType
from typing import Any

import numpy as np

from ...core.records import Record
from . import groups
from .parameter import FLOAT, Parameter


class Parameters(Record):
    """The parameters of a firmware, each in its own unit (centidegrees stay centidegrees)."""


class Table:
    """Parameters by position and by name.

    Args:
        parameters: in the order of the wire.

    Raises:
        ValueError: a name is there twice.
    """

    def __init__(self, parameters: tuple[Parameter, ...]) -> None:
        self.parameters = parameters
        self._by_name = {p.name: p for p in parameters}
        if len(self._by_name) != len(parameters):
            names = [p.name for p in parameters]
            raise ValueError(f"parameters defined twice: {sorted({n for n in names if names.count(n) > 1})}")
        self.record = type("Parameters", (Parameters,), {"__annotations__": {p.name: float for p in parameters}})
        """A float field a parameter, in the parameter's own unit (centidegrees stay centidegrees)."""

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

    def set_defaults(self, params: Any) -> None:
        """Set every field of a params record to its default."""
        for p in self.parameters:
            params[p.name] = stored(p, p.default)


def collect(own: ModuleType, defaults: Mapping[str, float]) -> Table:
    """The table of a firmware: the shared groups, and those in its package ``own``.

    Args:
        own: the firmware's package of group files.
        defaults: where the firmware's default of a shared parameter differs.

    Raises:
        ValueError: a name is there twice, or ``defaults`` names a parameter that is not shared.
    """
    shared = _groups(groups)
    known = {p.name for _, found in shared for p in found}
    if not known >= defaults.keys():
        raise ValueError(f"defaults of parameters that are not shared: {sorted(defaults.keys() - known)}")
    adapted = [(name, tuple(p._replace(default=defaults.get(p.name, p.default)) for p in ps)) for name, ps in shared]
    every = sorted([*adapted, *_groups(own)], key=lambda group: group[0])
    return Table(tuple(p for _, found in every for p in found))


def _groups(package: ModuleType) -> list[tuple[str, tuple[Parameter, ...]]]:
    names = [m.name for m in pkgutil.iter_modules(package.__path__)]
    return [(name, importlib.import_module(f"{package.__name__}.{name}").PARAMETERS) for name in names]


def stored(parameter: Parameter, value: float) -> float:
    """``value`` as the firmware keeps it: integers truncate, floats round to float32 as on the wire."""
    return float(np.float32(value)) if parameter.kind == FLOAT else float(int(value))
