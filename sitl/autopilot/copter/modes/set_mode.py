# SPDX-License-Identifier: BSD-3-Clause
"""Changing the flight mode: who may enter what, when."""

from __future__ import annotations

from ....core.kernels import law
from ... import modes as all_modes
from ...events import MODE_REFUSED, emit
from ...fence.checks import begin_recovery, keeps_mode
from ...modes import (
    ACCEPTED,
    IN_FENCE_RECOVERY,
    INIT_FAILED,
    MISSING_TAKEOFF,
    NEEDS_ALTITUDE,
    NO_SUCH_MODE,
    REQUIRES_POSITION,
    THROTTLE_TOO_HIGH,
    enter,
)
from ...state import Arming, Estimate
from ..control.motors import hover_throttle
from ..parameters import Parameters
from ..state import Vehicle
from . import stabilize
from .auto import AUTO
from .state import Modes
from .table import NAMES, has_manual_throttle, is_known, requires_position, start

_CAUSES = {
    INIT_FAILED: "init failed",
    REQUIRES_POSITION: "requires position",
    THROTTLE_TOO_HIGH: "throttle too high",
    NEEDS_ALTITUDE: "need alt estimate",
    MISSING_TAKEOFF: "init failed",
    IN_FENCE_RECOVERY: "in fence recovery",
}


@law
def refusal(number: int, modes: Modes, arming: Arming, estimate: Estimate, p: Parameters) -> int:
    """ACCEPTED, or why the mode cannot be entered, its own conditions aside. Disarmed any mode may be."""
    if not is_known(number):
        return NO_SUCH_MODE
    if not arming.armed:
        return ACCEPTED
    manual_now = has_manual_throttle(modes.number)
    if arming.landed and has_manual_throttle(number) and not manual_now:
        if stabilize.throttle(modes.pilot, p) > 0.5 * hover_throttle(p.MOT):
            return THROTTLE_TOO_HIGH
    if requires_position(number) and not estimate.position_ok:
        return REQUIRES_POSITION
    if manual_now and not has_manual_throttle(number) and not estimate.attitude_ok:
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
    cause = refusal(number, modes, ap.arming, ap.estimate, ap.params)
    if ap.arming.armed and not ap.arming.landed and keeps_mode(ap.fence, modes.reason, ap.params.FENCE):
        cause = IN_FENCE_RECOVERY
    if cause == ACCEPTED:
        modes.nav.request_pending = 0  # legs that the old mode asked for must not move the new one
        cause = start(number, v)
    if cause != ACCEPTED:
        modes.nav.request_pending = pending
        emit(ap.events, v.time_us, MODE_REFUSED, float(number), float(cause))
        return cause
    modes.takeoff.user_active = False
    begin_recovery(ap.fence, ap.params.FENCE, ap.events, v.time_us)
    enter(modes, ap.events, v.time_us, number, reason, AUTO)
    return cause


def refusal_texts(number: int, cause: int) -> list[str]:
    """Status texts (MAV_SEVERITY_WARNING) of a refused mode change; empty when it was accepted."""
    failed = f"Mode change to {NAMES.get(number)} failed: {_CAUSES.get(cause)}"
    return all_modes.refusal_texts(number, cause, failed)
