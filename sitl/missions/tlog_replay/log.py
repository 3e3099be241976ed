# SPDX-License-Identifier: BSD-3-Clause
"""A .tlog as messages with sender and time; which sender is the vehicle."""

from __future__ import annotations

from collections import Counter
from pathlib import Path
from typing import Any, NamedTuple

from sitl.bridge.frame import Splitter
from sitl.core.mavlink import MavAutopilot, MavModeFlag
from sitl.logs.tlog import LogError, read_steady

from ..files.document import kind_of_type

MOST_MESSAGES = 5_000_000
"""Of a log: 15 hours at 90 a second."""


class LoggedMessage(NamedTuple):
    """One message of the log."""

    time: float
    """Time since the first frame [s]."""
    system: int
    component: int
    name: str
    fields: Any


class Log:
    """A log with its vehicle.

    Args:
        path: path of the .tlog.
        system: system of the vehicle, when the log has several.

    Raises:
        LogError: the file cannot be read, or it has no vehicle that we have (or several).
    """

    def __init__(self, path: str | Path, system: int | None = None) -> None:
        self.path = Path(path)
        self.messages, self.clock_set = _read(self.path)
        """Messages in order; number of times that the clock was set. Times leave these jumps out."""
        types = Counter(
            (s.system, int(s.fields.type))
            for s in self.messages
            if s.name == "HEARTBEAT" and s.component == 1 and s.fields.autopilot != MavAutopilot.INVALID
        )
        found = {number: type_ for (number, type_), _ in reversed(types.most_common())}
        title = f"log {str(path)!r}"
        if not found:
            raise LogError(f"{title} has no HEARTBEAT of an autopilot: it tells of no vehicle")
        if system is None and len(found) > 1:
            raise LogError(
                f"{title} has vehicles {', '.join(str(n) for n in sorted(found))}: say which one with --system N"
            )
        self.system = next(iter(found)) if system is None else system
        """System id of the vehicle."""
        if self.system not in found:
            raise LogError(f"{title} has no vehicle {system}; it has {', '.join(str(n) for n in sorted(found))}")
        kind = kind_of_type(found[self.system])
        if kind is None:
            raise LogError(
                f"{title}: vehicle {self.system} is of MAV_TYPE {found[self.system]}, neither a multicopter nor a rover"
            )
        self.kind: str = kind
        """Name of the kind of vehicle."""

    @property
    def duration(self) -> float:
        """Time from the first frame to the last [s]."""
        return self.messages[-1].time if self.messages else 0.0

    def of_vehicle(self, *names: str) -> list[LoggedMessage]:
        """Messages of these names from the vehicle's autopilot."""
        return [s for s in self.messages if s.system == self.system and s.component == 1 and s.name in names]

    def to_vehicle(self) -> list[LoggedMessage]:
        """Messages from others to the vehicle, or to all systems."""
        return [
            s
            for s in self.messages
            if (s.system != self.system or s.component != 1)  # a companion may have the vehicle's system id
            and getattr(s.fields, "target_system", 0) in (0, self.system)
        ]

    def changes(self, of: str) -> list[tuple[float, int]]:
        """(time [s], value) at each change of "mode" or "armed" in the vehicle's HEARTBEATs."""
        found: list[tuple[float, int]] = []
        for message in self.of_vehicle("HEARTBEAT"):
            value = (
                int(message.fields.custom_mode)
                if of == "mode"
                else int(bool(message.fields.base_mode & MavModeFlag.SAFETY_ARMED))
            )
            if not found or found[-1][1] != value:
                found.append((message.time, value))
        return found


def _read(path: Path) -> tuple[list[LoggedMessage], int]:
    found: list[LoggedMessage] = []
    splitter = Splitter()
    jumps_so_far = 0
    try:
        for jumps, time_us, raw in read_steady(path):
            jumps_so_far = jumps
            for frame in splitter.feed(raw):
                if len(found) == MOST_MESSAGES:
                    raise LogError(f"log {str(path)!r} holds more than {MOST_MESSAGES} messages: too many to fly again")
                fields = frame.kind.decode(frame.payload)
                found.append(LoggedMessage(time_us * 1e-6, frame.system, frame.component, frame.kind.name, fields))
    except OSError as error:
        raise LogError(f"log {str(path)!r} cannot be read: {error.strerror or error}") from None
    if not found:
        raise LogError(f"log {str(path)!r} holds no MAVLink frame: it is no .tlog")
    return found, jumps_so_far
