# SPDX-License-Identifier: BSD-3-Clause
"""Parameters that are read outside the core, and what they do."""

from __future__ import annotations

from . import camera, payload, relays
from .params.table import Values

MISSION_OPTIONS, CLEARED_AT_BOOT = "MIS_OPTIONS", 1

MODE_BLOCK = "FLTMODE_GCSBLOCK"

MEANINGS = {
    MODE_BLOCK: "Bits of modes that ground stations may not choose; switches and failsafes may",
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
