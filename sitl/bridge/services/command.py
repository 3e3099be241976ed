# SPDX-License-Identifier: BSD-3-Clause
"""A command from COMMAND_LONG or COMMAND_INT, in one shape."""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import Any, NamedTuple

from ...core.mavlink import MavFrame, MavResult
from ..channel import Channel
from ..host import Host


class Command(NamedTuple):
    """One command; numbers are finite, a NaN ("not given") has become 0."""

    number: int
    p1: float
    p2: float
    p3: float
    p4: float
    lat: int
    """[degE7]"""
    lon: int
    z: float
    """p7: altitude [m] or whatever the command makes of it."""
    frame: int
    p5: float
    """As given, for commands that are not about a location."""
    p6: float
    sender: tuple[int, int] = (0, 0)
    """System and component."""


HIGHEST_M = 83_000.0
"""ArduPilot keeps no altitude of a location that is further from zero."""


class Entry(NamedTuple):
    """How a command is carried out."""

    run: Callable[[Host, Channel, Command], int]
    """Gives the MAV_RESULT."""
    required: tuple[int, ...] = ()
    """Parameters (1..7) that must be numbers: NaN is refused with DENIED."""
    has_location: bool = False
    """p5, p6 are latitude and longitude [deg] in COMMAND_LONG."""
    int_only: bool = False
    """COMMAND_LONG is UNSUPPORTED: single precision cannot say where."""
    long_frame: int = MavFrame.GLOBAL_RELATIVE_ALT
    """Frame of a COMMAND_LONG, which has none."""
    takes_nan: bool = False
    """A NaN stays one."""
    off_earth: bool = False
    """``run`` answers a location that is not on Earth, too; else that is DENIED."""


def result(ok: bool) -> int:
    """The MAV_RESULT of what was done, or could not be."""
    return MavResult.ACCEPTED if ok else MavResult.FAILED


def answered(bridge: Host, ok: bool) -> int:
    """The same after the autopilot's texts on it have been sent."""
    bridge.say_pending()
    return result(ok)


def from_long(fields: Any, entry: Entry) -> Command | None:
    """Command of a COMMAND_LONG, or None when a parameter is infinite, a required one NaN.

    Or the location not on Earth, or too high.
    """
    clean = _clean(tuple(getattr(fields, f"param{n}") for n in range(1, 8)), entry)
    if clean is None:
        return None
    p1, p2, p3, p4, p5, p6, p7 = clean
    lat = lon = 0
    if entry.has_location:
        if abs(p7) > HIGHEST_M or (not entry.off_earth and not (abs(p5) <= 90.0 and abs(p6) <= 180.0)):
            return None
        lat, lon = round(p5 * 1e7), round(p6 * 1e7)
    return Command(fields.command, p1, p2, p3, p4, lat, lon, p7, entry.long_frame, p5, p6)


def is_on_earth(lat: int, lon: int) -> bool:
    """Whether there is such a latitude and longitude [degE7]."""
    return abs(lat) <= 900_000_000 and abs(lon) <= 1_800_000_000


def from_int(fields: Any, entry: Entry) -> Command | None:
    """Command of a COMMAND_INT, or None as for ``from_long``."""
    values = (
        fields.param1,
        fields.param2,
        fields.param3,
        fields.param4,
        float(fields.x),
        float(fields.y),
        fields.z,
    )
    clean = _clean(values, entry)
    if clean is None:
        return None
    p1, p2, p3, p4, p5, p6, p7 = clean
    if entry.has_location and (abs(p7) > HIGHEST_M or (not entry.off_earth and not is_on_earth(fields.x, fields.y))):
        return None
    return Command(fields.command, p1, p2, p3, p4, fields.x, fields.y, p7, fields.frame, p5, p6)


def _clean(values: tuple[float, ...], entry: Entry) -> list[float] | None:
    if any(math.isinf(x) for x in values) or any(math.isnan(values[k - 1]) for k in entry.required):
        return None
    return [0.0 if math.isnan(x) and not entry.takes_nan else x for x in values]
