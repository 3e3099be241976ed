# SPDX-License-Identifier: BSD-3-Clause
"""RTL: climbs, flies home along a planned leg, waits, lands (or stays at RTL_ALT_FINAL)."""

from __future__ import annotations

import math

from ....core.algebra import ZERO2, horizontal, with_down
from ....core.kernels import law
from ...control.shaping import Motion
from ...modes import ACCEPTED, INIT_FAILED
from ...navigation import path
from ..control import altitude, position, position_start
from ..navigation import waypoint
from ..parameters.flight import Rtl
from ..state import Autopilot, Vehicle
from . import auto_yaw, ground, land
from .mode import CopterMode, never_arms

RTL = 6

# States
CLIMB = 1
RETURN = 2
LOITER = 3
FINAL_DESCENT = 4
LANDING = 5

_CLIMB_MIN = 0.3
"""Home is approached at least this high [m]."""
_SLOPE_MIN = 0.5


@law
def start(v: Vehicle) -> int:
    """Enter; armed it needs a home."""
    if v.autopilot.arming.armed and not v.autopilot.home.is_set:
        return INIT_FAILED
    begin(v)
    return ACCEPTED


@law
def begin(v: Vehicle) -> None:
    """Prepare the way home from the present motion."""
    ap = v.autopilot
    rtl = ap.modes.rtl
    waypoint.stop(ap.modes.nav)
    ap.modes.nav.speed_ne = max(ap.params.RTL.SPEED * 0.01, 0.0)
    ap.modes.nav.speed_up = 0.0
    ap.modes.nav.speed_down = 0.0
    ground.set_waypoint_limits(ap)
    ground.continue_position_control(ap)
    plan_heights(ap)
    rtl.state = CLIMB
    rtl.loiter_us = 0
    auto_yaw.set_mode(ap, auto_yaw.HOLD)
    above = with_down(position_start.stopping_point_ne(ap.control.pos_ne, ap.estimate, ap.params.PSC), rtl.return_d)
    if ap.arming.armed and not ap.arming.landed:
        path.request_legs(ap.modes.nav, ap.events, v.time_us, above, with_down(rtl.home, rtl.return_d))


@law
def plan_heights(ap: Autopilot) -> None:
    """Where home is, the height of the way there, and where RTL_ALT_FINAL ends."""
    rtl = ap.modes.rtl
    home = ap.home.pos
    away = home - ap.estimate.pos
    rtl.home = horizontal(home)
    rtl.return_d = home.z - return_height(away.z, math.hypot(away.x, away.y), ap.params.RTL)
    rtl.descent_d = home.z - ap.params.RTL.ALT_FINAL * 0.01


@law
def return_height(height: float, distance: float, p: Rtl) -> float:
    """Height of the way home from a height and a distance, all above or from home [m]; never below the present one.

    RTL_ALT, RTL_CLIMB_MIN, RTL_CONE_SLOPE.
    """
    height_min = max(_CLIMB_MIN, height + max(p.CLIMB_MIN * 0.01, 0.0))
    target = max(p.ALT * 0.01, height_min)
    if p.CONE_SLOPE >= _SLOPE_MIN:
        target = min(target, max(distance * p.CONE_SLOPE, height_min))
    return max(target, height)


@law
def run(v: Vehicle) -> None:
    """One tick."""
    ap = v.autopilot
    rtl = ap.modes.rtl
    auto_yaw.follow_pilot(ap)
    if not ap.arming.armed:
        ground.rest(ap)
    elif rtl.state == LANDING:
        run_landing(v)
    elif ground.is_grounded(ap.arming):
        ground.rest(ap)
    else:
        ap.control.motors.desired_spool = ground.UNLIMITED
        if rtl.state == FINAL_DESCENT:
            run_descent(ap)
        else:
            run_way(v)


@law
def run_way(v: Vehicle) -> None:
    """One tick of the climb, the way home and the wait there."""
    ap = v.autopilot
    rtl = ap.modes.rtl
    reached = False
    if ap.modes.nav.request_pending != 0:
        ground.brake(ap)
    else:
        reached = waypoint.advance(ap.modes.nav, ap.control, ap.estimate, ap.params, v.time_us)
    ground.fly(ap)
    if rtl.state == CLIMB:
        if reached:
            rtl.state = RETURN
            auto_yaw.set_default(ap, True)
            path.request_leg(ap.modes.nav, ap.events, v.time_us, with_down(rtl.home, rtl.return_d))
    elif rtl.state == RETURN:
        if reached:
            rtl.state = LOITER
            rtl.loiter_us = v.time_us
    elif v.time_us - rtl.loiter_us >= ap.params.RTL.LOIT_TIME * 1000.0:
        begin_descent(v)


@law
def begin_descent(v: Vehicle) -> None:
    """Over home: land, or go down to RTL_ALT_FINAL."""
    ap = v.autopilot
    if ap.params.RTL.ALT_FINAL > 0.0 and not ap.modes.failsafe.radio:
        ap.modes.rtl.state = FINAL_DESCENT
        ground.set_waypoint_limits(ap)
    else:
        ap.modes.rtl.state = LANDING
        land.begin(v)


@law
def run_landing(v: Vehicle) -> None:
    """One tick of the landing at home."""
    ap = v.autopilot
    land.finish(v)
    if ground.is_grounded(ap.arming):
        ground.rest(ap)
        return
    ap.control.motors.desired_spool = ground.UNLIMITED
    land.descend(ap, False)


@law
def run_descent(ap: Autopilot) -> None:
    """One tick on the way to RTL_ALT_FINAL, and of the stay there; the sticks move the vehicle."""
    position.input_vel_accel_ne(ap.control.pos_ne, land.stick_velocity(ap), ZERO2)
    altitude.input_pos_vel_accel_d(ap.control.pos_d, Motion(ap.modes.rtl.descent_d, 0.0, 0.0))
    ground.fly(ap)


@law
def is_landing(v: Vehicle) -> bool:
    """Whether the descent to the ground has begun."""
    return v.autopilot.modes.rtl.state == LANDING


MODE = CopterMode(
    number=RTL,
    name="RTL",
    start=start,
    run=run,
    standard_mode=5,
    needs_position=True,
    autonomous=True,
    may_arm=never_arms,
    is_landing=is_landing,
)
