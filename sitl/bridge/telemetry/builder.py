# SPDX-License-Identifier: BSD-3-Clause
"""What a telemetry builder is, and the table of all of them; numbers to integers for the wire.

Integers are saturated and never raise an exception (NaN gives the lower limit).
"""

from __future__ import annotations

import importlib
import math
import pkgutil
from collections.abc import Callable
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

from ...core.record_reader import RecordReader
from ..dialect import MessageType, message

DEG = 180.0 / math.pi
CDEG = 18000.0 / math.pi
"""Radians to centidegrees."""


def int16(x: float) -> int:
    """Truncated and limited to -32768 .. 32767."""
    return int(x) if -32768.0 < x < 32767.0 else (32767 if x >= 32767.0 else -32768)


def uint16(x: float) -> int:
    """Truncated and limited to 0 .. 65535."""
    return int(x) if 0.0 <= x < 65535.0 else (65535 if x >= 65535.0 else 0)


def int32(x: float) -> int:
    """Rounded to the nearest and limited to 32 bits."""
    if -2147483648.0 < x < 2147483647.0:
        return math.floor(x + 0.5)
    return 2147483647 if x >= 2147483647.0 else -2147483648


def percent(x: float) -> int:
    """Truncated to 0 .. 100; -1 ("unknown") for what is below 0 or not a number."""
    return int(min(x, 100.0)) if x >= 0.0 else -1


def heading_cdeg(yaw: float) -> int:
    """Angle [rad] as 0 .. 35999 centidegrees; 0 for what is not a number."""
    c = yaw * CDEG
    return int(c % 36000.0) % 36000 if -1e9 < c < 1e9 else 0


def boot_ms(time_us: int) -> int:
    """Milliseconds since boot as MAVLink's uint32."""
    return time_us // 1000 & 0xFFFFFFFF


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
