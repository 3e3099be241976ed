# SPDX-License-Identifier: BSD-3-Clause
"""The copter's face on MAVLink."""

from __future__ import annotations

import math
from typing import Any

from ...autopilot.copter.control.altitude_start import is_active_d
from ...autopilot.copter.control.position_start import is_active_ne
from ...autopilot.copter.modes.auto import AUTO
from ...autopilot.copter.modes.guided import GUIDED
from ...autopilot.copter.modes.mode_list import MODES
from ...autopilot.copter.modes.rtl import RTL
from ...core.mavlink import MavType
from ..firmware_profile import GROUPS, Profile
from ..mavlink_firmware import Targets
from ..services.setpoint_messages import SetpointService
from ..telemetry.motion import global_position
from ..telemetry.shell import CAPABILITIES, TERMINATION, TERRAIN
from .autopilot import CopterAutopilot
from .core import UNITS
from .vehicle_commands import COMMANDS

_NO_WIND = 90
"""A wind from 180 deg [2 deg], as ArduCopter tells the one that it does not know."""


def targets(v: Any) -> Targets:
    """What the position controllers follow; without them, where it is."""
    control = v.autopilot.control
    ne, d = control.pos_ne.vel_target, control.pos_d
    altitude, climb, moves = global_position(v).alt, 0.0, (0.0, 0.0)
    if is_active_d(control):
        altitude, climb = altitude - d.pos_error, d.vel_target
    if is_active_ne(control):
        moves = (ne.x, ne.y)
    return Targets(altitude, math.sqrt(moves[0] * moves[0] + moves[1] * moves[1] + climb * climb), _NO_WIND)


PROFILE = Profile(
    firmware="ArduCopter",
    mav_type=MavType.QUADROTOR,
    capabilities=CAPABILITIES | TERMINATION | TERRAIN,
    modes=MODES,
    auto=AUTO,
    guided=GUIDED,
    rtl=RTL,
    groups={
        **GROUPS,
        12: (
            "EXTRA3",
            ("AHRS", "WIND", "DISTANCE_SENSOR", "RANGEFINDER", "OPTICAL_FLOW", "SYSTEM_TIME", "BATTERY_STATUS",
             "EKF_STATUS_REPORT", "VIBRATION", "TERRAIN_REPORT", "ESC_TELEMETRY_1_TO_4",
             "GIMBAL_DEVICE_ATTITUDE_STATUS"),
        ),
    },
    commands=COMMANDS,
    set_points=SetpointService,
    core=UNITS,
    autopilot=CopterAutopilot,
    targets=targets,
)  # fmt: skip
