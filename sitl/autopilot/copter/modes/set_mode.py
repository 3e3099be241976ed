# SPDX-License-Identifier: BSD-3-Clause
"""Changing the flight mode: who may enter what, when."""

from __future__ import annotations

from ....core.kernels import law
from ...events import MODE_CHANGED, MODE_REFUSED, emit, emit_and_return
from ..control.motors import hover_throttle
from . import alt_hold, auto, brake, guided_flight, land, loiter, rtl, stabilize
from .numbers import (
    ACCEPTED,
    ALT_HOLD,
    AUTO,
    GUIDED,
    INIT_FAILED,
    LAND,
    LOITER,
    NEEDS_ALTITUDE,
    NO_SUCH_MODE,
    REQUIRES_POSITION,
    RTL,
    STABILIZE,
    THROTTLE_TOO_HIGH,
    has_manual_throttle,
    is_known,
    requires_position,
)


@law
def refusal(v, number):
    """ACCEPTED, or why the mode cannot be entered, its own conditions aside. Disarmed any mode may be."""
    ap = v.autopilot
    if not is_known(number):
        return NO_SUCH_MODE
    if ap.arming.armed == 0:
        return ACCEPTED
    manual_now = has_manual_throttle(int(ap.modes.number))
    if ap.arming.landed != 0 and has_manual_throttle(number) and not manual_now:
        if stabilize.throttle(ap) > 0.5 * hover_throttle(ap.params.MOT):
            return THROTTLE_TOO_HIGH
    if requires_position(number) and ap.estimate.position_ok == 0:
        return REQUIRES_POSITION
    if manual_now and not has_manual_throttle(number) and not has_altitude(ap):
        return NEEDS_ALTITUDE
    return ACCEPTED


@law
def has_altitude(ap):
    """Whether the estimator has attitude and height."""
    return ap.estimate.attitude_ok != 0


@law
def enter(v, number):
    """Run the mode's own entry; ACCEPTED or a cause."""
    forced = 1 if v.autopilot.arming.armed == 0 else 0
    if number == STABILIZE:
        return stabilize.start(v)
    if number == ALT_HOLD:
        return alt_hold.start(v)
    if number == AUTO:
        return auto.enter(v, forced)
    if number == GUIDED:
        return guided_flight.start(v)
    if number == LOITER:
        return loiter.start(v)
    if number == RTL:
        return INIT_FAILED if rtl.start(v, forced) != 0 else ACCEPTED
    if number == LAND:
        return land.start(v)
    return brake.start(v)


@law
def request(v, number, reason):
    """Change to a mode. Returns ACCEPTED (0; also when already there) or the cause (``numbers``).

    A change is told to the shell as MODE_CHANGED (number, reason), a refusal as MODE_REFUSED (number,
    cause) with nothing changed.
    """
    ap = v.autopilot
    modes = ap.modes
    if number == modes.number:
        modes.reason = reason
        return ACCEPTED
    pending = int(modes.nav.request_pending)
    cause = refusal(v, number)
    if cause == ACCEPTED:
        modes.nav.request_pending = 0  # legs that the old mode asked for must not move the new one
        cause = enter(v, number)
    if cause != ACCEPTED:
        modes.nav.request_pending = pending
        emit(ap.events, v.time_us, MODE_REFUSED, float(number), float(cause))
        return cause
    modes.previous = int(modes.number)
    modes.number = number
    modes.reason = reason
    modes.takeoff.user_active = 0
    modes.wanted = 0
    if number == AUTO or modes.previous == AUTO:
        emit_and_return(ap.events, v.time_us, MODE_CHANGED, float(number), float(reason))
    else:
        emit(ap.events, v.time_us, MODE_CHANGED, float(number), float(reason))
    return cause
