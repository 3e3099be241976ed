# SPDX-License-Identifier: BSD-3-Clause
"""Numbers to integers for the wire: saturated, and never an exception (NaN gives the lower limit)."""

from __future__ import annotations

import math

from ...core.kernels import law
from ...core.vectors import Vec3

DEG = 180.0 / math.pi
CDEG = 18000.0 / math.pi
"""Radians to centidegrees."""


@law
def int16(x: float) -> int:
    """Truncated and limited to -32768 .. 32767."""
    if -32768.0 < x < 32767.0:
        return int(x)
    return 32767 if x >= 32767.0 else -32768


@law
def int16s(v: Vec3) -> Vec3:
    """Each component as ``int16`` has it."""
    return Vec3(int16(v.x), int16(v.y), int16(v.z))


@law
def uint8(x: float) -> int:
    """Truncated and limited to 0 .. 255."""
    return int(min(max(x, 0.0), 255.0))


@law
def uint16(x: float) -> int:
    """Truncated and limited to 0 .. 65535."""
    if 0.0 <= x < 65535.0:
        return int(x)
    return 65535 if x >= 65535.0 else 0


@law
def int32(x: float) -> int:
    """Rounded to the nearest and limited to 32 bits."""
    if -2147483648.0 < x < 2147483647.0:
        return math.floor(x + 0.5)
    return 2147483647 if x >= 2147483647.0 else -2147483648


@law
def percent(x: float) -> int:
    """Truncated to 0 .. 100; -1 ("unknown") for what is below 0 or not a number."""
    if x >= 100.0:
        return 100
    return int(x) if x >= 0.0 else -1


@law
def heading_cdeg(yaw: float) -> int:
    """Angle [rad] as 0 .. 35999 centidegrees; 0 for what is not a number."""
    c = yaw * CDEG
    return int(c % 36000.0) % 36000 if -1e9 < c < 1e9 else 0


@law
def boot_ms(time_us: int) -> int:
    """Milliseconds since boot as MAVLink's uint32."""
    return time_us // 1000 & 0xFFFFFFFF
