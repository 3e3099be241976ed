# SPDX-License-Identifier: BSD-3-Clause
"""Digests of what a vehicle sends and of its state."""

from __future__ import annotations

import hashlib
import struct
import zlib
from typing import Any

from ..simulation import Simulation

_TIME = struct.Struct("<q")
_LONGEST = 1 << 16


class Sent:
    """Digest of all frames to one client, with their simulated times."""

    def __init__(self) -> None:
        self.count = 0
        """Bytes that were sent."""
        self._hash = hashlib.sha256()
        self._pending: list[bytes] = []
        self._size = 0
        self._last = -1

    def add(self, time_us: int, frames: list[bytes]) -> None:
        """Frames that go out at ``time_us``."""
        pending = self._pending
        if time_us != self._last:
            self._last = time_us
            pending.append(_TIME.pack(time_us))
        pending += frames
        size = sum(map(len, frames))
        self.count += size
        self._size += size
        if self._size > _LONGEST:
            self._take()

    def _take(self) -> None:
        self._hash.update(b"".join(self._pending))
        self._pending.clear()
        self._size = 0

    def digest(self) -> bytes:
        """Digest of all bytes so far."""
        self._take()
        return self._hash.digest()


def of_state(simulation: Simulation) -> str:
    """Digest of the vehicle's whole record: body, sensors, autopilot."""
    record: Any = simulation.fleet.view("u1")
    return hashlib.sha256(record).hexdigest()


def check(simulation: Simulation, sent: dict[int, Sent]) -> bytes:
    """Four bytes of the record's digest and four of all telemetry's."""
    state = zlib.crc32(simulation.fleet.view("u1"))  # type: ignore[arg-type]
    telemetry = 0
    for number in sorted(sent):
        telemetry = zlib.crc32(sent[number].digest(), telemetry)
    return struct.pack("<II", state, telemetry)
