# SPDX-License-Identifier: BSD-3-Clause
"""SMART_RTL: drives home the way it came, without the loops.

``smart_rtl_path`` keeps the way.
"""

from __future__ import annotations

import math

from ....core.kernels import law
from ....core.vectors import Vec2
from ...events import DESTINATION_REACHED, emit
from ...modes import ACCEPTED, INIT_FAILED
from .. import smart_rtl_path
from ..control import speed
from ..navigation import waypoint
from ..state import Vehicle
from . import drive
from .mode import RoverMode, end_of_path
from .state import PathState

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
        return INIT_FAILED
    waypoint.start(ap)
    if ap.params.RTL_SPEED > 0.0:
        waypoint.set_speed(ap, ap.params.RTL_SPEED)
    ap.modes.smart_rtl.state = CLEAN_UP
    return ACCEPTED


@law
def skip_near(path: PathState, pos: Vec2, radius: float) -> None:
    """Leave out last points within ``radius`` [m] of ``pos``: a car would have to circle to meet them."""
    while path.points > 1:
        away = smart_rtl_path.point(path, path.points - 1) - pos
        if not math.hypot(away.x, away.y) <= radius:
            return
        smart_rtl_path.drop_last(path)


@law
def load(v: Vehicle) -> None:
    """Drive on to the next point, through it when there is one behind it."""
    ap = v.autopilot
    path = ap.modes.path
    if path.points == 0:
        ap.modes.smart_rtl.state = ARRIVED
        emit(ap.events, v.time_us, DESTINATION_REACHED, float(SMART_RTL), 0.0)
        return
    place = smart_rtl_path.point(path, path.points - 1)
    smart_rtl_path.drop_last(path)
    if path.points > 0:
        waypoint.set_destinations(ap, v.time_us, place, smart_rtl_path.point(path, path.points - 1))
    else:
        waypoint.set_destination(ap, v.time_us, place)


@law
def run(v: Vehicle) -> None:
    """One period."""
    ap = v.autopilot
    state = ap.modes.smart_rtl
    if state.state == CLEAN_UP:
        smart_rtl_path.clean_up(ap.modes.path, ap.params.SRTL.ACCURACY)
        skip_near(ap.modes.path, waypoint.stopping_point(ap), ap.params.WP.RADIUS)
        state.state = FOLLOW
        load(v)
    elif state.state == FOLLOW and waypoint.reached(ap):
        load(v)
    if state.state == FOLLOW:
        drive.follow_path(v)
    else:
        speed.stop(v)


MODE = RoverMode(
    number=SMART_RTL,
    name="SMART_RTL",
    start=start,
    run=run,
    needs_position=True,
    autonomous=True,
    armable=False,
    destination=end_of_path,
    change_speed=drive.change_path_speed,
)
