# SPDX-License-Identifier: BSD-3-Clause
"""All parameters of the firmware in one table: it makes the record, the MAVLink service, .parm files and the docs page.

Each group file holds the parameters of one subsystem; their order here is their order on the wire.
"""

from __future__ import annotations

import importlib
import pkgutil

import numpy as np

from ...core.records import record
from . import groups
from .parameter import FLOAT, Parameter


def _collect() -> tuple[Parameter, ...]:
    found: list[Parameter] = []
    for module in sorted(m.name for m in pkgutil.iter_modules(groups.__path__)):
        found.extend(importlib.import_module(f"{groups.__name__}.{module}").PARAMETERS)
    names = [p.name for p in found]
    twice = {n for n in names if names.count(n) > 1}
    if twice:
        raise ValueError(f"parameters defined twice: {sorted(twice)}")
    return tuple(found)


TABLE = _collect()
BY_NAME = {p.name: p for p in TABLE}
INDEX = {p.name: k for k, p in enumerate(TABLE)}

PARAMS_DTYPE = record(*((p.name, "f8") for p in TABLE))
"""One f8 field a parameter, in the parameter's own unit (centidegrees stay centidegrees)."""


def stored(parameter: Parameter, value: float) -> float:
    """``value`` as the firmware keeps it: integers truncate, floats round to float32 as on the wire."""
    return float(np.float32(value)) if parameter.kind == FLOAT else float(int(value))


def set_defaults(params) -> None:
    """Set every field of a params record to its default."""
    for p in TABLE:
        params[p.name] = stored(p, p.default)
