# SPDX-License-Identifier: BSD-3-Clause
"""A MAVLink client in simulated time: in the vehicle's process, or by a socket.

``Client`` flies a vehicle; ``Endpoint`` only makes bytes of messages and messages of bytes. Page: docs/client.md.
"""

from ..errors import LinkLostError
from .client import Client, Moment
from .connection import Connection, InProcess, connect
from .endpoint import Endpoint
from .errors import (
    ClientError,
    CommandRefusedError,
    FileRefusedError,
    ImpossibleWaitError,
    InvariantError,
    MissionRefusedError,
    ParameterRefusedError,
    UnknownNameError,
    WaitTimeoutError,
)
from .files import Log
from .telemetry import Attitude, Position, Telemetry, Text

__all__ = [
    "Attitude", "Client", "ClientError", "CommandRefusedError", "Connection", "Endpoint", "FileRefusedError",
    "ImpossibleWaitError", "InProcess", "InvariantError", "LinkLostError", "Log", "MissionRefusedError", "Moment",
    "ParameterRefusedError", "Position", "Telemetry", "Text", "UnknownNameError", "WaitTimeoutError", "connect",
]  # fmt: skip
