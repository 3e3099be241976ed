# SPDX-License-Identifier: BSD-3-Clause
"""MAV_CMD_DO_CHANGE_SPEED: the speed of the mode under way, until the mode or its destination's kind changes."""

from __future__ import annotations

from ....core.kernels import law
from ..navigation import waypoint
from . import auto_state, circle, guided_state
from .guided import are_finite
from .guided_state import NOT_FINITE, OK, OUT_OF_RANGE
from .numbers import AUTO, CIRCLE, GUIDED, RTL, SMART_RTL

LEAST_SPEED = 0.05  # [m/s]
_PATHS = (auto_state.WAYPOINT, auto_state.STOP, auto_state.RTL)


@law
def change_speed(v, speed):
    """OK, or why ``speed`` [m/s] was not taken: NOT_FINITE, or OUT_OF_RANGE also for a mode without a speed."""
    ap = v.autopilot
    if not are_finite(speed, 0.0):
        return NOT_FINITE
    mode = ap.modes.number
    submode = int(ap.modes.auto.submode) if mode == AUTO else -1
    if mode == CIRCLE or submode == auto_state.CIRCLE:
        return OK if circle.change_speed(v, speed) != 0 else OUT_OF_RANGE
    if submode == auto_state.HEADING_AND_SPEED:
        ap.modes.auto.speed = speed
        return OK
    guided = mode == GUIDED or submode == auto_state.GUIDED
    if guided and ap.modes.guided.submode != guided_state.POSITION:
        return OUT_OF_RANGE
    along_path = guided or mode in (RTL, SMART_RTL) or submode in _PATHS
    if not along_path or speed < LEAST_SPEED:
        return OUT_OF_RANGE
    waypoint.set_speed(ap, speed)
    return OK
