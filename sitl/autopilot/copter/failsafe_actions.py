# SPDX-License-Identifier: BSD-3-Clause
"""What failsafes do."""

from __future__ import annotations

from typing import Any

from ...core.kernels import law
from ...core.mavlink import MavSeverity
from ..events import Event, emit
from ..modes import ModeResult
from ..notes import Text
from .modes import ground, set_mode
from .modes.auto import AUTO_RTL
from .modes.brake import BRAKE
from .modes.land import LAND
from .modes.mode_list import has_manual_throttle
from .modes.rtl import RTL
from .modes.smart_rtl import SMART_RTL
from .modes.state import Modes
from .state import Vehicle

# What a failsafe does; the numbers are those of BATT_FS_LOW_ACT and BATT_FS_CRT_ACT
NOTHING = 0
DO_LAND = 1
DO_RTL = 2
DO_SMART_RTL = 3  # else RTL, else LAND
DO_SMART_RTL_OR_LAND = 4
DO_STOP = 5
DO_AUTO_RTL = 6  # else RTL, else LAND
DO_BRAKE = 7

_INSTEAD = {DO_RTL: "Trying RTL Mode", DO_LAND: "Using Land Mode"}


def _texts(v: Any, does: float, by_mission: float) -> list[Text]:
    instead = _INSTEAD[int(does)]
    return [Text(MavSeverity.WARNING, instead if by_mission else f"SmartRTL Unavailable, {instead}")]


NO_RETURN_PATH = Event(36, says=_texts)  # SMART_RTL cannot be entered, or (b: 1) AUTO_RTL; a: what it does

_BATTERY = (NOTHING, DO_LAND, DO_RTL, DO_SMART_RTL, DO_SMART_RTL_OR_LAND, DO_STOP, DO_AUTO_RTL, DO_BRAKE)
_RADIO = (NOTHING, DO_RTL, DO_RTL, DO_LAND, DO_SMART_RTL, DO_SMART_RTL_OR_LAND, DO_AUTO_RTL, DO_BRAKE)
_GCS = (NOTHING, DO_RTL, DO_RTL, DO_SMART_RTL, DO_SMART_RTL_OR_LAND, DO_LAND, DO_AUTO_RTL, DO_BRAKE)

CONTINUE_LANDING = 8
"""FS_OPTIONS: a landing under way goes on."""


@law
def radio_action(choice: int) -> int:
    """What FS_THR_ENABLE means; unknown numbers LAND."""
    return _RADIO[choice] if 0 <= choice < len(_RADIO) else DO_LAND


@law
def gcs_action(choice: int) -> int:
    """What FS_GCS_ENABLE means; unknown numbers RTL."""
    return _GCS[choice] if 0 <= choice < len(_GCS) else DO_RTL


@law
def battery_action(choice: int) -> int:
    """What BATT_FS_LOW_ACT and BATT_FS_CRT_ACT mean."""
    return _BATTERY[choice] if 0 <= choice < len(_BATTERY) else NOTHING


@law
def is_idle(modes: Modes, landed: bool) -> bool:
    """Whether disarming is safe: ``landed``, or the pilot's own throttle is closed."""
    return modes.pilot.throttle_zero if has_manual_throttle(modes.number) else landed


@law
def land_with_pause(v: Vehicle, reason: int) -> None:
    """LAND, and wait 4 s before the descent."""
    if set_mode.request(v, LAND, reason) == ModeResult.ACCEPTED:
        v.autopilot.modes.land.pause = True


@law
def act(v: Vehicle, action: int, reason: int, method: int) -> None:
    """Do what a failsafe asks; on the ground it disarms."""
    ap = v.autopilot
    if action == NOTHING or not ap.arming.armed:
        return
    if is_idle(ap.modes, ap.arming.landed) or action == DO_STOP:
        ground.disarm(v, method)
        return
    mode = ap.modes.number
    if mode == LAND and (int(ap.params.FS.OPTIONS) & CONTINUE_LANDING) != 0:
        return
    if action in (DO_SMART_RTL, DO_SMART_RTL_OR_LAND):
        if set_mode.request(v, SMART_RTL, reason) == ModeResult.ACCEPTED:
            return
        action = DO_RTL if action == DO_SMART_RTL else DO_LAND
        emit(ap.events, v.time_us, NO_RETURN_PATH, float(action), 0.0)
    if action == DO_AUTO_RTL:
        if set_mode.request(v, AUTO_RTL, reason) == ModeResult.ACCEPTED:
            return
        action = DO_RTL
        emit(ap.events, v.time_us, NO_RETURN_PATH, float(action), 1.0)
    if action == DO_RTL:
        if mode != RTL and set_mode.request(v, RTL, reason) != ModeResult.ACCEPTED:
            land_with_pause(v, reason)
    elif action == DO_BRAKE:
        if set_mode.request(v, BRAKE, reason) != ModeResult.ACCEPTED:
            land_with_pause(v, reason)
    elif mode != LAND:
        land_with_pause(v, reason)
