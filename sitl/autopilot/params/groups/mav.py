# SPDX-License-Identifier: BSD-3-Clause
"""MAVLink: who the vehicle is, whom it takes for its pilot, and how much it sends unasked."""

from __future__ import annotations

from ..parameter import INT16, Parameter


def _rate(name: str, what: str) -> Parameter:
    return Parameter(
        f"MAV1_{name}",
        0.0,
        0.0,
        400.0,
        "Hz",
        f"Rate of {what} on every channel until a client asks otherwise",
        INT16,
    )


PARAMETERS = (
    Parameter("MAV_SYSID", 1.0, 1.0, 255.0, "", "System id of the vehicle", INT16),
    Parameter(
        "MAV_GCS_SYSID",
        255.0,
        1.0,
        255.0,
        "",
        "System id whose sticks and heartbeats count as the pilot's",
        INT16,
    ),
    _rate("RAW_SENS", "RAW_IMU, SCALED_PRESSURE"),
    _rate("EXT_STAT", "SYS_STATUS, POWER_STATUS, MEMINFO, MISSION_CURRENT, GPS_RAW_INT, NAV_CONTROLLER_OUTPUT"),
    _rate("RC_CHAN", "SERVO_OUTPUT_RAW, RC_CHANNELS"),
    _rate("RAW_CTRL", "RC_CHANNELS_SCALED (rovers only)"),
    _rate("POSITION", "GLOBAL_POSITION_INT, LOCAL_POSITION_NED"),
    _rate("EXTRA1", "ATTITUDE, SIMSTATE, AHRS2"),
    _rate("EXTRA2", "VFR_HUD"),
    _rate("EXTRA3", "AHRS, SYSTEM_TIME, BATTERY_STATUS, EKF_STATUS_REPORT"),
)
