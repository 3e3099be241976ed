# SPDX-License-Identifier: BSD-3-Clause
"""Changing the mode: who may enter what, when; and the speed of the mode under way."""

from __future__ import annotations

from typing import Any

from ....core.kernels import law
from ....core.mavlink import MavSeverity
from ... import modes as all_modes
from ...events import emit
from ...fence.checks import begin_recovery
from ...modes import ModeReason, ModeResult, enter
from ...notes import Text
from ..control.motors import is_skid
from ..navigation import waypoint
from ..state import Vehicle
from . import mode_list
from .auto import AUTO
from .initialising import INITIALISING

SPEED_MAX = 1e7
"""Speeds beyond this are refused [m/s]."""


def enter_first(v: Vehicle) -> None:
    """At boot: INITIAL_MODE; INITIALISING when that needs what is not known yet (a position, home, a mission)."""
    modes = v.autopilot.modes
    number = int(v.autopilot.params.INITIAL_MODE)
    possible = mode_list.is_known(number) and mode_list.start(number, v) == ModeResult.ACCEPTED
    modes.number = number if possible else INITIALISING
    modes.previous = INITIALISING
    modes.reason = ModeReason.INITIALISED


@law
def refusal(number: int, free: bool, speed_known: bool, skid: bool) -> int:
    """ACCEPTED, or why the mode cannot be entered, its own conditions aside.

    ``free``: any mode may be, disarmed or with a good position; ``skid``: the vehicle is skid-steered.
    """
    if not mode_list.is_known(number):
        return ModeResult.NO_SUCH_MODE
    if free:
        return ModeResult.ACCEPTED
    if mode_list.requires_position(number) or (mode_list.requires_velocity(number, skid) and not speed_known):
        return ModeResult.REQUIRES_POSITION
    return ModeResult.ACCEPTED


@law
def request(v: Vehicle, number: int, reason: int) -> int:
    """Change to a mode. Returns ACCEPTED (0; also when already there) or the cause (``autopilot.modes``).

    A change is reported to the shell as MODE_CHANGED (number, reason), a refusal as MODE_REFUSED (number, cause) with
    nothing changed.
    """
    ap = v.autopilot
    modes = ap.modes
    if number == modes.number:
        return ModeResult.ACCEPTED
    pending = modes.nav.request_pending
    free = not ap.arming.armed or (ap.estimate.position_ok and modes.failsafe.ekf == 0)
    cause = refusal(number, free, ap.control.speed.forward_ok, is_skid(ap.params))
    if cause == ModeResult.ACCEPTED:
        modes.nav.request_pending = 0  # legs that the old mode asked for must not move the new one
        cause = mode_list.start(number, v)
    if cause != ModeResult.ACCEPTED:
        modes.nav.request_pending = pending
        emit(ap.events, v.time_us, MODE_REFUSED, float(number), float(cause))
        return cause
    begin_recovery(ap.fence, ap.params.FENCE, ap.events, v.time_us)
    waypoint.set_reversed(modes.nav, ap.estimate, False, ap.params)
    enter(modes, ap.events, v.time_us, number, reason, AUTO)
    return cause


def change_speed(v: Vehicle, speed: float) -> bool:
    """MAV_CMD_DO_CHANGE_SPEED [m/s] until the mode or its destination's kind changes; whether it was taken."""
    return abs(speed) <= SPEED_MAX and mode_list.CHANGE_SPEED[v.autopilot.modes.number](v, speed)


def refusal_texts(number: int, cause: int) -> list[str]:
    """Status texts of a refused mode change; empty when it was accepted."""
    failed = "Flight mode change failed"
    if cause == ModeResult.GCS_BLOCKED:
        failed = f"Mode change to {mode_list.SHORT_NAMES[number]} denied, GCS entry disabled (FLTMODE_GCSBLOCK)"
    return all_modes.refusal_texts(number, cause, failed)


def _texts(v: Any, number: float, cause: float) -> list[Text]:
    said = refusal_texts(int(number), int(cause))
    mild = said if cause == ModeResult.GCS_BLOCKED else said[:1] if cause == ModeResult.NO_MISSION else []
    return [Text(MavSeverity.NOTICE if text in mild else MavSeverity.WARNING, text) for text in said]


MODE_REFUSED = all_modes.MODE_REFUSED.saying(says=_texts)
