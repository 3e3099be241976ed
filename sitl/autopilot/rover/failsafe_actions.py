# SPDX-License-Identifier: BSD-3-Clause
"""What failsafes do (FS_ACTION, BATT_FS_LOW_ACT, BATT_FS_CRT_ACT)."""

from __future__ import annotations

from ...core.kernels import law
from . import arming
from .modes import set_mode
from .modes.numbers import ACCEPTED, HOLD, LOITER, RTL, SMART_RTL

NOTHING = 0
DO_RTL = 1
DO_HOLD = 2
DO_SMART_RTL = 3
"""SMART_RTL, else RTL, else HOLD."""
DO_SMART_RTL_OR_HOLD = 4
TERMINATE = 5
DO_LOITER_OR_HOLD = 6


@law
def act(v, action, reason, method):
    """Change to what ``action`` asks for; what cannot be entered becomes the next best, HOLD at last."""
    if action == NOTHING:
        return
    if action == TERMINATE:
        arming.disarm(v, method, 1)
        return
    if action in (DO_SMART_RTL, DO_SMART_RTL_OR_HOLD):
        if set_mode.request(v, SMART_RTL, reason) == ACCEPTED:
            return
    if action in (DO_RTL, DO_SMART_RTL):
        if set_mode.request(v, RTL, reason) == ACCEPTED:
            return
    if action == DO_LOITER_OR_HOLD:
        if set_mode.request(v, LOITER, reason) == ACCEPTED:
            return
    set_mode.request(v, HOLD, reason)
