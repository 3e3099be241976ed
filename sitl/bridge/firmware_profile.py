# SPDX-License-Identifier: BSD-3-Clause
"""All in which two firmwares differ on MAVLink.

``bridge/copter`` and ``bridge/rover`` each define one. Services and telemetry read the part of it that is data
(``mavlink_firmware.py``).
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from typing import Any

from ..vehicle.kinds import KINDS
from .autopilot_api import Autopilot
from .mavlink_firmware import MavlinkFirmware
from .services.command import Entry
from .services.setpoint_messages import SetpointService

GROUPS: Mapping[int, tuple[str, tuple[str, ...]]] = {
    1: ("RAW_SENS", ("RAW_IMU", "SCALED_IMU2", "SCALED_IMU3", "SCALED_PRESSURE", "SCALED_PRESSURE2")),
    2: (
        "EXT_STAT",
        ("SYS_STATUS", "POWER_STATUS", "MEMINFO", "MISSION_CURRENT", "GPS_RAW_INT", "GPS2_RAW",
         "NAV_CONTROLLER_OUTPUT", "FENCE_STATUS", "POSITION_TARGET_GLOBAL_INT"),
    ),
    3: ("RC_CHAN", ("SERVO_OUTPUT_RAW", "RC_CHANNELS")),
    4: ("RAW_CTRL", ()),
    6: ("POSITION", ("GLOBAL_POSITION_INT", "LOCAL_POSITION_NED")),
    10: ("EXTRA1", ("ATTITUDE", "SIMSTATE", "AHRS2", "PID_TUNING")),
    11: ("EXTRA2", ("VFR_HUD",)),
    12: ("EXTRA3", ()),
}  # fmt: skip
"""Stream groups as both firmwares have them; each says what it sends besides (``MavlinkFirmware.groups``)."""


@dataclass(frozen=True, kw_only=True)
class Profile(MavlinkFirmware):
    """A firmware's face."""

    commands: Mapping[int, Entry]
    """MAV_CMD -> how it is carried out. A number that is not here is answered UNSUPPORTED."""
    set_points: type[SetpointService]
    autopilot: Callable[[Any], Autopilot]
    """The firmware's laws behind the services."""


def load(kind: str) -> Profile:
    """The profile of a kind of vehicle by its name; its code is loaded with the first vehicle that has it.

    Raises:
        UnknownKindError, MissingPartError: no kind of this name, or it has no face on MAVLink.
    """
    return KINDS[kind].part("mavlink", Profile)
