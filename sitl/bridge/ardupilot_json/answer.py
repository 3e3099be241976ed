# SPDX-License-Identifier: BSD-3-Clause
"""The line of JSON that physics answers with: how the body moves.

ArduPilot looks for keys by their text from the front, and wants ``"key":value`` without a space between; so lines are
written without spaces and no key is part of one that comes before it. A line begins and ends with a line feed.
"""

from __future__ import annotations

import json
import math
from dataclasses import dataclass
from typing import Any

from ...core.algebra import quat_from_euler
from ...core.sums import lengths
from ...core.vectors import Euler
from ...errors import SitlError

_LIMITS = {"gyro": 1e3, "accel_body": 1e5, "position": 1e7, "velocity": 1e4}
"""Beyond these a number is no motion of a vehicle [rad/s, m/s^2, m, m/s]."""
_LATEST = 1e9
_KINDS = {float, int}
_RANGE = b"rng_"
RANGES = tuple(f"rng_{k}" for k in range(1, 7))


class MotionError(SitlError, ValueError):
    """A line that reports no motion; the message says what is wrong with it."""


@dataclass(frozen=True, slots=True)
class Motion:
    """What a line reports. NED from the vehicle's home, body axes forward, right, down."""

    time: float
    """Of the physics [s]."""
    gyro: tuple[float, ...]
    """Body rates [rad/s]."""
    accel: tuple[float, ...]
    """Specific force [m/s^2]: (0, 0, -9.81) at rest."""
    position: tuple[float, ...]
    """[m]"""
    velocity: tuple[float, ...]
    """[m/s]"""
    attitude: tuple[float, ...]
    """Quaternion, body to NED, w x y z, of length 1."""
    ranges: tuple[float | None, ...] = ()
    """Of the range-finders 1 .. 6 [m]; None: not reported."""
    battery: tuple[float, float] | None = None
    """Voltage [V], current [A]."""
    receiver: tuple[int, ...] = ()
    """Pulses of a radio receiver's channels [us]."""


def decode(line: bytes) -> Motion:
    """What a line reports.

    Raises:
        MotionError: it is no JSON, a field that must be there is not, or a number is not finite or absurd.
    """
    try:
        fields = json.loads(line, parse_constant=_refuse)
    except (ValueError, RecursionError) as error:
        raise MotionError(f"no JSON: {str(error)[:80]}") from None
    if not isinstance(fields, dict):
        raise MotionError("no JSON object")
    imu = fields.get("imu")
    if not isinstance(imu, dict):
        raise MotionError("field imu is missing")
    time = _number(fields.get("timestamp"), "timestamp", _LATEST)
    if time < 0.0:
        raise MotionError(f"timestamp {time!r} is negative")
    battery = fields.get("battery")
    return Motion(
        time,
        _vector(imu, "gyro"),
        _vector(imu, "accel_body"),
        _vector(fields, "position"),
        _vector(fields, "velocity"),
        _attitude(fields),
        _ranges(fields) if _RANGE in line else (),
        None if not isinstance(battery, dict) else _battery(battery),
        _receiver(fields.get("rc")),
    )


def _refuse(name: str) -> Any:
    raise ValueError(f"{name} is not a number of JSON")


def _number(value: Any, name: str, limit: float) -> float:
    if value is None:
        raise MotionError(f"field {name} is missing")
    if isinstance(value, bool) or not isinstance(value, int | float):
        raise MotionError(f"{name} {value!r} is not a number")
    if not abs(value) <= limit or not math.isfinite(value):
        raise MotionError(f"{name} {value!r} is out of all bounds")
    return float(value)


def _vector(fields: dict[str, Any], name: str, length: int = 3, limit: float | None = None) -> tuple[float, ...]:
    values, bound = fields.get(name), limit or _LIMITS[name]
    if values is None:
        raise MotionError(f"field {name} is missing")
    if not isinstance(values, list) or len(values) != length:
        raise MotionError(f"{name} {values!r} is not {length} numbers")
    if _KINDS.issuperset(map(type, values)) and -bound <= min(values) and max(values) <= bound:  # NaN is no JSON
        return tuple(map(float, values))
    return tuple(_number(value, name, limit or _LIMITS[name]) for value in values)


def _attitude(fields: dict[str, Any]) -> tuple[float, ...]:
    """The quaternion, which counts if both are told, or the one of the Euler angles [rad]."""
    if "quaternion" in fields:
        q = _vector(fields, "quaternion", 4, 2.0)
        length = float(lengths(q))
        if not 0.5 <= length <= 2.0:
            raise MotionError(f"quaternion {list(q)} has length {length:.3g}, not 1")
        return q if abs(length - 1.0) < 1e-12 else tuple(part / length for part in q)
    if "attitude" in fields:
        roll, pitch, yaw = _vector(fields, "attitude", 3, 1e3)
        return tuple(float(part) for part in quat_from_euler(Euler(roll, pitch, yaw)))
    raise MotionError("neither quaternion nor attitude is there")


def _ranges(fields: dict[str, Any]) -> tuple[float | None, ...]:
    return tuple(_number(fields[key], key, math.inf) if key in fields else None for key in RANGES)


def _battery(fields: dict[str, Any]) -> tuple[float, float]:
    return _number(fields.get("voltage"), "voltage", 1e4), _number(fields.get("current"), "current", 1e5)


def _receiver(fields: Any) -> tuple[int, ...]:
    if not isinstance(fields, dict):
        return ()
    pulses: list[int] = []
    while f"rc_{len(pulses) + 1}" in fields and len(pulses) < 16:
        name = f"rc_{len(pulses) + 1}"
        pulses.append(round(_number(fields[name], name, 65535.0)))
    return tuple(pulses)
