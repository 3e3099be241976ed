# SPDX-License-Identifier: BSD-3-Clause
"""The truth (HIL_STATE_QUATERNION) and hard touches (DEBUG_VECT): what only physics knows.

DEBUG_VECT "HITGROUND" and "HITSOLID": hard touches; x is the speed into what was touched [m/s].

MAVLink has no message for them. ``time_usec`` is the tick in which it happened.
"""

from __future__ import annotations

from typing import Any

from ...core.record_reader import RecordReader
from ...core.sums import lengths
from ...physics.carried import Carried
from ..dialect import message
from ..telemetry.units import uint16
from .protocol import LATEST_US, RefusedError, culprit, within

TRUTH_KIND = message("HIL_STATE_QUATERNION")
_TRUTH_LIMITS = (*(1.1,) * 4, *(1e3,) * 3)
_NAMES = ("attitude w", "attitude x", "attitude y", "attitude z", "rollspeed", "pitchspeed", "yawspeed")
NOWHERE = Carried((1.0, 0.0, 0.0, 0.0), (0.0,) * 3, 0, 0, 0, (0,) * 3, (0,) * 3)


def truth_payload(time_us: int, truth: Carried) -> bytes:
    """The message; air speed is the speed over the ground, as without wind."""
    speed = uint16(lengths(truth.velocity))
    location = truth.lat, truth.lon, truth.alt
    return TRUTH_KIND.pack(
        time_us, *truth.attitude, *truth.rates, *location, *truth.velocity, speed, speed, *truth.acceleration
    )


def read_truth(payload: bytes) -> tuple[int, Carried]:
    """Time [us] and truth.

    Raises:
        RefusedError: attitude or rates that are not finite or absurd.
    """
    t, *values = TRUTH_KIND.unpack_from(payload.ljust(TRUTH_KIND.size, b"\0"))
    if not within(values[:7], _TRUTH_LIMITS):
        raise culprit(TRUTH_KIND.name, _NAMES, values[:7], _TRUTH_LIMITS)
    a, b, c, d, p, q, r, lat, lon, alt, vn, ve, vd, _, _, ax, ay, az = values
    return t, Carried((a, b, c, d), (p, q, r), lat, lon, alt, (vn, ve, vd), (ax, ay, az))


HITS_KIND = message("DEBUG_VECT")
GROUND, SOLID = "HITGROUND", "HITSOLID"
_HITS_LIMITS = (1e4,)

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
        return [HITS_KIND.pack(at, speed, 0.0, 0.0, self._name)] if count and at == now else []


class HitReader:
    """From payloads into a record, where the autopilot's tick looks for touches."""

    def __init__(self, v: Any) -> None:
        self._contacts: dict[str, Any] = {SOLID: v.physics.obstacles}
        if hasattr(v.physics, "ground"):
            self._contacts[GROUND] = v.physics.ground

    def read(self, payload: bytes) -> Hit | None:
        """The touch; None when the message is about something else.

        Raises:
            RefusedError: a speed that is not finite or absurd.
        """
        fields = HITS_KIND.decode(payload)
        name = fields.name.decode("ascii", "replace")
        if name not in self._contacts:
            return None
        if not within((fields.x,), _HITS_LIMITS):
            raise culprit(HITS_KIND.name, ("x",), (fields.x,), _HITS_LIMITS)
        if fields.time_usec >= LATEST_US:
            raise RefusedError(f"{HITS_KIND.name}.time_usec = {fields.time_usec}")
        return fields.time_usec, fields.x, name

    def write(self, hit: Hit) -> None:
        """Put a touch into the record."""
        contact = self._contacts[hit[2]]
        contact.hit_time_us, contact.hit_speed = hit[0], hit[1]
        contact.hit_count += 1
