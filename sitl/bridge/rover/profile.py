# SPDX-License-Identifier: BSD-3-Clause
"""The rover's face on MAVLink."""

from __future__ import annotations

from typing import Any

from ...autopilot.rover.modes.auto import AUTO
from ...autopilot.rover.modes.guided import GUIDED
from ...autopilot.rover.modes.mode_list import MODES, is_autonomous
from ...autopilot.rover.modes.rtl import RTL
from ...core.mavlink import MavType
from ..firmware_profile import GROUPS, Profile
from ..mavlink_firmware import Targets
from ..telemetry.shell import CAPABILITIES
from .autopilot import RoverAutopilot
from .core import UNITS
from .setpoints import RoverSetpoints
from .vehicle_commands import COMMANDS


def targets(v: Any) -> Targets:
    """The speed that it wants where it drives itself."""
    ap = v.autopilot
    return Targets(speed=abs(float(ap.control.speed.desired)) if is_autonomous(ap.modes.number) else 0.0)


PROFILE = Profile(
    firmware="ArduRover",
    mav_type=MavType.GROUND_ROVER,
    capabilities=CAPABILITIES,
    modes=MODES,
    auto=AUTO,
    guided=GUIDED,
    rtl=RTL,
    groups={
        **GROUPS,
        4: ("RAW_CTRL", ("RC_CHANNELS_SCALED",)),
        12: (
            "EXTRA3",
            ("AHRS", "DISTANCE_SENSOR", "RANGEFINDER", "OPTICAL_FLOW", "SYSTEM_TIME", "BATTERY_STATUS",
             "EKF_STATUS_REPORT", "VIBRATION",
             "WHEEL_DISTANCE", "GIMBAL_DEVICE_ATTITUDE_STATUS"),
        ),
    },
    commands=COMMANDS,
    set_points=RoverSetpoints,
    core=UNITS,
    autopilot=RoverAutopilot,
    silent=frozenset((83, 85, 136, 168, 11030, 11038)),
    targets=targets,
)  # fmt: skip
