# SPDX-License-Identifier: BSD-3-Clause
"""AUTO: flies the mission's navigation commands one after the other.

The shell writes the command under way into ``modes.nav`` and counts it up; this mode begins it, flies it
and says when it is done (``navigation.command.complete``), upon which the shell gives the next.
"""

from __future__ import annotations

from ....core.kernels import law
from ...arming_checks import BY_MISSION_EXIT
from ...modes import ACCEPTED, INIT_FAILED, MISSING_TAKEOFF
from ...navigation.command import check_condition, complete
from ...navigation.state import COMPLETE, LAND, NONE, RTL, TAKEOFF
from ..control import altitude, altitude_start, position, position_start
from ..navigation import command, waypoint
from . import auto_yaw, ground, land, rtl, takeoff
from .mode import CopterMode

AUTO = 3

# AUTO_OPTIONS
_ARM = 1
_TAKE_OFF_ALONE = 2  # without a raised throttle
_NO_PILOT_YAW = 128

# LAND: on the way to the place, then going down
FLYING = 0
DESCENDING = 1


@law
def start(v):
    """Enter; armed it needs a mission, on the ground one that begins with a take-off."""
    ap = v.autopilot
    if ap.arming.armed:
        if ap.modes.mission_count < 2:
            return INIT_FAILED
        if ap.arming.landed != 0 and ap.modes.mission_takes_off == 0:
            return MISSING_TAKEOFF
    auto = ap.modes.auto
    waypoint.stop(ap)
    ap.modes.nav.speed_ne = 0.0
    ap.modes.nav.speed_up = 0.0
    ap.modes.nav.speed_down = 0.0
    auto.command = int(ap.modes.nav.command_count)
    ap.modes.nav.command_kind = NONE
    auto.submode = NONE
    auto.started = 0
    if ap.modes.auto_yaw.mode == auto_yaw.ROI:
        auto_yaw.set_mode(v, auto_yaw.HOLD)
    auto_yaw.set_default(v, 0)
    ground.set_waypoint_limits(v)
    if not position_start.is_active_ne(ap.control):
        position_start.init_ne(ap)
    if not altitude_start.is_active_d(ap.control):
        altitude_start.init_d(ap)
    return ACCEPTED


@law
def may_arm(v, method):
    """Whether it may be armed: when AUTO_OPTIONS says so."""
    return (int(v.autopilot.params.AUTO_OPTIONS) & _ARM) != 0


@law
def start_mission(v):
    """MAV_CMD_MISSION_START: a take-off at the beginning need not wait for a raised throttle."""
    v.autopilot.modes.auto.started = 1
    if v.autopilot.arming.armed != 0:
        v.autopilot.arming.auto_armed = 1


@law
def begin(v):
    """Begin the command that the shell has written."""
    ap = v.autopilot
    nav = ap.modes.nav
    auto = ap.modes.auto
    auto.command = int(nav.command_count)
    auto.submode = int(nav.command_kind)
    auto.land_state = FLYING
    ap.arming.landed_maybe = ap.arming.landed
    command.begin(ap, v.time_us)
    if auto.submode == TAKEOFF:
        takeoff.begin(v, float(nav.target[2]))
    elif auto.submode == RTL:
        rtl.begin(v)
    elif auto.submode == LAND and nav.has_place == 0:
        begin_descent(v)


@law
def face(v, kind):
    """Heading of a new command; do-commands on the way to it have run, or follow."""
    yaw = v.autopilot.modes.auto_yaw
    if kind == TAKEOFF:
        auto_yaw.set_mode(v, auto_yaw.HOLD)
    elif yaw.mode != auto_yaw.ROI and (yaw.mode != auto_yaw.FIXED or v.autopilot.params.WP.YAW_BEHAVIOR != 0.0):
        auto_yaw.set_default(v, 0)


@law
def begin_descent(v):
    """Land where it is."""
    v.autopilot.modes.auto.land_state = DESCENDING
    land.begin(v)


@law
def run(v):
    """One tick."""
    ap = v.autopilot
    nav = ap.modes.nav
    auto = ap.modes.auto
    if auto.command != nav.command_count:
        begin(v)
    if (int(ap.params.AUTO_OPTIONS) & _NO_PILOT_YAW) == 0:
        auto_yaw.pilot(v)
    kind = auto.submode
    if kind == TAKEOFF:
        run_takeoff(v)
    elif kind == LAND:
        run_land(v)
    elif kind == RTL:
        rtl.run(v)
        if ap.arming.landed != 0 and ap.modes.rtl.state == rtl.LANDING:
            complete(ap, v.time_us)
    elif ground.is_grounded(v):
        ground.handle(v)
        if ap.arming.armed != 0 and ap.arming.landed != 0 and nav.mission_state == COMPLETE:
            ground.disarm(v, BY_MISSION_EXIT)
    else:
        ap.control.motors.desired_spool = ground.UNLIMITED
        if command.follows_path(kind) != 0:
            command.run(ap, v.time_us)
        else:
            position.brake_ne(ap.control.pos_ne)
            altitude.input_vel_accel_d(ap.control.pos_d, 0.0, 0.0)
        ground.fly(v)
    check_condition(ap, v.time_us, auto_yaw.reached(v))


@law
def run_takeoff(v):
    """One tick of the take-off command."""
    ap = v.autopilot
    if ap.arming.armed != 0 and ap.arming.auto_armed == 0:
        if ap.modes.auto.started != 0 or (int(ap.params.AUTO_OPTIONS) & _TAKE_OFF_ALONE) != 0:
            ap.arming.auto_armed = 1
    takeoff.run(v)
    if ap.modes.takeoff.complete != 0:
        complete(ap, v.time_us)


@law
def run_land(v):
    """One tick of the land command: to the place at the present height, then down."""
    ap = v.autopilot
    land.finish(v)
    if ap.arming.landed != 0 and ap.control.motors.spool_state <= ground.IS_GROUND_IDLE:
        complete(ap, v.time_us)
    if ground.is_grounded(v):
        ground.handle(v)
        return
    ap.control.motors.desired_spool = ground.UNLIMITED
    if ap.modes.auto.land_state == FLYING:
        reached = waypoint.advance(ap, v.time_us)
        ground.fly(v)
        if reached != 0:
            begin_descent(v)
    else:
        land.descend(v, 0)


@law
def is_landing(v):
    """Whether the descent to the ground has begun."""
    auto = v.autopilot.modes.auto
    if auto.submode == RTL:
        return rtl.is_landing(v)
    return auto.submode == LAND and auto.land_state == DESCENDING


@law
def is_taking_off(v):
    """Whether a take-off command is not done yet."""
    return v.autopilot.modes.auto.submode == TAKEOFF and v.autopilot.modes.takeoff.complete == 0


MODE = CopterMode(
    number=AUTO,
    name="AUTO",
    start=start,
    run=run,
    standard_mode=6,
    needs_position=True,
    autonomous=True,
    arms_at_any_throttle=True,
    may_arm=may_arm,
    is_landing=is_landing,
    is_taking_off=is_taking_off,
)
