# SPDX-License-Identifier: BSD-3-Clause
"""SMART_RTL: drives home along its recorded path, without loops.

``smart_rtl_path`` keeps the path.
"""

from __future__ import annotations

from dataclasses import replace

from ....core.algebra import with_down
from ....core.kernels import law
from ....core.vectors import Vec3
from ... import smart_rtl_path
from ...events import Events, emit
from ...modes import ModeResult
from ...navigation.path import request_leg, request_legs
from ...state import PathState
from ..control import speed
from ..navigation import waypoint
from ..navigation.state import RoverNav
from ..state import Vehicle
from . import drive, rtl
from .rtl import DESTINATION_REACHED

SMART_RTL = 12

# States
CLEAN_UP = 0
FOLLOW = 1
ARRIVED = 2


@law
def start(v: Vehicle) -> int:
    """Enter; needs a path."""
    ap = v.autopilot
    if not ap.estimate.origin_set or not ap.modes.path.active:
        return ModeResult.INIT_FAILED
    drive.begin_return(ap.modes.nav, ap.control.position, ap.params)
    ap.modes.smart_rtl.state = CLEAN_UP
    return ModeResult.ACCEPTED


@law
def skip_near(path: PathState, pos: Vec3, radius: float) -> None:
    """Leave out last points within ``radius`` [m] of ``pos``: a car would have to circle to meet them."""
    while path.points > 1:
        if not smart_rtl_path.length(smart_rtl_path.point(path, path.points - 1) - pos) <= radius:
            return
        smart_rtl_path.drop_last(path)


@law
def drive_on(path: PathState, nav: RoverNav, events: Events, time_us: int) -> bool:
    """Drive on to the last point of the path, through it when there is one behind it; False when none is left."""
    if path.points == 0:
        return False
    point = smart_rtl_path.point(path, path.points - 1)
    smart_rtl_path.drop_last(path)
    if path.points > 0:
        request_legs(nav, events, time_us, point, smart_rtl_path.point(path, path.points - 1))
    else:
        request_leg(nav, events, time_us, point)
    return True


@law
def run(v: Vehicle) -> None:
    """One period."""
    ap = v.autopilot
    state, path, nav = ap.modes.smart_rtl, ap.modes.path, ap.modes.nav
    at_point = state.state == CLEAN_UP or (state.state == FOLLOW and waypoint.reached(nav))
    if state.state == CLEAN_UP:
        smart_rtl_path.clean_up(path, ap.params.SRTL.ACCURACY)
        stop = with_down(waypoint.stopping_point(ap.estimate, ap.params.ATC), 0.0)
        skip_near(path, stop, ap.params.WP.RADIUS)
        state.state = FOLLOW
    if at_point and not drive_on(path, nav, ap.events, v.time_us):
        state.state = ARRIVED
        emit(ap.events, v.time_us, DESTINATION_REACHED, float(SMART_RTL), 0.0)
    if state.state == FOLLOW:
        drive.follow_path(v)
    else:
        speed.stop(ap.control, ap.arming.armed, ap.params)


MODE = replace(rtl.MODE, number=SMART_RTL, name="SMART_RTL", start=start, run=run)
