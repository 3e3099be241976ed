# SPDX-License-Identifier: BSD-3-Clause
"""What a telemetry builder is, and the table of all of them."""

from __future__ import annotations

import importlib
import pkgutil
from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

from ..dialect import MessageType, message
from ..record_reader import RecordReader

Build = Callable[[], bytes]
"""Gives the payload now; empty when the vehicle has nothing to say (no position yet)."""
Builder = Callable[["Context"], Build]


@dataclass
class Context:
    """What builders may read."""

    reader: RecordReader
    vehicle: Any
    epoch_us: int
    """Unix time at boot [us]; the bridge moves it when the vehicle reboots."""

    def fields(self, *paths: str) -> Callable[[], tuple[Any, ...]]:
        """As :meth:`RecordReader.fields`."""
        return self.reader.fields(*paths)


def builders() -> dict[str, Builder]:
    """All builders of this package by message name (each module lists its own in ``BUILDERS``)."""
    package = importlib.import_module(__package__)
    found: dict[str, Builder] = {}
    for module in sorted(m.name for m in pkgutil.iter_modules(package.__path__)):
        found.update(getattr(importlib.import_module(f"{__package__}.{module}"), "BUILDERS", {}))
    return found


def build_all(context: Context) -> dict[int, tuple[MessageType, Build]]:
    """Every builder bound to ``context``, by message number."""
    return {
        message(name).id: (message(name), builder(context)) for name, builder in sorted(builders().items())
    }
