# SPDX-License-Identifier: BSD-3-Clause
"""What a telemetry builder is, and the table of all of them."""

from __future__ import annotations

import importlib
import pkgutil
from collections.abc import Callable
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

from ...core.record_reader import RecordReader
from ..dialect import MessageType, message

if TYPE_CHECKING:
    from ..profile import Profile

Build = Callable[[], bytes | tuple[bytes, ...]]
"""Gives the payload now: empty when the vehicle has nothing to say (no position yet), several when one is too small."""
Builder = Callable[["Context"], Build]


@dataclass
class Context:
    """What builders may read."""

    reader: RecordReader
    vehicle: Any
    profile: Profile
    epoch_us: int
    """Unix time at boot [us]; the bridge moves it when the vehicle reboots."""

    def fields(self, *paths: str) -> Callable[[], tuple[Any, ...]]:
        """As :meth:`RecordReader.fields`."""
        return self.reader.fields(*paths)


_registered: dict[str, Builder] = {}


def register_builder(name: str, builder: Builder) -> None:
    """Make a message of another package known in this process: every bridge made from now on can send it.

    Args:
        name: of the message, as the dialect has it.
        builder: called once for each vehicle; what it returns gives the payload whenever the message is due.
    """
    message(name)  # refuses a name that there is not
    _registered[name] = builder


def builders(profile: Profile) -> dict[str, Builder]:
    """All builders by message name: this package's (each module lists its own in ``BUILDERS``) and the firmware's."""
    package = importlib.import_module(__package__)
    found: dict[str, Builder] = {}
    for module in sorted(m.name for m in pkgutil.iter_modules(package.__path__)):
        found.update(getattr(importlib.import_module(f"{__package__}.{module}"), "BUILDERS", {}))
    return found | dict(profile.builders) | _registered


def build_all(context: Context) -> dict[int, tuple[MessageType, Build]]:
    """Every builder bound to ``context``, by message number."""
    return {
        message(name).id: (message(name), builder(context))
        for name, builder in sorted(builders(context.profile).items())
    }
