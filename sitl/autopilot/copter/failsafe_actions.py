# SPDX-License-Identifier: BSD-3-Clause
"""What failsafes do."""

from __future__ import annotations

from ...core.kernels import law
from ..modes import ACCEPTED
from .modes import ground, set_mode
from .modes.brake import BRAKE
from .modes.land import LAND
from .modes.rtl import RTL
from .modes.state import Modes
from .modes.table import has_manual_throttle
from .state import Vehicle

# What a failsafe does
NOTHING = 0
DO_LAND = 1
DO_RTL = 2
DO_STOP = 5
DO_BRAKE = 7

CONTINUE_LANDING = 8
"""FS_OPTIONS: a landing under way goes on."""


@law
def radio_action(choice: int) -> int:
    """What FS_THR_ENABLE and FS_GCS_ENABLE mean; return paths that this firmware lacks become RTL or LAND."""
    if choice <= 0:
        return NOTHING
    if choice == 3 or choice == 5:
        return DO_LAND
    if choice == 7:
        return DO_BRAKE
    return DO_RTL


@law
def gcs_action(choice: int) -> int:
    """What FS_GCS_ENABLE means."""
    if choice <= 0:
        return NOTHING
    if choice == 4 or choice == 5:
        return DO_LAND
    if choice == 7:
        return DO_BRAKE
    return DO_RTL


@law
def battery_action(choice: int) -> int:
    """What BATT_FS_LOW_ACT and BATT_FS_CRT_ACT mean."""
    if choice == 1 or choice == 4:
        return DO_LAND
    if choice == 2 or choice == 3 or choice == 6:
        return DO_RTL
    if choice == 5:
        return DO_STOP
    if choice == 7:
        return DO_BRAKE
    return NOTHING


@law
def is_idle(modes: Modes, landed: bool) -> bool:
    """Whether disarming is safe: ``landed``, or the pilot's own throttle is closed."""
    return modes.pilot.throttle_zero if has_manual_throttle(modes.number) else landed


@law
def land_with_pause(v: Vehicle, reason: int) -> None:
    """LAND, and wait 4 s before the descent."""
    if set_mode.request(v, LAND, reason) == ACCEPTED:
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
    if action == DO_RTL:
        if mode != RTL and set_mode.request(v, RTL, reason) != ACCEPTED:
            land_with_pause(v, reason)
    elif action == DO_BRAKE:
        if set_mode.request(v, BRAKE, reason) != ACCEPTED:
            land_with_pause(v, reason)
    elif mode != LAND:
        land_with_pause(v, reason)
