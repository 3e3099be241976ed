# SPDX-License-Identifier: BSD-3-Clause
"""DEBUG_VECT "HITGROUND" and "HITSOLID": hard touches; x is the speed into what was touched [m/s].

MAVLink has no message for them. ``time_usec`` is the tick in which it happened.
"""

from __future__ import annotations

from typing import Any

from ...core.record_reader import RecordReader
from ..dialect import message
from .numbers import LATEST_US, RefusedError, culprit, within

KIND = message("DEBUG_VECT")
GROUND, SOLID = "HITGROUND", "HITSOLID"
_LIMITS = (1e4,)

Hit = tuple[int, float, str]
"""Time [us], speed [m/s], what was touched."""


class HitWriter:
    """From a record to payloads: of one thing that can be touched.

    Args:
        reader: of the record.
        where: "physics.ground" or "physics.obstacles".
        name: GROUND or SOLID.
    """

    def __init__(self, reader: RecordReader, where: str, name: str) -> None:
        self.marks = (where + ".hit_count",)
        self._read = reader.fields("time_us", where + ".hit_time_us", where + ".hit_count", where + ".hit_speed")
        self._name = name.encode()

    def payloads(self) -> list[bytes]:
        """The touch of this tick, if there was one: others are history."""
        now, at, count, speed = self._read()
        return [KIND.pack(at, speed, 0.0, 0.0, self._name)] if count and at == now else []


class HitReader:
    """From payloads into a record, where the autopilot's tick looks for touches."""

    def __init__(self, v: Any) -> None:
        self._places: dict[str, Any] = {SOLID: v.physics.obstacles}
        if hasattr(v.physics, "ground"):
            self._places[GROUND] = v.physics.ground

    def read(self, payload: bytes) -> Hit | None:
        """The touch; None when the message is about something else.

        Raises:
            RefusedError: a speed that is not finite or absurd.
        """
        fields = KIND.decode(payload)
        name = fields.name.decode("ascii", "replace")
        if name not in self._places:
            return None
        if not within((fields.x,), _LIMITS):
            raise culprit(KIND.name, ("x",), (fields.x,), _LIMITS)
        if fields.time_usec >= LATEST_US:
            raise RefusedError(f"{KIND.name}.time_usec = {fields.time_usec}")
        return fields.time_usec, fields.x, name

    def write(self, hit: Hit) -> None:
        """Put a touch into the record."""
        place = self._places[hit[2]]
        place.hit_time_us, place.hit_speed = hit[0], hit[1]
        place.hit_count += 1
