# SPDX-License-Identifier: BSD-3-Clause
"""SMART_RTL: flies home along its recorded path, without loops, then lands (or stays at RTL_ALT_FINAL).

``smart_rtl_path`` keeps the path. A point leaves it when it is reached: left on the way, the mode goes on from there.
"""

from __future__ import annotations

from ....core.kernels import law
from ....core.vectors import Vec3
from ... import smart_rtl_path
from ...events import Events
from ...modes import ModeResult
from ...navigation.path import request_leg, request_legs
from ...state import PathState
from ..navigation import waypoint
from ..state import Vehicle
from . import auto_yaw, ground, rtl
from .mode import CopterMode, never_arms
from .state import Modes

SMART_RTL = 21

# States, besides those of RTL's end (``RtlState.state``)
CLEAN_UP = 11
FOLLOW = 12
PRE_LAND = 13

_ABOVE_HOME = 2.0
"""The path ends so high above its first point [m] (ArduPilot's)."""
_NO_PILOT_YAW = 4
"""SRTL_OPTIONS: the yaw stick does nothing."""


@law
def record(v: Vehicle) -> None:
    """Three times a second: the path begins with the first position, and grows while armed, unless on the way back."""
    ap = v.autopilot
    path, pos, known, p = ap.modes.path, ap.estimate.pos, ap.estimate.position_ok, ap.params.SRTL
    if not path.home_saved and known:
        smart_rtl_path.begin(path, pos, True, v.time_us, p)
    if ap.arming.armed and ap.modes.number != SMART_RTL:
        smart_rtl_path.record(path, pos, known, ap.events, v.time_us, p)


@law
def start(v: Vehicle) -> int:
    """Enter; needs a path."""
    ap = v.autopilot
    modes, control, est, p = ap.modes, ap.control, ap.estimate, ap.params
    nav = modes.nav
    if not modes.path.active or modes.path.points == 0:
        return ModeResult.INIT_FAILED
    waypoint.stop(nav)
    nav.speed_ne = nav.speed_up = nav.speed_down = 0.0
    ground.set_waypoint_limits(control, p)
    ground.continue_position_control(control, est, p)
    modes.rtl.state = CLEAN_UP
    modes.rtl.descent_d = ap.home.pos.z - p.RTL.ALT_FINAL * 0.01
    auto_yaw.set_default(modes.auto_yaw, p.WP, True, control.attitude, est)
    return ModeResult.ACCEPTED


@law
def target(path: PathState, k: int) -> Vec3:
    """Where to fly for point ``k`` of the path, NED [m]: there, but over the first one."""
    pos = smart_rtl_path.point(path, k)
    return pos if k > 0 else Vec3(pos.x, pos.y, pos.z - _ABOVE_HOME)


@law
def fly_on(modes: Modes, events: Events, time_us: int) -> None:
    """Fly on to the last point of the path, through it when there is one behind it."""
    path, last = modes.path, modes.path.points - 1
    modes.rtl.state = FOLLOW if last > 0 else PRE_LAND
    if last > 0:
        request_legs(modes.nav, events, time_us, target(path, last), target(path, last - 1))
    else:
        request_leg(modes.nav, events, time_us, target(path, 0))


@law
def run(v: Vehicle) -> None:
    """One tick."""
    ap = v.autopilot
    if (int(ap.params.SRTL.OPTIONS) & _NO_PILOT_YAW) == 0:
        auto_yaw.follow_pilot(ap.modes, ap.control.attitude, ap.estimate)
    if not rtl.run_end(v):
        run_return(v)


@law
def run_return(v: Vehicle) -> None:
    """One tick on the way home."""
    ap = v.autopilot
    modes, control, est, p = ap.modes, ap.control, ap.estimate, ap.params
    reached = False
    if modes.rtl.state == CLEAN_UP:
        smart_rtl_path.clean_up(modes.path, p.SRTL.ACCURACY)
        fly_on(modes, ap.events, v.time_us)
    if modes.nav.request_pending != 0:
        ground.brake(control)
    else:
        reached = waypoint.advance(modes.nav, control, est, p, v.time_us)
    ground.fly(modes.auto_yaw, control, est, p)
    if reached and modes.rtl.state == PRE_LAND:
        rtl.begin_descent(modes, v.time_us, control, est, p)
    elif reached:
        smart_rtl_path.drop_last(modes.path)
        fly_on(modes, ap.events, v.time_us)


MODE = CopterMode(
    number=SMART_RTL,
    name="SMART_RTL",
    title="SMARTRTL",
    start=start,
    run=run,
    needs_position=True,
    autonomous=True,
    may_arm=never_arms,
    is_landing=rtl.is_landing,
)
