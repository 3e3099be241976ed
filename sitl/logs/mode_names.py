# SPDX-License-Identifier: BSD-3-Clause
"""Names of ArduPilot's vehicles and modes by their numbers, for logs of anyone's.

https://mavlink.io/en/messages/ardupilotmega.html#COPTER_MODE and #ROVER_MODE
"""

from __future__ import annotations

KINDS = {2: "copter", 3: "copter", 4: "copter", 13: "copter", 14: "copter", 15: "copter", 29: "copter"} | {
    10: "rover", 11: "rover"
}  # fmt: skip
"""MAV_TYPE -> kind of vehicle."""

_COPTER = (
    "STABILIZE ACRO ALT_HOLD AUTO GUIDED LOITER RTL CIRCLE - LAND - DRIFT - SPORT FLIP AUTOTUNE POSHOLD BRAKE THROW "
    "AVOID_ADSB GUIDED_NOGPS SMART_RTL FLOWHOLD FOLLOW ZIGZAG SYSTEMID AUTOROTATE AUTO_RTL TURTLE"
)
_ROVER = "MANUAL ACRO - STEERING HOLD LOITER FOLLOW SIMPLE DOCK CIRCLE AUTO RTL SMART_RTL - - GUIDED INITIALISING"
_NAMES = {"copter": _COPTER.split(), "rover": _ROVER.split()}


def mode_name(kind: str, number: int) -> str:
    """Name of a mode as our firmwares have it; its number when it has none."""
    names = _NAMES[kind]
    # LAND is COPTER_MODE 9; 8, 10, 12 and rover's 2, 13, 14 are not in use
    return names[number] if 0 <= number < len(names) and names[number] != "-" else f"MODE {number}"
