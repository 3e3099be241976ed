# SPDX-License-Identifier: BSD-3-Clause
"""Changing the flight mode: who may enter what, when."""

from __future__ import annotations

from ....core.kernels import law
from ...events import MODE_CHANGED, MODE_REFUSED, emit, emit_and_return
from ...modes import (
    ACCEPTED,
    INIT_FAILED,
    MISSING_TAKEOFF,
    NEEDS_ALTITUDE,
    NO_SUCH_MODE,
    REQUIRES_POSITION,
    THROTTLE_TOO_HIGH,
)
from ..control.motors import hover_throttle
from ..state import Vehicle
from . import stabilize
from .auto import AUTO
from .table import NAMES, has_manual_throttle, is_known, requires_position, start

_CAUSES = {
    INIT_FAILED: "init failed",
    REQUIRES_POSITION: "requires position",
    THROTTLE_TOO_HIGH: "throttle too high",
    NEEDS_ALTITUDE: "need alt estimate",
    MISSING_TAKEOFF: "init failed",
}


@law
def refusal(v: Vehicle, number: int) -> int:
    """ACCEPTED, or why the mode cannot be entered, its own conditions aside. Disarmed any mode may be."""
    ap = v.autopilot
    if not is_known(number):
        return NO_SUCH_MODE
    if not ap.arming.armed:
        return ACCEPTED
    manual_now = has_manual_throttle(ap.modes.number)
    if ap.arming.landed and has_manual_throttle(number) and not manual_now:
        if stabilize.throttle(ap) > 0.5 * hover_throttle(ap.params.MOT):
            return THROTTLE_TOO_HIGH
    if requires_position(number) and not ap.estimate.position_ok:
        return REQUIRES_POSITION
    if manual_now and not has_manual_throttle(number) and not ap.estimate.attitude_ok:
        return NEEDS_ALTITUDE
    return ACCEPTED


@law
def request(v: Vehicle, number: int, reason: int) -> int:
    """Change to a mode. Returns ACCEPTED (0; also when already there) or the cause (``autopilot.modes``).

    A change is told to the shell as MODE_CHANGED (number, reason), a refusal as MODE_REFUSED (number,
    cause) with nothing changed.
    """
    ap = v.autopilot
    modes = ap.modes
    if number == modes.number:
        modes.reason = reason
        return ACCEPTED
    pending = modes.nav.request_pending
    cause = refusal(v, number)
    if cause == ACCEPTED:
        modes.nav.request_pending = 0  # legs that the old mode asked for must not move the new one
        cause = start(number, v)
    if cause != ACCEPTED:
        modes.nav.request_pending = pending
        emit(ap.events, v.time_us, MODE_REFUSED, float(number), float(cause))
        return cause
    modes.previous = modes.number
    modes.number = number
    modes.reason = reason
    modes.takeoff.user_active = False
    modes.wanted = 0
    if number == AUTO or modes.previous == AUTO:
        emit_and_return(ap.events, v.time_us, MODE_CHANGED, float(number), float(reason))
    else:
        emit(ap.events, v.time_us, MODE_CHANGED, float(number), float(reason))
    return cause


def refusal_texts(number: int, cause: int) -> list[str]:
    """Status texts (MAV_SEVERITY_WARNING) of a refused mode change; empty when it was accepted."""
    if cause == ACCEPTED:
        return []
    if cause == NO_SUCH_MODE:
        return [f"No such mode {number}"]
    texts = ["Auto: Missing Takeoff Cmd"] if cause == MISSING_TAKEOFF else []
    return [*texts, f"Mode change to {NAMES[number]} failed: {_CAUSES[cause]}"]
