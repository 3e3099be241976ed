# SPDX-License-Identifier: BSD-3-Clause
"""RTL: drives home or to a rally point along a planned leg (RTL_SPEED) and stops there."""

from __future__ import annotations

from ....core.algebra import horizontal, with_down
from ....core.kernels import law
from ....core.mavlink import MavSeverity
from ... import rally
from ...events import Event, emit
from ...modes import ModeResult
from ...navigation.path import request_leg
from ..control import speed
from ..heights import HEIGHTS
from ..navigation import waypoint
from ..state import Vehicle
from . import drive
from .mode import RoverMode, end_of_path

RTL = 11

DESTINATION_REACHED = Event(22, MavSeverity.INFO, "Reached destination")  # end of a way home; a: mode


@law
def start(v: Vehicle) -> int:
    """Enter; needs a home."""
    ap = v.autopilot
    if not ap.home.is_set:
        return ModeResult.INIT_FAILED
    nav = ap.modes.nav
    drive.begin_return(nav, ap.control.position, ap.params)
    target = rally.best(ap.rally, ap.estimate, ap.home, ap.fence, ap.params, HEIGHTS)
    request_leg(nav, ap.events, v.time_us, with_down(horizontal(target), 0.0))
    ap.modes.rtl.is_reported = False
    return ModeResult.ACCEPTED


@law
def run(v: Vehicle) -> None:
    """One period."""
    ap = v.autopilot
    if not waypoint.reached(ap.modes.nav):
        drive.follow_path(v)
        return
    if not ap.modes.rtl.is_reported:
        ap.modes.rtl.is_reported = True
        emit(ap.events, v.time_us, DESTINATION_REACHED, float(ap.modes.number), 0.0)
    speed.stop(ap.control, ap.arming.armed, ap.params)


MODE = RoverMode(
    number=RTL,
    name="RTL",
    start=start,
    run=run,
    needs_position=True,
    autonomous=True,
    armable=False,
    destination=end_of_path,
    change_speed=drive.change_path_speed,
)
