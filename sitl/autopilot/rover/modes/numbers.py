# SPDX-License-Identifier: BSD-3-Clause
"""Numbers and names of the rover's modes, what each needs, and why a mode changed or did not.

Numbers: ArduRover's custom modes (https://ardupilot.org/rover/docs/rover-control-modes.html, ROVER_MODE of MAVLink).
"""

from __future__ import annotations

from ....core.kernels import law

MANUAL = 0
ACRO = 1
STEERING = 3
HOLD = 4
LOITER = 5
SIMPLE = 7
CIRCLE = 9
AUTO = 10
RTL = 11
SMART_RTL = 12
GUIDED = 15
INITIALISING = 16

NAMES = {
    MANUAL: "MANUAL",
    ACRO: "ACRO",
    STEERING: "STEERING",
    HOLD: "HOLD",
    LOITER: "LOITER",
    SIMPLE: "SIMPLE",
    CIRCLE: "CIRCLE",
    AUTO: "AUTO",
    RTL: "RTL",
    SMART_RTL: "SMART_RTL",
    GUIDED: "GUIDED",
    INITIALISING: "INITIALISING",
}

# Why a mode changed (ArduPilot's ModeReason, the number that its logs carry)
REASON_RC = 1
REASON_GCS = 2
REASON_BATTERY_FAILSAFE = 4
REASON_EKF_FAILSAFE = 6
REASON_MISSION_END = 8
REASON_CRASH_FAILSAFE = 19
REASON_FAILSAFE = 25
REASON_INITIALISED = 26

# Why it did not
ACCEPTED = 0
NO_SUCH_MODE = 1
INIT_FAILED = 2
REQUIRES_POSITION = 3
NO_MISSION = 4


@law
def is_known(number):
    """Whether the firmware has this mode."""
    if number in (MANUAL, ACRO, STEERING, HOLD, LOITER, SIMPLE):
        return True
    return number in (CIRCLE, AUTO, RTL, SMART_RTL, GUIDED, INITIALISING)


@law
def is_autopilot(number):
    """Whether the mode drives without the pilot's sticks."""
    return number in (LOITER, CIRCLE, AUTO, RTL, SMART_RTL, GUIDED)


@law
def requires_position(number):
    """Whether the mode needs a position."""
    return is_autopilot(number) or number in (SIMPLE, INITIALISING)


@law
def requires_velocity(number, skid):
    """Whether the mode needs a speed; ``skid``: a skid-steered vehicle turns without one."""
    return requires_position(number) or number == STEERING or (number == ACRO and not skid)


@law
def allows_arming(number):
    """Whether the vehicle may be armed in this mode."""
    return number != RTL and number != SMART_RTL and number != INITIALISING


@law
def allows_arming_by_stick(number):
    """Whether the steering stick arms and disarms in this mode."""
    return not is_autopilot(number)


@law
def has_manual_input(number):
    """Whether the pilot's sticks drive."""
    return number in (MANUAL, ACRO, STEERING, SIMPLE)


def refusal_texts(number: int, cause: int) -> list[str]:
    """Status texts (MAV_SEVERITY_WARNING) of a refused mode change; empty when it was accepted."""
    if cause == ACCEPTED:
        return []
    if cause == NO_SUCH_MODE:
        return [f"No such mode {number}"]
    first = ["No Mission. Can't set AUTO."] if cause == NO_MISSION else []
    return [*first, "Flight mode change failed"]
