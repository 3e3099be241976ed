# SPDX-License-Identifier: BSD-3-Clause
"""RTL: drives home along a planned leg (RTL_SPEED) and stops there."""

from __future__ import annotations

from ....core.algebra import horizontal
from ....core.kernels import law
from ...events import DESTINATION_REACHED, emit
from ..control import speed
from ..navigation import waypoint
from . import drive
from .numbers import ACCEPTED, INIT_FAILED


@law
def start(v):
    """Enter; needs a home."""
    ap = v.autopilot
    if ap.home.is_set == 0:
        return INIT_FAILED
    waypoint.start(ap)
    if ap.params.RTL_SPEED > 0.0:
        waypoint.set_speed(ap, float(ap.params.RTL_SPEED))
    waypoint.set_destination(ap, v.time_us, horizontal(ap.home.pos))
    ap.modes.rtl.told = 0
    return ACCEPTED


@law
def run(v):
    """One period."""
    ap = v.autopilot
    if not waypoint.reached(ap):
        drive.along_path(v)
        return
    if ap.modes.rtl.told == 0:
        ap.modes.rtl.told = 1
        emit(ap.events, v.time_us, DESTINATION_REACHED, float(ap.modes.number), 0.0)
    speed.stop(v)
