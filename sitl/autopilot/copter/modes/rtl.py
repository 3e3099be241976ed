# SPDX-License-Identifier: BSD-3-Clause
"""RTL: climbs, flies home or to a rally point along a planned leg, turns as when armed, waits, lands (or stays at
RTL_ALT_FINAL).
"""

from __future__ import annotations

from ....core.algebra import ZERO2, horizontal, with_down
from ....core.elementary import hypot
from ....core.kernels import law
from ....core.vectors import Vec3
from ... import rally
from ...control.shaping import Motion
from ...events import Events, emit
from ...fence.state import MAX_ALT
from ...modes import ModeResult
from ...navigation import path
from ...state import Estimate
from ...terrain.state import RTL_WITHOUT, TERRAIN_DID
from .. import terrain_following
from ..control import altitude, position, position_start
from ..control.spool import DesiredSpoolState
from ..control.state import Control
from ..navigation import waypoint
from ..parameters import Parameters
from ..parameters.flight_modes import Rtl
from ..state import Vehicle
from ..terrain_following import ground_below, is_flat
from . import auto_yaw, descent, ground, land, precision_land
from .mode import CopterMode, never_arms
from .state import AutoYaw, Modes, RtlState

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
_NO_PILOT_YAW = 4
"""RTL_OPTIONS"""


@law
def start(v: Vehicle) -> int:
    """Enter; armed it needs a home."""
    if v.autopilot.arming.armed and not v.autopilot.home.is_set:
        return ModeResult.INIT_FAILED
    begin(v)
    return ModeResult.ACCEPTED


@law
def begin(v: Vehicle) -> None:
    """Prepare the way home from the present motion."""
    prepare(v, v.autopilot.params.RTL.ALT_TYPE > 0.0)


@law
def prepare(v: Vehicle, over_ground: bool) -> None:
    """The same; ``over_ground``: at a height above the ground, where its height is known."""
    ap = v.autopilot
    modes, control, est, p = ap.modes, ap.control, ap.estimate, ap.params
    rtl, nav = modes.rtl, modes.nav
    waypoint.stop(nav)
    nav.speed_ne = max(p.RTL.SPEED * 0.01, 0.0)
    nav.speed_up = 0.0
    nav.speed_down = 0.0
    ground.set_waypoint_limits(control, p)
    ground.continue_position_control(control, est, p)
    fence = Vec3(p.FENCE.ALT_MAX, p.FENCE.ALT_MIN, p.FENCE.MARGIN)
    target = rally.best(ap.rally, est, ap.home, ap.fence, p, fence)
    plan_heights(rtl, ap.home.pos, target, est.pos, p.RTL)
    if over_ground:
        plan_over_ground(v, target)
    if ap.fence.on & int(p.FENCE.TYPE) & MAX_ALT != 0:
        zero = nav.ground_d if nav.over_ground else 0.0
        keep_below(rtl, ap.home.pos.z - (fence.x - fence.z) - zero, est.pos.z - zero)
    rtl.state = CLIMB
    rtl.loiter_us = 0
    auto_yaw.set_mode(modes.auto_yaw, auto_yaw.HOLD, control.attitude, est)
    above = with_down(position_start.stopping_point_ne(control.pos_ne, est, p.PSC), rtl.return_d)
    if ap.arming.armed and not ap.arming.landed:
        path.request_legs(nav, ap.events, v.time_us, above, with_down(rtl.home, rtl.return_d))


@law
def plan_heights(rtl: RtlState, home: Vec3, target: Vec3, pos: Vec3, p: Rtl) -> None:
    """Where to go, the height of the way there from ``pos``, and where RTL_ALT_FINAL ends; NED [m].

    ``target``: home or a rally point, above which the vehicle arrives no lower than that.
    """
    away = target - pos
    rtl.home = horizontal(target)
    rtl.return_d = home.z - return_height(home.z - pos.z, home.z - target.z, hypot(away.x, away.y), p)
    rtl.descent_d = home.z - p.ALT_FINAL * 0.01


@law
def plan_over_ground(v: Vehicle, target: Vec3) -> None:
    """Heights of the way back are above the ground below it (RTL_ALT_TYPE 1), where that is known."""
    ap = v.autopilot
    ground_now, away = ground_below(v), target - ap.estimate.pos
    if not ground_now.is_known:
        emit(ap.events, v.time_us, TERRAIN_DID, float(RTL_WITHOUT), 0.0)
    elif not is_flat(v):
        terrain_following.begin(ap.modes.nav, ground_now)
        height, distance = ground_now.d - ap.estimate.pos.z, hypot(away.x, away.y)
        ap.modes.rtl.return_d = -return_height(height, ap.home.pos.z - target.z, distance, ap.params.RTL)


@law
def keep_below(rtl: RtlState, top_d: float, d: float) -> None:
    """The way back leads no higher than ``top_d``, but not down from where the vehicle is; down [m]."""
    rtl.return_d = min(max(rtl.return_d, top_d), d)


@law
def return_height(height: float, least: float, distance: float, p: Rtl) -> float:
    """Height of the way back from a height and a distance, all above home [m]; never below the present one.

    RTL_ALT, RTL_CLIMB_MIN, RTL_CONE_SLOPE; ``least``: of the position to return to.
    """
    height_min = max(_CLIMB_MIN, height + max(p.CLIMB_MIN * 0.01, 0.0))
    target = max(max(p.ALT * 0.01, least), height_min)
    if p.CONE_SLOPE >= _SLOPE_MIN:
        target = min(target, max(distance * p.CONE_SLOPE, height_min))
    return max(target, height)


@law
def heeds_yaw_stick(state: int, p: Parameters) -> bool:
    """Whether the yaw stick turns the vehicle: RTL_OPTIONS can forbid it until it lands, or is moved by sticks."""
    if int(p.RTL.OPTIONS) & _NO_PILOT_YAW == 0:
        return True
    return state == LANDING or (state == FINAL_DESCENT and p.LAND.REPOSITION != 0.0)


@law
def run(v: Vehicle) -> None:
    """One tick."""
    ap = v.autopilot
    if heeds_yaw_stick(ap.modes.rtl.state, ap.params):
        auto_yaw.follow_pilot(ap.modes, ap.control.attitude, ap.estimate)
    if not run_end(v):
        run_return(ap.modes, ap.events, v.time_us, ap.control, ap.estimate, ap.params)


@law
def run_end(v: Vehicle) -> bool:
    """One tick on the ground, or of what comes after the way home; False: it is on its way."""
    ap = v.autopilot
    modes, control, est, p = ap.modes, ap.control, ap.estimate, ap.params
    if is_landing(modes):
        land.finish(v)
    if ground.is_grounded(ap.arming):
        ground.rest(ap.arming.armed, control, est, p)
        return True
    control.motors.desired_spool = DesiredSpoolState.THROTTLE_UNLIMITED
    if is_landing(modes):
        precision_land.descend(v)
        return True
    if modes.rtl.state == FINAL_DESCENT:
        run_descent(modes, control, est, p)
        return True
    return False


@law
def run_return(modes: Modes, events: Events, time_us: int, control: Control, est: Estimate, p: Parameters) -> None:
    """One tick of the climb, the way home and the wait there."""
    rtl, nav = modes.rtl, modes.nav
    reached = False
    if nav.request_pending != 0:
        ground.brake(control)
    else:
        reached = waypoint.advance(nav, control, est, p, time_us)
    ground.fly(modes.auto_yaw, control, est, p)
    if rtl.state == CLIMB:
        if reached:
            rtl.state = RETURN
            auto_yaw.set_default(modes.auto_yaw, p.WP, True, control.attitude, est)
            path.request_leg(nav, events, time_us, with_down(rtl.home, rtl.return_d))
    elif rtl.state == RETURN:
        if reached:
            rtl.state = LOITER
            rtl.loiter_us = time_us
            turn_back(modes.auto_yaw, control, p)
    elif auto_yaw.has_turned(modes.auto_yaw, est.yaw) and time_us - rtl.loiter_us >= p.RTL.LOIT_TIME * 1000.0:
        begin_descent(modes, time_us, control, est, p)


@law
def turn_back(yaw: AutoYaw, control: Control, p: Parameters) -> None:
    """Over home: turn to the heading of arming, unless WP_YAW_BEHAVIOR keeps the heading on the way home."""
    if auto_yaw.default_mode(int(p.WP.YAW_BEHAVIOR), True) != auto_yaw.HOLD:
        start = control.attitude.target_euler.yaw
        auto_yaw.turn_to(yaw, auto_yaw.Turn(yaw.armed, 0.0, 0, False), start, auto_yaw.slew_max(p.ATC))


@law
def begin_descent(modes: Modes, time_us: int, control: Control, est: Estimate, p: Parameters) -> None:
    """Over home: land, or go down to RTL_ALT_FINAL."""
    if p.RTL.ALT_FINAL > 0.0 and not modes.failsafe.radio:
        modes.rtl.state = FINAL_DESCENT
        ground.set_waypoint_limits(control, p)
    else:
        modes.rtl.state = LANDING
        descent.begin(modes, time_us, control, est, p)


@law
def run_descent(modes: Modes, control: Control, est: Estimate, p: Parameters) -> None:
    """One tick on the way to RTL_ALT_FINAL, and of the stay there; the sticks move the vehicle."""
    position.input_vel_accel_ne(control.pos_ne, descent.stick_velocity(modes.pilot, est.yaw, p), ZERO2)
    altitude.input_pos_vel_accel_d(control.pos_d, Motion(modes.rtl.descent_d, 0.0, 0.0))
    ground.fly(modes.auto_yaw, control, est, p)


@law
def is_landing(modes: Modes) -> bool:
    """Whether the descent to the ground has begun."""
    return modes.rtl.state == LANDING


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
