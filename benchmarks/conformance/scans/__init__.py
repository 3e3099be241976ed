# SPDX-License-Identifier: BSD-3-Clause
"""Tables of what a client reads back from an autopilot: a module each, with ``scan(programs)``.

``scan`` gives a row's value (whatever JSON carries) by the row's name. A module may have ``agrees(ours, theirs)``, when
equality is not what is asked, and ``HEADINGS``, what a row says, for the page.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from importlib import import_module
from typing import Any

from .program import Programs

TABLES = ("acks", "items", "missions", "arming", "in-flight", "fields", "logs", "readers")
Scan = Callable[[Programs], Mapping[str, Any]]


def module(table: str) -> Any:
    """The module of a table."""
    return import_module(f"{__name__}.{table.replace('-', '_')}")
