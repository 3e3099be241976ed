# SPDX-License-Identifier: BSD-3-Clause
"""Names of parameters in other versions of ArduPilot, and what they are here.

No file is converted (a real ArduPilot does not convert ``--defaults`` either): the user is notified of the name and the
value that mean the same. Older versions have SYSID_THISMAV and GPS_TYPE; in 4.7 as it was released speeds and lengths
are in metres, angles in degrees. Source: the parameter lists of 3.4 to 4.7, their release notes and what each version
takes over from the one before.
"""

from __future__ import annotations

import re
from collections.abc import Callable
from typing import NamedTuple

_STREAM = re.compile(r"SR(\d)_(\w+)")
_GPS = re.compile(r"GPS_(TYPE|DELAY_MS|RATE_MS|GNSS_MODE|COM_PORT)(2?)")
_LOOP = re.compile(r"PSC_(NE|D)_(POS|VEL|ACC)_(\w+)")
_AXES = {"NE": "XY", "D": "Z"}
_CENTI, _DECI, _MILLI = 100.0, 10.0, 1000.0
_DEG_A_P = 45.0
"""A stick's whole way, which 4.1 and older give as a factor of 45 degrees."""
_LOOP_FACTORS = {"VEL_IMAX": _CENTI, "ACC_P": _DECI, "ACC_I": _DECI, "ACC_IMAX": _MILLI}

RENAMED: dict[str, tuple[str, float]] = {
    "SYSID_THISMAV": ("MAV_SYSID", 1.0),
    "SYSID_MYGCS": ("MAV_GCS_SYSID", 1.0),
    "TELEM_DELAY": ("MAV_TELEM_DELAY", 1.0),
    "ACRO_RP_P": ("ACRO_RP_RATE", _DEG_A_P),
    "ACRO_YAW_P": ("ACRO_Y_RATE", _DEG_A_P),
    "EK3_FLOW_MAX": ("EK3_MAX_FLOW", 1.0),
    "PSC_JERK_NE": ("PSC_JERK_XY", 1.0),
    "PSC_JERK_D": ("PSC_JERK_Z", 1.0),
    "PHLD_BRK_RATE": ("PHLD_BRAKE_RATE", 1.0),
    "PHLD_BRK_ANGLE": ("PHLD_BRAKE_ANGLE", _CENTI),
    "WP_ACC_CNR": ("WPNAV_ACCEL_C", 1.0),
    "WP_JERK": ("WPNAV_JERK", 1.0),
    "WP_RFND_USE": ("WPNAV_RFND_USE", 1.0),
    "WP_TER_MARGIN": ("WPNAV_TER_MARGIN", 1.0),
    "WP_ACC": ("WPNAV_ACCEL", _CENTI),
    "WP_ACC_Z": ("WPNAV_ACCEL_Z", _CENTI),
    "WP_RADIUS_M": ("WPNAV_RADIUS", _CENTI),
    "WP_SPD": ("WPNAV_SPEED", _CENTI),
    "WP_SPD_DN": ("WPNAV_SPEED_DN", _CENTI),
    "WP_SPD_UP": ("WPNAV_SPEED_UP", _CENTI),
    "ATC_ANGLE_MAX": ("ANGLE_MAX", _CENTI),
    "ATC_ACC_P_MAX": ("ATC_ACCEL_P_MAX", _CENTI),
    "ATC_ACC_R_MAX": ("ATC_ACCEL_R_MAX", _CENTI),
    "ATC_ACC_Y_MAX": ("ATC_ACCEL_Y_MAX", _CENTI),
    "ATC_RATE_WPY_MAX": ("ATC_SLEW_YAW", _CENTI),
    "CIRCLE_RADIUS_M": ("CIRCLE_RADIUS", _CENTI),
    "LAND_ALT_LOW_M": ("LAND_ALT_LOW", _CENTI),
    "LAND_SPD_MS": ("LAND_SPEED", _CENTI),
    "LAND_SPD_HIGH_MS": ("LAND_SPEED_HIGH", _CENTI),
    "LOIT_SPEED_MS": ("LOIT_SPEED", _CENTI),
    "LOIT_ACC_MAX_M": ("LOIT_ACC_MAX", _CENTI),
    "LOIT_BRK_ACC_M": ("LOIT_BRK_ACCEL", _CENTI),
    "LOIT_BRK_JRK_M": ("LOIT_BRK_JERK", _CENTI),
    "PILOT_ACC_Z": ("PILOT_ACCEL_Z", _CENTI),
    "PILOT_SPD_DN": ("PILOT_SPEED_DN", _CENTI),
    "PILOT_SPD_UP": ("PILOT_SPEED_UP", _CENTI),
    "PILOT_TKO_ALT_M": ("PILOT_TKOFF_ALT", _CENTI),
    "RTL_ALT_M": ("RTL_ALT", _CENTI),
    "RTL_ALT_FINAL_M": ("RTL_ALT_FINAL", _CENTI),
    "RTL_CLIMB_MIN_M": ("RTL_CLIMB_MIN", _CENTI),
    "RTL_SPEED_MS": ("RTL_SPEED", _CENTI),
    # of 3.4 to 3.6
    "ACCEL_Z_P": ("PSC_ACCZ_P", 1.0),
    "ACCEL_Z_I": ("PSC_ACCZ_I", 1.0),
    "ACCEL_Z_D": ("PSC_ACCZ_D", 1.0),
    "ACCEL_Z_IMAX": ("PSC_ACCZ_IMAX", 1.0),
    "ACCEL_Z_FILT": ("PSC_ACCZ_FLTE", 1.0),
    "PSC_ACCZ_FILT": ("PSC_ACCZ_FLTE", 1.0),
    "ATC_RAT_RLL_FILT": ("ATC_RAT_RLL_FLTD", 1.0),
    "ATC_RAT_PIT_FILT": ("ATC_RAT_PIT_FLTD", 1.0),
    "ATC_RAT_YAW_FILT": ("ATC_RAT_YAW_FLTE", 1.0),
    "FS_BATT_ENABLE": ("BATT_FS_LOW_ACT", 1.0),
    "FS_BATT_MAH": ("BATT_LOW_MAH", 1.0),
    "FS_BATT_VOLTAGE": ("BATT_LOW_VOLT", 1.0),
    "PILOT_VELZ_MAX": ("PILOT_SPEED_UP", 1.0),
    "POS_XY_P": ("PSC_POSXY_P", 1.0),
    "POS_Z_P": ("PSC_POSZ_P", 1.0),
    "VEL_XY_I": ("PSC_VELXY_I", 1.0),
    "VEL_XY_P": ("PSC_VELXY_P", 1.0),
    "VEL_Z_P": ("PSC_VELZ_P", 1.0),
    "WPNAV_LOIT_SPEED": ("LOIT_SPEED", 1.0),
}
"""Name elsewhere -> name here, and the factor from the value elsewhere to the one here."""


ALL_CHECKS = (1 << 21) - 2
"""Bits of ARMING_SKIPCHK."""


_DEVELOPMENT = ("EK3_FLOW_MAX", "PSC_JERK_NE", "PSC_JERK_D")
"""Names of the development version; those of the position controller's loops besides."""


class Alias(NamedTuple):
    """A name of ArduPilot's development version by which clients may read and set a parameter; lists do not have it."""

    name: str
    """Here."""
    to_here: Callable[[float], float]
    from_here: Callable[[float], float]


def _checks(skipped: float) -> float:
    """ARMING_CHECK that skips the checks of ARMING_SKIPCHK."""
    left = ALL_CHECKS & ~int(skipped)
    return 1.0 if left == ALL_CHECKS else float(left)


def _skipped(checks: float) -> float:
    """ARMING_SKIPCHK that leaves the checks of ARMING_CHECK."""
    if int(checks) & 1:
        return 0.0
    return float(ALL_CHECKS & ~int(checks)) if int(checks) & ALL_CHECKS else -1.0


def alias(name: str) -> Alias | None:
    """What ArduPilot's development version calls ``name``; None: nothing, or it is called so here, too."""
    if name == "ARMING_SKIPCHK":
        return Alias("ARMING_CHECK", _checks, _skipped)
    found = here(name) if name in _DEVELOPMENT or _LOOP.fullmatch(name) else None
    if found is None:
        return None
    own, factor = found
    return Alias(own, lambda value: value * factor, lambda value: value / factor)


def here(name: str) -> tuple[str, float] | None:
    """Name and factor of a parameter that other versions call ``name``; None: none is known."""
    if found := RENAMED.get(name):
        return found
    if stream := _STREAM.fullmatch(name):
        return f"MAV{int(stream[1]) + 1}_{stream[2]}", 1.0
    if gps := _GPS.fullmatch(name):
        return f"GPS{gps[2] or 1}_{gps[1]}", 1.0
    if loop := _LOOP.fullmatch(name):
        axes, law, part = loop.groups()
        return f"PSC_{law}{_AXES[axes]}_{part}", _LOOP_FACTORS.get(f"{law}_{part}", 1.0)
    return None
