# SPDX-License-Identifier: BSD-3-Clause
"""Changing the flight mode: who may enter what, when."""

from __future__ import annotations

from typing import Any

from ....core.kernels import law
from ....core.mavlink import MavSeverity
from ... import modes as all_modes
from ...events import emit, emit_and_return
from ...fence.checks import begin_recovery, keeps_mode
from ...mission.returning import RETURN_ACTIVE, RETURN_WANTED
from ...modes import MODE_CHANGED, ModeResult, enter, shown
from ...navigation.state import BEST, BY_LANDING, BY_PATH, LANDING, OUTWARD
from ...notes import Text
from ...state import Arming, Estimate
from ..control.motors import hover_throttle
from ..parameters import Parameters
from ..state import Vehicle
from . import autotune_gains, stabilize
from .auto import AUTO, AUTO_RTL
from .autotune import AUTOTUNE
from .drift import DRIFT
from .mode_list import TITLES, has_manual_throttle, is_known, requires_pilot, requires_position, start
from .state import Modes

_CAUSES: dict[int, str] = {
    ModeResult.INIT_FAILED: "init failed",
    ModeResult.REQUIRES_POSITION: "requires position",
    ModeResult.THROTTLE_TOO_HIGH: "throttle too high",
    ModeResult.NEEDS_ALTITUDE: "need alt estimate",
    ModeResult.MISSING_TAKEOFF: "init failed",
    ModeResult.IN_FENCE_RECOVERY: "in fence recovery",
    ModeResult.NO_RADIO: "in RC failsafe",
    ModeResult.GCS_BLOCKED: "GCS entry disabled (FLTMODE_GCSBLOCK)",
    ModeResult.NO_RETURN: "No return path or landing sequence found",
    ModeResult.NO_PATH: "No return path found",
    ModeResult.NO_LANDING: "No landing sequence found",
}


@law
def refusal(number: int, modes: Modes, arming: Arming, estimate: Estimate, p: Parameters) -> int:
    """ACCEPTED, or why the mode cannot be entered, its own conditions aside. Disarmed any mode may be."""
    if not is_known(number):
        return ModeResult.NO_SUCH_MODE
    if not arming.armed:
        return ModeResult.ACCEPTED
    manual_now = has_manual_throttle(modes.number)
    by_stick = has_manual_throttle(number) or number == DRIFT
    if arming.landed and by_stick and not manual_now:
        if stabilize.throttle(modes.pilot, p) > 0.5 * hover_throttle(p.MOT):
            return ModeResult.THROTTLE_TOO_HIGH
    if requires_position(number) and not estimate.position_ok:
        return ModeResult.REQUIRES_POSITION
    if manual_now and not has_manual_throttle(number) and not estimate.attitude_ok:
        return ModeResult.NEEDS_ALTITUDE
    return ModeResult.ACCEPTED


@law
def request(v: Vehicle, number: int, reason: int) -> int:
    """Change to a mode. Returns ACCEPTED (0; also when already there) or the cause (``autopilot.modes``).

    A change is reported to the shell as MODE_CHANGED (number, reason), a refusal as MODE_REFUSED (number,
    cause) with nothing changed.
    """
    if number == AUTO_RTL:
        return go_back(v, BEST, reason)
    if number == shown(v.autopilot.modes):
        v.autopilot.modes.reason = reason
        return ModeResult.ACCEPTED
    return change(v, number, reason)


@law
def change(v: Vehicle, number: int, reason: int) -> int:
    """Change to another mode than the present one, as ``request`` does."""
    ap = v.autopilot
    modes = ap.modes
    pending, over_ground = modes.nav.request_pending, modes.nav.over_ground
    cause = refusal(number, modes, ap.arming, ap.estimate, ap.params)
    if ap.arming.armed and not ap.arming.landed and keeps_mode(ap.fence, modes.reason, ap.params.FENCE):
        cause = ModeResult.IN_FENCE_RECOVERY
    if cause == ModeResult.ACCEPTED and modes.failsafe.radio and requires_pilot(number):
        cause = ModeResult.NO_RADIO
    if cause == ModeResult.ACCEPTED:
        modes.nav.request_pending = 0  # legs that the old mode asked for must not move the new one
        modes.nav.over_ground = False
        cause = start(number, v)
    if cause != ModeResult.ACCEPTED:
        modes.nav.request_pending, modes.nav.over_ground = pending, over_ground
        emit(ap.events, v.time_us, MODE_REFUSED, float(number), float(cause))
        return cause
    if modes.number == AUTOTUNE:
        autotune_gains.leave(v)
    modes.takeoff.user_active = False
    begin_recovery(ap.fence, ap.params.FENCE, ap.events, v.time_us)
    enter(modes, ap.events, v.time_us, number, reason, AUTO)
    return cause


@law
def go_back(v: Vehicle, how: int, reason: int) -> int:
    """AUTO_RTL: go on in AUTO at the mission's part that brings the vehicle back (``how``: BEST, BY_LANDING, BY_PATH).

    Returns what ``request`` does. The shell looks for the part.
    """
    ap = v.autopilot
    modes = ap.modes
    flies_mission = modes.number == AUTO
    if how == BEST and modes.shown == AUTO_RTL:
        return ModeResult.ACCEPTED
    if how != BY_LANDING and modes.nav.mission_part != OUTWARD:
        emit(ap.events, v.time_us, RETURN_ACTIVE, float(modes.nav.mission_part), 0.0)
    elif may_go_back(modes, how):
        emit_and_return(ap.events, v.time_us, RETURN_WANTED, float(how), 1.0 if flies_mission else 0.0)
    else:
        cause: int = ModeResult.NO_RETURN
        if how == BY_LANDING:
            cause = ModeResult.NO_LANDING
        elif how == BY_PATH:
            cause = ModeResult.NO_PATH
        emit(ap.events, v.time_us, MODE_REFUSED, float(AUTO_RTL), float(cause))
        return cause
    cause = ModeResult.ACCEPTED if flies_mission else change(v, AUTO, reason)
    if cause == ModeResult.ACCEPTED:
        if modes.nav.mission_part == OUTWARD:
            modes.nav.mission_part = LANDING  # until the shell, at the end of this tick, has looked for the part
        modes.shown = AUTO_RTL
        modes.reason = reason
        emit(ap.events, v.time_us, MODE_CHANGED, float(AUTO_RTL), float(reason))
    return cause


@law
def may_go_back(modes: Modes, how: int) -> bool:
    """Whether the mission has such a part."""
    return (how != BY_LANDING and modes.mission_returns) or (how != BY_PATH and modes.mission_lands)


def refusal_texts(number: int, cause: int) -> list[str]:
    """Status texts (MAV_SEVERITY_WARNING) of a refused mode change; empty when it was accepted."""
    failed = f"Mode change to {TITLES.get(number)} failed: {_CAUSES.get(cause)}"
    return all_modes.refusal_texts(number, cause, failed)


def _texts(v: Any, number: float, cause: float) -> list[Text]:
    return [Text(MavSeverity.WARNING, text) for text in refusal_texts(int(number), int(cause))]


MODE_REFUSED = all_modes.MODE_REFUSED.saying(says=_texts)
