# SPDX-License-Identifier: BSD-3-Clause
"""Changing the mode: who may enter what, when."""

from __future__ import annotations

from ....core.kernels import law
from ...events import MODE_CHANGED, MODE_REFUSED, emit, emit_and_return
from ..control.motors import is_skid
from ..navigation import waypoint
from . import auto, circle, guided_drive, loiter, rtl, smart_rtl
from .numbers import (
    ACCEPTED,
    AUTO,
    CIRCLE,
    GUIDED,
    LOITER,
    NO_SUCH_MODE,
    REQUIRES_POSITION,
    RTL,
    SMART_RTL,
    is_known,
    requires_position,
    requires_velocity,
)


@law
def refusal(v, number):
    """ACCEPTED, or why the mode cannot be entered, its own conditions aside. Disarmed any mode may be."""
    ap = v.autopilot
    if not is_known(number):
        return NO_SUCH_MODE
    if ap.arming.armed == 0:
        return ACCEPTED
    good = ap.estimate.position_ok != 0 and ap.modes.failsafe.ekf == 0
    if requires_position(number) and not good:
        return REQUIRES_POSITION
    if requires_velocity(number, is_skid(ap.params)) and not good and not ap.control.speed.forward_ok:
        return REQUIRES_POSITION
    return ACCEPTED


@law
def enter(v, number):
    """Run the mode's own entry; ACCEPTED or a cause."""
    if number == AUTO:
        return auto.start(v)
    if number == GUIDED:
        return guided_drive.start(v)
    if number == RTL:
        return rtl.start(v)
    if number == SMART_RTL:
        return smart_rtl.start(v)
    if number == LOITER:
        return loiter.start(v)
    if number == CIRCLE:
        return circle.start(v)
    return ACCEPTED


@law
def request(v, number, reason):
    """Change to a mode. Returns ACCEPTED (0; also when already there) or the cause (``numbers``).

    A change is told to the shell as MODE_CHANGED (number, reason), a refusal as MODE_REFUSED (number, cause) with
    nothing changed.
    """
    ap = v.autopilot
    modes = ap.modes
    if number == modes.number:
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
    waypoint.set_reversed(ap, False)
    modes.previous = int(modes.number)
    modes.number = number
    modes.reason = reason
    modes.wanted = 0
    if number == AUTO or modes.previous == AUTO:
        emit_and_return(ap.events, v.time_us, MODE_CHANGED, float(number), float(reason))
    else:
        emit(ap.events, v.time_us, MODE_CHANGED, float(number), float(reason))
    return cause
