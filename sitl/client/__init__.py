# SPDX-License-Identifier: BSD-3-Clause
"""A MAVLink client in simulated time: in the vehicle's process, or by a socket.

``Client`` flies a vehicle; ``Endpoint`` only makes bytes of messages and messages of bytes. Page: docs/client.md. The
names of ``__all__`` are loaded when they are first used.
"""

from __future__ import annotations

from importlib import import_module
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from .client import Client, Moment
    from .connection import Connection, InProcess, connect
    from .endpoint import Endpoint
    from .errors import (
        ClientError,
        CommandRefusedError,
        InvariantError,
        LinkLostError,
        MissionRefusedError,
        ParameterRefusedError,
        UnknownNameError,
        WaitTimeoutError,
    )
    from .telemetry import Attitude, Position, Telemetry, Text

__all__ = [
    "Attitude", "Client", "ClientError", "CommandRefusedError", "Connection", "Endpoint", "InProcess", "InvariantError",
    "LinkLostError", "MissionRefusedError", "Moment", "ParameterRefusedError", "Position", "Telemetry", "Text",
    "UnknownNameError", "WaitTimeoutError", "connect",
]  # fmt: skip

_MODULES = {
    "client": ("Client", "Moment"),
    "connection": ("Connection", "InProcess", "connect"),
    "endpoint": ("Endpoint",),
    "telemetry": ("Attitude", "Position", "Telemetry", "Text"),
}
"""Module -> what it has; the rest is in ``errors``."""


def __getattr__(name: str) -> Any:
    if name not in __all__:
        raise AttributeError(f"module {__name__!r} has no attribute {name!r}; it has {', '.join(__all__)}")
    module = next((module for module, names in _MODULES.items() if name in names), "errors")
    value = globals()[name] = getattr(import_module(f"{__name__}.{module}"), name)
    return value
