# SPDX-License-Identifier: BSD-3-Clause
"""Numbers and names of the flight modes, and why a mode changed or did not.

Numbers: ArduCopter's custom modes (https://ardupilot.org/copter/docs/flight-modes.html, COPTER_MODE of
MAVLink).
"""

from __future__ import annotations

from ....core.kernels import law

STABILIZE = 0
ALT_HOLD = 2
AUTO = 3
GUIDED = 4
LOITER = 5
RTL = 6
LAND = 9
BRAKE = 17

NAMES = {
    STABILIZE: "STABILIZE",
    ALT_HOLD: "ALT_HOLD",
    AUTO: "AUTO",
    GUIDED: "GUIDED",
    LOITER: "LOITER",
    RTL: "RTL",
    LAND: "LAND",
    BRAKE: "BRAKE",
}

# Why a mode changed (ArduPilot's ModeReason, the number that its logs carry)
REASON_RC = 1
REASON_GCS = 2
REASON_RADIO_FAILSAFE = 3
REASON_BATTERY_FAILSAFE = 4
REASON_GCS_FAILSAFE = 5
REASON_EKF_FAILSAFE = 6
REASON_THROTTLE_LAND_ESCAPE = 9
REASON_INITIALISED = 26

# Why it did not
ACCEPTED = 0
NO_SUCH_MODE = 1
INIT_FAILED = 2
REQUIRES_POSITION = 3
THROTTLE_TOO_HIGH = 4
NEEDS_ALTITUDE = 5
MISSING_TAKEOFF = 6

_CAUSES = {
    INIT_FAILED: "init failed",
    REQUIRES_POSITION: "requires position",
    THROTTLE_TOO_HIGH: "throttle too high",
    NEEDS_ALTITUDE: "need alt estimate",
    MISSING_TAKEOFF: "init failed",
}


@law
def is_known(number):
    """Whether the firmware has this mode."""
    return number in (STABILIZE, ALT_HOLD, AUTO, GUIDED, LOITER, RTL, LAND, BRAKE)


@law
def has_manual_throttle(number):
    """Whether the throttle stick drives the motors directly."""
    return number == STABILIZE


@law
def requires_position(number):
    """Whether the mode needs a horizontal position (LAND does without)."""
    return number in (AUTO, GUIDED, LOITER, RTL, BRAKE)


@law
def is_autopilot(number):
    """Whether the mode flies without the pilot's sticks."""
    return number in (AUTO, GUIDED, RTL, LAND, BRAKE)


def refusal_texts(number: int, cause: int) -> list[str]:
    """Status texts (MAV_SEVERITY_WARNING) of a refused mode change; empty when it was accepted."""
    if cause == ACCEPTED:
        return []
    if cause == NO_SUCH_MODE:
        return [f"No such mode {number}"]
    texts = ["Auto: Missing Takeoff Cmd"] if cause == MISSING_TAKEOFF else []
    return [*texts, f"Mode change to {NAMES[number]} failed: {_CAUSES[cause]}"]
