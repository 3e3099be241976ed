# SPDX-License-Identifier: BSD-3-Clause
"""Parameters that are read outside the core, and what they do."""

from __future__ import annotations

from . import camera, payload, relays
from .params.table import Values

MISSION_OPTIONS, CLEARED_AT_BOOT = "MIS_OPTIONS", 1

MODE_BLOCK, NEED_LOCATION = "FLTMODE_GCSBLOCK", "ARMING_NEED_LOC"
MAV_OPTIONS, ONLY_GROUND_STATIONS = "MAV_OPTIONS", 1
GCS_SYSID_HI = "MAV_GCS_SYSID_HI"
LOG_ROTATES = "LOG_FILE_DSRMROT"

MEANINGS = {
    MAV_OPTIONS: "Bits: 1 the vehicle hears its ground stations (MAV_GCS_SYSID), itself and radios only",
    GCS_SYSID_HI: "Systems from MAV_GCS_SYSID to this one are ground stations: their sticks and heartbeats count",
    NEED_LOCATION: "1: no arming without a position, whatever the mode",
    "ARMING_MIS_ITEMS": "Bits of commands that the mission must have: 1 LAND, 4 DO_LAND_START, 8 TAKEOFF, 64 RTL",
    "ARMING_MAGTHRESH": "Greatest difference of the first compass from the earth's field, for arming [mGauss]; 0: any",
    MODE_BLOCK: "Bits of modes that ground stations may not choose; switches and failsafes may",
    LOG_ROTATES: "1: the arming after a disarming begins another on-board log",
    MISSION_OPTIONS: "Bits: 1 a boot clears the mission",
    **relays.MEANINGS,
    **camera.MEANINGS,
    **payload.MEANINGS,
}
"""By name; those of outputs where the core has none of its own."""

FAILURES = "SYS_FAILURE_EN"
OWN = {FAILURES: "1: MAV_CMD_INJECT_FAILURE is carried out"}
"""Those that ArduPilot does not have; MAVSDK's failure plugin asks for this one of PX4."""


def clears_mission(values: Values) -> bool:
    """Whether a boot clears the mission."""
    return MISSION_OPTIONS in values.table and int(values[MISSION_OPTIONS]) & CLEARED_AT_BOOT != 0


def rotates_logs(values: Values) -> bool:
    """Whether a disarming ends the on-board log."""
    return LOG_ROTATES in values.table and values[LOG_ROTATES] != 0.0
