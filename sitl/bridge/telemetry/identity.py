# SPDX-License-Identifier: BSD-3-Clause
"""Who this is and what time it has: AUTOPILOT_VERSION, TIMESYNC."""

from __future__ import annotations

from ..dialect import message
from .builder import Build, Builder, Context

MISSION_FLOAT, PARAM_FLOAT, MISSION_INT, COMMAND_INT, FTP = 0x1, 0x2, 0x4, 0x8, 0x20
SET_ATTITUDE, SET_LOCAL_POSITION, SET_GLOBAL_POSITION, TERMINATION, MAVLINK2 = (
    0x40,
    0x80,
    0x100,
    0x800,
    0x2000,
)
CAPABILITIES = MISSION_FLOAT | PARAM_FLOAT | MISSION_INT | COMMAND_INT | FTP
CAPABILITIES |= SET_ATTITUDE | SET_LOCAL_POSITION | SET_GLOBAL_POSITION | MAVLINK2
"""What every firmware can; ArduPilot's 0xF1EF without what does not exist here (compass calibration, fence, rally)."""

FLIGHT_VERSION = (4, 7, 0, 0)
"""Major, minor, patch, type (0: development).

The ArduPilot whose behaviour and parameter names this firmware follows.
"""


def autopilot_version(context: Context) -> Build:
    """AUTOPILOT_VERSION: capabilities and version."""
    major, minor, patch, kind = FLIGHT_VERSION
    version = major << 24 | minor << 16 | patch << 8 | kind
    payload = message("AUTOPILOT_VERSION").payload(
        capabilities=context.profile.capabilities,
        flight_sw_version=version,
        flight_custom_version=tuple(b"gym-sitl"),
        uid=1,
    )
    return lambda: payload


def timesync(context: Context) -> Build:
    """TIMESYNC: our request; ts1 is simulated time [ns]."""
    read, kind = context.fields("time_us"), message("TIMESYNC")
    rest = (0,) * (len(kind.fields) - 2)
    return lambda: kind.pack(0, read()[0] * 1000 + 1, *rest)


BUILDERS: dict[str, Builder] = {"AUTOPILOT_VERSION": autopilot_version, "TIMESYNC": timesync}
