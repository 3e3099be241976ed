# SPDX-License-Identifier: BSD-3-Clause
"""RTL: climbs, flies home along a planned leg, waits, lands (or stays at RTL_ALT_FINAL)."""

from __future__ import annotations

import math

from ....core.algebra import with_down
from ....core.kernels import law
from ....core.vectors import Vec2, Vec3
from ...control.shaping import Motion
from ...modes import ACCEPTED, INIT_FAILED
from ...navigation import path
from ..control import altitude, altitude_start, position, position_start
from ..navigation import waypoint
from . import auto_yaw, ground, land
from .mode import CopterMode, never_arms

RTL = 6

# States
CLIMB = 1
RETURN = 2
LOITER = 3
FINAL_DESCENT = 4
LANDING = 5

_LEAST_CLIMB = 0.3
"""Home is approached at least this high [m]."""
_LEAST_SLOPE = 0.5


@law
def start(v):
    """Enter; armed it needs a home."""
    if v.autopilot.arming.armed and not v.autopilot.home.is_set:
        return INIT_FAILED
    begin(v)
    return ACCEPTED


@law
def begin(v):
    """Prepare the way home from the present motion."""
    ap = v.autopilot
    rtl = ap.modes.rtl
    waypoint.stop(ap)
    speed = ap.params.RTL.SPEED * 0.01
    ap.modes.nav.speed_ne = speed if speed > 0.0 else 0.0
    ap.modes.nav.speed_up = 0.0
    ap.modes.nav.speed_down = 0.0
    ground.set_waypoint_limits(v)
    if not position_start.is_active_ne(ap.control):
        position_start.init_ne(ap)
    if not altitude_start.is_active_d(ap.control):
        altitude_start.init_d(ap)
    build_path(v)
    rtl.state = CLIMB
    rtl.loiter_us = 0
    auto_yaw.set_mode(v, auto_yaw.HOLD)
    stop = position_start.stopping_point_ne(ap)
    if ap.arming.armed != 0 and ap.arming.landed == 0:
        path.request_legs(ap, v.time_us, with_down(stop, rtl.return_d), Vec3(rtl.home[0], rtl.home[1], rtl.return_d))


@law
def build_path(v):
    """Height of the way home: RTL_ALT, RTL_CLIMB_MIN, RTL_CONE_SLOPE; never below the present height."""
    ap = v.autopilot
    p = ap.params
    rtl = ap.modes.rtl
    rtl.home[0] = ap.home.pos[0]
    rtl.home[1] = ap.home.pos[1]
    home_d = float(ap.home.pos[2])
    height = home_d - float(ap.estimate.pos[2])
    rtl.return_d = home_d - return_height(
        height,
        math.hypot(ap.home.pos[0] - ap.estimate.pos[0], ap.home.pos[1] - ap.estimate.pos[1]),
        p.RTL.ALT * 0.01,
        p.RTL.CLIMB_MIN * 0.01,
        p.RTL.CONE_SLOPE,
    )
    rtl.descent_d = home_d - p.RTL.ALT_FINAL * 0.01


@law
def return_height(height, distance, wanted, climb, slope):
    """Height of the way home [m above home] from a height and a distance [m] from home."""
    least = max(_LEAST_CLIMB, height + max(climb, 0.0))
    target = max(wanted, least)
    if slope >= _LEAST_SLOPE:
        target = min(target, max(distance * slope, least))
    return max(target, height)


@law
def run(v):
    """One tick."""
    ap = v.autopilot
    rtl = ap.modes.rtl
    auto_yaw.pilot(v)
    if ap.arming.armed == 0:
        ground.handle(v)
        return
    if rtl.state == LANDING:
        run_landing(v)
        return
    if ground.is_grounded(v):
        ground.handle(v)
        return
    ap.control.motors.desired_spool = ground.UNLIMITED
    if rtl.state == FINAL_DESCENT:
        run_descent(v)
        return
    reached = 0
    if ap.modes.nav.request_pending != 0:
        position.brake_ne(ap.control.pos_ne)
        altitude.input_vel_accel_d(ap.control.pos_d, 0.0, 0.0)
    else:
        reached = waypoint.advance(ap, v.time_us)
    ground.fly(v)
    if rtl.state == CLIMB:
        if reached != 0:
            rtl.state = RETURN
            auto_yaw.set_default(v, 1)
            path.request_leg(ap, v.time_us, Vec3(rtl.home[0], rtl.home[1], rtl.return_d))
    elif rtl.state == RETURN:
        if reached != 0:
            rtl.state = LOITER
            rtl.loiter_us = v.time_us
    elif v.time_us - rtl.loiter_us >= ap.params.RTL.LOIT_TIME * 1000.0:
        begin_descent(v)


@law
def begin_descent(v):
    """Over home: land, or go down to RTL_ALT_FINAL."""
    ap = v.autopilot
    rtl = ap.modes.rtl
    if ap.params.RTL.ALT_FINAL > 0.0 and ap.modes.failsafe.radio == 0:
        rtl.state = FINAL_DESCENT
        ground.set_waypoint_limits(v)
    else:
        rtl.state = LANDING
        land.begin(v)


@law
def run_landing(v):
    """One tick of the landing at home."""
    ap = v.autopilot
    land.finish(v)
    if ground.is_grounded(v):
        ground.handle(v)
        return
    ap.control.motors.desired_spool = ground.UNLIMITED
    land.descend(v, 0)


@law
def run_descent(v):
    """One tick on the way to RTL_ALT_FINAL, and of the stay there; the sticks move the vehicle."""
    ap = v.autopilot
    rtl = ap.modes.rtl
    position.input_vel_accel_ne(ap.control.pos_ne, land.stick_velocity(ap), Vec2(0.0, 0.0))
    altitude.input_pos_vel_accel_d(ap.control.pos_d, Motion(rtl.descent_d, 0.0, 0.0))
    ground.fly(v)


@law
def is_landing(v):
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
