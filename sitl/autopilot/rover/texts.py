# SPDX-License-Identifier: BSD-3-Clause
"""What the rover says of the core's events: ArduRover's status texts with their severities (shell side)."""

from __future__ import annotations

from .. import events, smart_rtl_path
from ..failsafe_checks import EKF, VARIANCE, battery_text
from ..modes import GCS_BLOCKED, NO_MISSION
from . import failsafe
from .modes import circle, dock
from .modes.set_mode import refusal_texts

EMERGENCY, CRITICAL, WARNING, NOTICE, INFO = 0, 2, 4, 5, 6
"""MAV_SEVERITY"""

_CIRCLE = {
    circle.SPEED_LIMITED: "Circle: max speed is {:4.1f}",
    circle.RADIUS_ENLARGED: "Circle: radius increased to TURN_RADIUS ({:4.1f})",
    circle.FELL_BEHIND: "Circle: cannot keep up, slowing to {:.1f}m/s",
}
_DOCK = {
    dock.NO_TARGET: (NOTICE, "Dock: target not acquired"),
    dock.NO_DIRECTION: (NOTICE, "Dock: Set DOCK_DIR or disable heading correction"),
    dock.ARRIVED: (INFO, "Dock: Docking complete"),
}
_PLAIN = {
    events.ARMED: (INFO, "Throttle armed"),
    events.DISARMED: (INFO, "Throttle disarmed"),
    events.GUIDED_TIMEOUT: (WARNING, "target not received last 3secs, stopping"),
    events.DESTINATION_REACHED: (INFO, "Reached destination"),
    events.PATH_LOW: (INFO, smart_rtl_path.LOW_TEXT),
    events.CRASH_HOLD: (EMERGENCY, "Crash: Going to HOLD"),
}


def texts(code: int, a: float, b: float) -> list[tuple[int, str]]:
    """(MAV_SEVERITY, text) of what is said of an event; empty for most."""
    if code in _PLAIN:
        return [_PLAIN[code]]
    if code == events.MODE_REFUSED:
        return _refusal(int(a), int(b))
    said_of_battery = battery_text(code, a, b)
    if said_of_battery is not None:
        return [(WARNING, said_of_battery)]
    if code == events.FAILSAFE:
        return _failsafe(int(a), bool(b))
    if code == events.PATH_LOST:
        return [(WARNING, smart_rtl_path.lost_text(int(a)))]
    if code == events.DOCK_DID:
        return [_DOCK[int(a)]]
    if code == events.CIRCLE_ADAPTED:
        return [(WARNING, _CIRCLE[int(a)].format(b))]
    return []


def _refusal(number: int, cause: int) -> list[tuple[int, str]]:
    said = refusal_texts(number, cause)
    if cause == GCS_BLOCKED:
        return [(NOTICE, text) for text in said]
    return [(NOTICE if cause == NO_MISSION and text is said[0] else WARNING, text) for text in said]


def _failsafe(which: int, on: bool) -> list[tuple[int, str]]:
    text = failsafe.text(which, on)
    if text is None:
        return []
    if which in (EKF, VARIANCE):
        return [(CRITICAL, text)]
    return [(WARNING if on else INFO, text)]
