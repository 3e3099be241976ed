# SPDX-License-Identifier: BSD-3-Clause
"""What PX4 does otherwise than ArduPilot on MAVLink: modes, whole-number parameters, missions without home.

Sources: PX4's px4_custom_mode.h; https://mavlink.io/en/services/parameter.html (encoding);
https://mavlink.io/en/services/mission.html (only ArduPilot has home as item 0).
"""

from __future__ import annotations

import struct
from collections.abc import Mapping, Sequence
from typing import Any

from ..autopilot.mission.item import MissionItem
from ..core.mavlink import MavCmd, MavFrame, MavParamType
from ..errors import OptionError

_AUTO = 4
_MAIN = {1: "MANUAL", 2: "ALTCTL", 3: "POSCTL", 5: "ACRO", 6: "OFFBOARD", 7: "STABILIZED"}
_SUB = {2: "TAKEOFF", 3: "LOITER", 4: "MISSION", 5: "RTL", 6: "LAND", 8: "FOLLOWME", 9: "PRECLAND"}
MODE_NAMES: Mapping[int, str] = {
    **{main << 16: name for main, name in _MAIN.items()},
    **{_AUTO << 16 | sub << 24: name for sub, name in _SUB.items()},
}
"""custom_mode of HEARTBEAT -> name, as pymavlink has them."""
VALID = 1 | 2 | 4 | 16 | 32
"""ESTIMATOR_STATUS_FLAGS: attitude, velocity, position on the earth, height. Before, PX4 reports a position, too, and a
heading that knows no declination, or none at all."""
READY, MISSION, OFFBOARD = "LOITER", "MISSION", "OFFBOARD"
"""Modes: in which it arms and goes where it is sent; of missions; of velocities that are sent."""
MISSION_ENDS = (MISSION, READY, "RTL", "LAND")
"""Modes in which a mission that was flown ends: an item that returns or lands changes the mode."""
REPEAT_US = 200_000
"""Between two set-points: it leaves OFFBOARD when they come less than twice a second."""
_LOCATED = (MavCmd.NAV_TAKEOFF, MavCmd.NAV_LAND, MavCmd.NAV_WAYPOINT)
"""Commands whose items PX4 takes with a place only."""


def mode_parameters(number: int) -> tuple[int, int]:
    """Main mode and sub mode, the second and third parameter of DO_SET_MODE."""
    return number >> 16 & 0xFF, number >> 24


def value_of(fields: Any) -> float:
    """Of a PARAM_VALUE: the bytes of a whole number are in the place of the float's."""
    if fields.param_type == MavParamType.INT32:
        return float(struct.unpack("<i", struct.pack("<f", fields.param_value))[0])
    return float(fields.param_value)


def encoded(name: str, value: float, param_type: int) -> float:
    """A value for PARAM_SET of this type.

    Raises:
        OptionError: a whole number is needed.
    """
    if param_type != MavParamType.INT32:
        return value
    if value != int(value) or not -(1 << 31) <= value < 1 << 31:
        raise OptionError(f"{name} = {value:g}; PX4 has a whole number there")
    return float(struct.unpack("<f", struct.pack("<i", int(value)))[0])


def mission(items: Sequence[MissionItem]) -> list[MissionItem]:
    """A mission with home first as PX4 takes it: without home; each position is given; what needs none has no frame."""
    made: list[MissionItem] = []
    x, y = (items[0].x, items[0].y) if items else (0, 0)
    for item in items[1:]:
        if item.command in _LOCATED and item.no_location:
            item = item._replace(x=x, y=y)
        elif item.command == MavCmd.NAV_RETURN_TO_LAUNCH:
            item = item._replace(frame=MavFrame.MISSION)
        if not item.no_location:
            x, y = item.x, item.y
        made.append(item)
    return made
