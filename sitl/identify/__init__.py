# SPDX-License-Identifier: BSD-3-Clause
"""The airframe of a copter or rover from its logs, each property with a 95 % interval (docs/identify.md).

from sitl.identify import identify

found = identify(["flight.bin"], mass=1.8)
print(found.table())
found.write("my_copter.toml")
"""

from __future__ import annotations

from importlib import import_module
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from .estimate import Estimate
    from .identification import Identification, identify
    from .log_streams import FlightLog, IdentifyError

__all__ = ["Estimate", "FlightLog", "Identification", "IdentifyError", "identify"]

_MODULES = {
    "Estimate": "estimate",
    "FlightLog": "log_streams",
    "Identification": "identification",
    "IdentifyError": "log_streams",
    "identify": "identification",
}


def __getattr__(name: str) -> Any:
    """Loaded when it is first used: the command line must work without scipy."""
    if name not in _MODULES:
        raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
    return getattr(import_module(f"{__name__}.{_MODULES[name]}"), name)
