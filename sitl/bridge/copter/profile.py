# SPDX-License-Identifier: BSD-3-Clause
"""The copter's face on MAVLink."""

from __future__ import annotations

from ...autopilot import events, smart_rtl_path
from ...autopilot.copter.modes.auto import AUTO
from ...autopilot.copter.modes.guided import GUIDED
from ...autopilot.copter.modes.rtl import RTL
from ...autopilot.copter.modes.table import MODES
from ...vehicle.copter import QUADROTOR
from ..profile import Profile
from ..services.service import CRITICAL, EMERGENCY, INFO
from ..services.setpoints import SetpointService
from ..telemetry.shell import CAPABILITIES, TERMINATION
from .autopilot import CopterAutopilot
from .commands import COMMANDS
from .core import UNITS

PROFILE = Profile(
    firmware="ArduCopter",
    mav_type=QUADROTOR,
    capabilities=CAPABILITIES | TERMINATION,
    modes=MODES,
    auto=AUTO,
    guided=GUIDED,
    rtl=RTL,
    groups={
        1: ("RAW_SENS", ("RAW_IMU", "SCALED_PRESSURE")),
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
        12: (
            "EXTRA3",
            ("AHRS", "WIND", "DISTANCE_SENSOR", "RANGEFINDER", "OPTICAL_FLOW", "SYSTEM_TIME", "BATTERY_STATUS",
             "EKF_STATUS_REPORT", "VIBRATION", "TERRAIN_REPORT",
             "GIMBAL_DEVICE_ATTITUDE_STATUS"),
        ),
    },
    commands=COMMANDS,
    set_points=SetpointService,
    texts={
        events.ARMED: (INFO, "Arming motors"),
        events.DISARMED: (INFO, "Disarming motors"),
        events.HIT_GROUND: (INFO, "SIM Hit ground at {a:f} m/s"),
        events.PATH_LOW: (INFO, smart_rtl_path.LOW_TEXT),
        events.THRUST_LOST: (EMERGENCY, "Potential Thrust Loss ({a:.0f})"),
        events.CRASH_DISARM: (CRITICAL, "Crash: Disarming: AngErr={a:.0f}>30, Accel={b:.1f}<3.0"),
    },
    core=UNITS,
    autopilot=CopterAutopilot,
)  # fmt: skip
