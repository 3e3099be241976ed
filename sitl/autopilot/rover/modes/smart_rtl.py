# SPDX-License-Identifier: BSD-3-Clause
"""SMART_RTL: drives home the way it came, without the loops (``smart_rtl_path``)."""

from __future__ import annotations

import math

from ....core.kernels import law
from ....core.vectors import Vec2
from ...events import DESTINATION_REACHED, emit
from .. import smart_rtl_path
from ..control import speed
from ..navigation import waypoint
from . import drive
from .numbers import ACCEPTED, INIT_FAILED, SMART_RTL

# States
CLEAN_UP = 0
FOLLOW = 1
ARRIVED = 2


@law
def start(v):
    """Enter; needs a path."""
    ap = v.autopilot
    if ap.estimate.origin_set == 0 or ap.modes.path.active == 0:
        return INIT_FAILED
    waypoint.start(ap)
    if ap.params.RTL_SPEED > 0.0:
        waypoint.set_speed(ap, float(ap.params.RTL_SPEED))
    ap.modes.smart_rtl.state = CLEAN_UP
    return ACCEPTED


@law
def skip_near(ap):
    """Leave out last points where the vehicle is already (WP_RADIUS): a car would have to circle to meet them."""
    there, n, e = smart_rtl_path.peek(ap)
    at = waypoint.stopping_point(ap)
    while there != 0 and ap.modes.path.points > 1 and math.hypot(n - at.x, e - at.y) <= ap.params.WP.RADIUS:
        smart_rtl_path.pop(ap)
        there, n, e = smart_rtl_path.peek(ap)


@law
def load(v):
    """Drive on to the next point, through it when there is one behind it."""
    ap = v.autopilot
    there, n, e = smart_rtl_path.pop(ap)
    if there == 0:
        ap.modes.smart_rtl.state = ARRIVED
        emit(ap.events, v.time_us, DESTINATION_REACHED, float(SMART_RTL), 0.0)
        return
    more, next_n, next_e = smart_rtl_path.peek(ap)
    if more != 0:
        waypoint.set_destinations(ap, v.time_us, Vec2(n, e), Vec2(next_n, next_e))
    else:
        waypoint.set_destination(ap, v.time_us, Vec2(n, e))


@law
def run(v):
    """One period."""
    ap = v.autopilot
    state = ap.modes.smart_rtl
    if state.state == CLEAN_UP:
        smart_rtl_path.clean_up(ap)
        skip_near(ap)
        state.state = FOLLOW
        load(v)
    elif state.state == FOLLOW and waypoint.reached(ap):
        load(v)
    if state.state == FOLLOW:
        drive.along_path(v)
    else:
        speed.stop(v)
