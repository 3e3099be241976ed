# SPDX-License-Identifier: BSD-3-Clause
"""The rover's auxiliary functions."""

from __future__ import annotations

from ...core.mavlink import MavSeverity
from .. import aux_functions as shared
from .. import home
from ..aux_functions import AuxFunction, Holder
from ..aux_switch import HIGH
from ..mission.mission import Mission
from ..mission.notes import Note
from ..notes import Text
from . import arming
from .modes.auto import AUTO
from .modes.mode_list import NAMES
from .modes.set_mode import request

_MODES = {4: 11, 16: 10, 42: 12, 51: 0, 52: 1, 53: 3, 54: 4, 55: 15, 56: 5, 57: 6, 59: 7, 72: 9}
"""Function -> mode, as far as the firmware has the mode."""


def _save_waypoint(holder: Holder, position: int) -> list[Note]:
    """Disarmed it begins a new mission: the old one is cleared, and home is here."""
    ap = holder.v.autopilot
    if position != HIGH or ap.modes.number == AUTO:
        return []
    if ap.arming.armed:
        shared.append_items(holder, [shared.item_here(holder)])
        return []
    notes = [*holder.sequencer.set_mission(holder.v, Mission()), Text(MavSeverity.NOTICE, "SaveWP: Mission cleared!")]
    if home.set_here(ap.home, ap.estimate):
        ap.home.locked = True
        notes.append(Text(MavSeverity.INFO, home.set_text(ap.home)))
        shared.append_items(holder, [])
    return notes


FUNCTIONS = shared.by_number(
    (
        *shared.COMMON,
        *(shared.change_mode(number, NAMES[mode], mode, request) for number, mode in _MODES.items() if mode in NAMES),
        AuxFunction(
            7, _save_waypoint, "high: adds the position to the mission; disarmed begins a new one here", "SaveWaypoint"
        ),
        *shared.without_effect({63: "SailboatTack", 74: "SailboatMotor", 97: ""}),
        shared.arm_or_disarm(153, arming),
        shared.disarm(arming),
        shared.arm_or_stop(arming),
    )
)
