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
from ..navigation import command, waypoint
from ..state import Autopilot, Vehicle
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
def has_option(ap: Autopilot, option: int) -> bool:
    """Whether a bit of AUTO_OPTIONS is set."""
    return (int(ap.params.AUTO_OPTIONS) & option) != 0


@law
def may_arm(v: Vehicle, method: int) -> bool:
    """Whether it may be armed: when AUTO_OPTIONS says so."""
    return has_option(v.autopilot, _ARM)


@law
def start(v: Vehicle) -> int:
    """Enter; armed it needs a mission, on the ground one that begins with a take-off."""
    ap = v.autopilot
    if ap.arming.armed:
        if ap.modes.mission_count < 2:
            return INIT_FAILED
        if ap.arming.landed and not ap.modes.mission_takes_off:
            return MISSING_TAKEOFF
    auto = ap.modes.auto
    nav = ap.modes.nav
    waypoint.stop(nav)
    nav.speed_ne = 0.0
    nav.speed_up = 0.0
    nav.speed_down = 0.0
    nav.command_kind = NONE
    auto.command = nav.command_count
    auto.submode = NONE
    auto.started = False
    if ap.modes.auto_yaw.mode == auto_yaw.ROI:
        auto_yaw.set_mode(ap, auto_yaw.HOLD)
    auto_yaw.set_default(ap, False)
    ground.set_waypoint_limits(ap)
    ground.continue_position_control(ap)
    return ACCEPTED


@law
def start_mission(ap: Autopilot) -> None:
    """MAV_CMD_MISSION_START: a take-off at the beginning need not wait for a raised throttle."""
    ap.modes.auto.started = True
    if ap.arming.armed:
        ap.arming.auto_armed = True


@law
def begin(v: Vehicle) -> None:
    """Begin the command that the shell has written."""
    ap = v.autopilot
    nav = ap.modes.nav
    auto = ap.modes.auto
    auto.command = nav.command_count
    auto.submode = nav.command_kind
    auto.land_state = FLYING
    ap.arming.landed_maybe = ap.arming.landed
    command.begin(ap.modes.nav, ap.control, ap.estimate, ap.params, v.time_us)
    if auto.submode == TAKEOFF:
        takeoff.begin(ap, nav.target.z)
    elif auto.submode == RTL:
        rtl.begin(v)
    elif auto.submode == LAND and not nav.has_place:
        begin_descent(v)


@law
def choose_heading(ap: Autopilot, kind: int) -> None:
    """Heading of a new command; do-commands on the way to it have run, or follow."""
    mode = ap.modes.auto_yaw.mode
    if kind == TAKEOFF:
        auto_yaw.set_mode(ap, auto_yaw.HOLD)
    elif mode != auto_yaw.ROI and (mode != auto_yaw.FIXED or ap.params.WP.YAW_BEHAVIOR != 0.0):
        auto_yaw.set_default(ap, False)


@law
def begin_descent(v: Vehicle) -> None:
    """Land where it is."""
    v.autopilot.modes.auto.land_state = DESCENDING
    land.begin(v)


@law
def run(v: Vehicle) -> None:
    """One tick."""
    ap = v.autopilot
    auto = ap.modes.auto
    if auto.command != ap.modes.nav.command_count:
        begin(v)
    if not has_option(ap, _NO_PILOT_YAW):
        auto_yaw.follow_pilot(ap)
    if auto.submode == TAKEOFF:
        run_takeoff(v)
    elif auto.submode == LAND:
        run_land(v)
    elif auto.submode == RTL:
        rtl.run(v)
        if ap.arming.landed and ap.modes.rtl.state == rtl.LANDING:
            complete(ap.modes.nav, ap.events, v.time_us)
    else:
        run_path(v)
    turned = auto_yaw.has_turned(ap.modes.auto_yaw, ap.estimate.euler.yaw)
    check_condition(ap.modes.nav, ap.events, v.time_us, ap.estimate.pos, turned)


@law
def run_path(v: Vehicle) -> None:
    """One tick of a command that follows a path, or of none; on the ground after the last one the vehicle disarms."""
    ap = v.autopilot
    if ground.is_grounded(ap.arming):
        ground.rest(ap)
        if ap.arming.armed and ap.arming.landed and ap.modes.nav.mission_state == COMPLETE:
            ground.disarm(v, BY_MISSION_EXIT)
    elif command.follows_path(ap.modes.auto.submode):
        ap.control.motors.desired_spool = ground.UNLIMITED
        if command.run(ap.modes.nav, ap.control, ap.estimate, ap.params, v.time_us):
            complete(ap.modes.nav, ap.events, v.time_us)
        ground.fly(ap)
    else:
        ground.hold(ap)


@law
def run_takeoff(v: Vehicle) -> None:
    """One tick of the take-off command."""
    ap = v.autopilot
    if ap.arming.armed and (ap.modes.auto.started or has_option(ap, _TAKE_OFF_ALONE)):
        ap.arming.auto_armed = True
    takeoff.run(v)
    if ap.modes.takeoff.complete:
        complete(ap.modes.nav, ap.events, v.time_us)


@law
def run_land(v: Vehicle) -> None:
    """One tick of the land command: to the place at the present height, then down."""
    ap = v.autopilot
    land.finish(v)
    if ap.arming.landed and ap.control.motors.spool_state <= ground.IS_GROUND_IDLE:
        complete(ap.modes.nav, ap.events, v.time_us)
    if ground.is_grounded(ap.arming):
        ground.rest(ap)
        return
    ap.control.motors.desired_spool = ground.UNLIMITED
    if ap.modes.auto.land_state == FLYING:
        reached = waypoint.advance(ap.modes.nav, ap.control, ap.estimate, ap.params, v.time_us)
        ground.fly(ap)
        if reached:
            begin_descent(v)
    else:
        land.descend(ap, False)


@law
def is_landing(v: Vehicle) -> bool:
    """Whether the descent to the ground has begun."""
    auto = v.autopilot.modes.auto
    return rtl.is_landing(v) if auto.submode == RTL else auto.submode == LAND and auto.land_state == DESCENDING


@law
def is_taking_off(v: Vehicle) -> bool:
    """Whether a take-off command is not done yet."""
    return v.autopilot.modes.auto.submode == TAKEOFF and not v.autopilot.modes.takeoff.complete


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
