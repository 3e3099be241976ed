# SPDX-License-Identifier: BSD-3-Clause
"""The rover's face on MAVLink."""

from __future__ import annotations

from ...autopilot.rover.modes.auto import AUTO
from ...autopilot.rover.modes.guided import GUIDED
from ...autopilot.rover.modes.rtl import RTL
from ...autopilot.rover.modes.table import MODES
from ...autopilot.rover.pilot import RECEIVER_TIMEOUT_S
from ..profile import Controllers, Profile
from ..services.rc import rc_channels_override
from ..telemetry.status import CAPABILITIES
from . import targets, telemetry
from .autopilot import RoverAutopilot
from .commands import COMMANDS
from .setpoints import RoverSetpoints, attitude_target, position_target_global, position_target_local
from .sticks import manual_control

PROFILE = Profile(
    firmware="ArduRover",
    mav_type=telemetry.GROUND_ROVER,
    capabilities=CAPABILITIES,
    modes=MODES,
    auto=AUTO,
    guided=GUIDED,
    rtl=RTL,
    groups={
        1: ("RAW_SENS", ("RAW_IMU", "SCALED_PRESSURE")),
        2: (
            "EXT_STAT",
            ("SYS_STATUS", "POWER_STATUS", "MEMINFO", "MISSION_CURRENT", "GPS_RAW_INT", "NAV_CONTROLLER_OUTPUT",
             "POSITION_TARGET_GLOBAL_INT"),
        ),
        3: ("RC_CHAN", ("SERVO_OUTPUT_RAW", "RC_CHANNELS")),
        4: ("RAW_CTRL", ("RC_CHANNELS_SCALED",)),
        6: ("POSITION", ("GLOBAL_POSITION_INT", "LOCAL_POSITION_NED")),
        10: ("EXTRA1", ("ATTITUDE", "SIMSTATE", "AHRS2")),
        11: ("EXTRA2", ("VFR_HUD",)),
        12: (
            "EXTRA3",
            ("AHRS", "DISTANCE_SENSOR", "SYSTEM_TIME", "BATTERY_STATUS", "EKF_STATUS_REPORT", "WHEEL_DISTANCE"),
        ),
    },
    commands=COMMANDS,
    set_points=RoverSetpoints,
    texts={},
    takes=(position_target_local, position_target_global, attitude_target, rc_channels_override, manual_control),
    receiver_timeout=RECEIVER_TIMEOUT_S,
    controllers=Controllers(telemetry.CONTROLLERS, telemetry.controllers_at_work, healthy_at_rest=False),
    builders={**telemetry.BUILDERS, **targets.BUILDERS},
    autopilot=RoverAutopilot,
)  # fmt: skip
