# SPDX-License-Identifier: BSD-3-Clause
"""AUTO: flies the mission's navigation commands one after the other.

The shell writes the command under way into ``modes.nav`` and counts it up; this mode begins it, flies it
and says when it is done (``navigation.command.complete``), upon which the shell gives the next.
"""

from __future__ import annotations

from ....core.algebra import horizontal
from ....core.kernels import law
from ....core.mavlink import MavSeverity
from ...arming_checks import ArmingMethod
from ...events import Event, Events, emit
from ...modes import MODE_CHANGED, ModeReason, ModeResult
from ...navigation import state as kinds
from ...navigation.command import check_condition, complete
from ...navigation.state import COMPLETE, LAND, LOITER_TO_ALT, NONE, OUTWARD, PASSED_OVER, PAYLOAD_PLACE, RTL, TAKEOFF
from ...notes import Text
from ...state import Arming, Estimate
from ..control.spool import DesiredSpoolState, SpoolState
from ..control.state import AttitudeState, Control
from ..navigation import circle, command, waypoint
from ..navigation.state import CopterNav
from ..parameters import Parameters
from ..parameters.flight_modes import Waypoints
from ..state import Vehicle
from . import auto_yaw, descent, ground, guided, land, loiter_to_alt, payload_place, precision_land, rtl, takeoff
from .mode import CopterMode
from .state import AutoState, AutoYaw, Modes

AUTO = 3
AUTO_RTL = 27
"""Shown instead while the mission's way back is flown (auto_rtl.py)."""

# AUTO_OPTIONS
_ARM = 1
_TAKE_OFF_ALONE = 2  # without a raised throttle
_NO_PILOT_YAW = 128

# LAND: on the way to the position, then going down
FLYING = 0
DESCENDING = 1

CIRCLE_BEGINS = Event(59, says=lambda v, a, b: [Text(MavSeverity.INFO, f"Mission: starting circle {int(a)}/{int(b)}")])
"""The next circle of a mission's LOITER_TURNS; a: its number, b: how many"""


@law
def has_option(p: Parameters, option: int) -> bool:
    """Whether a bit of AUTO_OPTIONS is set."""
    return (int(p.AUTO_OPTIONS) & option) != 0


@law
def may_arm(p: Parameters, method: int) -> bool:
    """Whether it may be armed: when AUTO_OPTIONS says so."""
    return has_option(p, _ARM)


@law
def refusal(modes: Modes, arming: Arming) -> int:
    """ACCEPTED, or why not: armed it needs a mission, on the ground one that begins with a take-off."""
    if arming.armed and modes.mission_count < 2:
        return ModeResult.INIT_FAILED
    if arming.armed and arming.landed and not modes.mission_takes_off:
        return ModeResult.MISSING_TAKEOFF
    return ModeResult.ACCEPTED


@law
def reset(auto: AutoState, nav: CopterNav) -> None:
    """Wait for the first command; speeds are the parameters' again."""
    waypoint.stop(nav)
    nav.speed_ne = 0.0
    nav.speed_up = 0.0
    nav.speed_down = 0.0
    nav.command_kind = NONE
    auto.command = nav.command_count
    auto.submode = NONE
    auto.started = False


@law
def start(v: Vehicle) -> int:
    """Enter."""
    ap = v.autopilot
    modes, control, est, p = ap.modes, ap.control, ap.estimate, ap.params
    cause = refusal(modes, ap.arming)
    if cause != ModeResult.ACCEPTED:
        return cause
    reset(modes.auto, modes.nav)
    guided.clear_limits(modes.guided)
    if modes.auto_yaw.mode == auto_yaw.ROI:
        auto_yaw.set_mode(modes.auto_yaw, auto_yaw.HOLD, control.attitude, est)
    auto_yaw.set_default(modes.auto_yaw, p.WP, False, control.attitude, est)
    ground.set_waypoint_limits(control, p)
    ground.continue_position_control(control, est, p)
    return ModeResult.ACCEPTED


def start_mission(auto: AutoState, arming: Arming) -> None:
    """MAV_CMD_MISSION_START: a take-off at the beginning need not wait for a raised throttle."""
    auto.started = True
    if arming.armed:
        arming.auto_armed = True


@law
def begin(v: Vehicle) -> None:
    """Begin the command that the shell has written."""
    ap = v.autopilot
    modes, control, est, p = ap.modes, ap.control, ap.estimate, ap.params
    auto, nav = modes.auto, modes.nav
    auto.command = nav.command_count
    auto.submode = nav.command_kind
    auto.land_state = FLYING
    ap.arming.landed_maybe = ap.arming.landed
    command.begin(nav, control, est, p, v.time_us)
    if auto.submode == TAKEOFF:
        takeoff.begin(modes.takeoff, nav.target.z, ap.arming.landed, control, est, p)
    elif auto.submode == RTL:
        rtl.begin(v)
    elif auto.submode == kinds.GUIDED:
        guided.start(v)
        guided.begin_limits(modes.guided, v.time_us, horizontal(est.pos))
    elif auto.submode == PAYLOAD_PLACE:
        payload_place.begin(v)
    elif auto.submode == LAND and not nav.has_target:
        begin_descent(modes, v.time_us, control, est, p)


def choose_heading(yaw: AutoYaw, kind: int, p: Waypoints, target: AttitudeState, est: Estimate) -> None:
    """Heading of a new command of a ``kind``; do-commands on the way to it have run, or follow."""
    if kind == TAKEOFF:
        auto_yaw.set_mode(yaw, auto_yaw.HOLD, target, est)
    elif yaw.mode != auto_yaw.ROI and (yaw.mode != auto_yaw.FIXED or p.YAW_BEHAVIOR != 0.0):
        auto_yaw.set_default(yaw, p, False, target, est)


@law
def begin_descent(modes: Modes, time_us: int, control: Control, est: Estimate, p: Parameters) -> None:
    """Land where it is."""
    modes.auto.land_state = DESCENDING
    descent.begin(modes, time_us, control, est, p)


@law
def run(v: Vehicle) -> None:
    """One tick."""
    ap = v.autopilot
    modes, est = ap.modes, ap.estimate
    if modes.auto.command != modes.nav.command_count:
        begin(v)
    if modes.auto.submode != kinds.GUIDED and not has_option(ap.params, _NO_PILOT_YAW):
        auto_yaw.follow_pilot(modes, ap.control.attitude, est)
    if run_command(v, modes.auto.submode):
        complete(modes.nav, ap.events, v.time_us)
    end_return(v)
    turned = auto_yaw.has_turned(modes.auto_yaw, est.yaw)
    check_condition(modes.nav, ap.events, v.time_us, est.pos, turned)


@law
def end_return(v: Vehicle) -> None:
    """AUTO_RTL is over when the mission goes on elsewhere."""
    modes = v.autopilot.modes
    nav = modes.nav
    if modes.shown == AUTO_RTL and nav.mission_part == OUTWARD and nav.mission_state != COMPLETE:
        modes.shown = 0
        modes.reason = ModeReason.AUTO_RTL_EXIT
        emit(v.autopilot.events, v.time_us, MODE_CHANGED, float(AUTO), float(ModeReason.AUTO_RTL_EXIT))


@law
def run_command(v: Vehicle, kind: int) -> bool:
    """One tick of a command of a ``kind``; whether it is done."""
    ap = v.autopilot
    if kind == TAKEOFF:
        if ap.arming.armed and (ap.modes.auto.started or has_option(ap.params, _TAKE_OFF_ALONE)):
            ap.arming.auto_armed = True
        takeoff.run(v)
        return ap.modes.takeoff.complete
    if kind == LAND:
        return run_land(v)
    if kind == LOITER_TO_ALT:
        return loiter_to_alt.run(v)
    if kind == PAYLOAD_PLACE:
        return payload_place.run(v)
    if kind == RTL:
        rtl.run(v)
        return ap.arming.landed and rtl.is_landing(ap.modes)
    if kind == kinds.GUIDED:
        guided.run(v)
        return guided.is_at_limit(ap.modes.guided, v.time_us, ap.estimate.pos)
    return run_path(v, kind) or kind == PASSED_OVER


@law
def run_path(v: Vehicle, kind: int) -> bool:
    """One tick of a command that follows a path, or of none; whether it is done.

    On the ground after the last one the vehicle disarms.
    """
    ap = v.autopilot
    modes, control, est, p = ap.modes, ap.control, ap.estimate, ap.params
    if ground.is_grounded(ap.arming):
        ground.rest(ap.arming.armed, control, est, p)
        if ap.arming.armed and ap.arming.landed and modes.nav.mission_state == COMPLETE:
            ground.disarm(v, ArmingMethod.MISSION_EXIT)
        return kind == kinds.DELAY and command.has_waited(modes.nav, v.time_us)
    if not command.follows_path(kind):
        ground.hold(modes.auto_yaw, control, est, p)
        return False
    control.motors.desired_spool = DesiredSpoolState.THROTTLE_UNLIMITED
    done = command.run(modes.nav, control, est, p, v.time_us)
    if kind == kinds.LOITER_TURNS and modes.nav.circle_running:
        report_circle(modes.nav, ap.events, v.time_us)
    ground.fly(modes.auto_yaw, control, est, p)
    return done


@law
def report_circle(nav: CopterNav, events: Events, time_us: int) -> None:
    """Say when the next circle begins, and when the last one is done."""
    number = 1 + int(circle.turned(nav))
    if number > nav.circle_reported:
        nav.circle_reported = number
        emit(events, time_us, CIRCLE_BEGINS, float(number), float(int(nav.turns)))


@law
def run_land(v: Vehicle) -> bool:
    """One tick of the land command: to the position at the present height, then down; whether it is done."""
    ap = v.autopilot
    modes, control, est, p = ap.modes, ap.control, ap.estimate, ap.params
    land.finish(v)
    done = ap.arming.landed and control.motors.spool_state <= SpoolState.GROUND_IDLE
    if ground.is_grounded(ap.arming):
        ground.rest(ap.arming.armed, control, est, p)
        return done
    control.motors.desired_spool = DesiredSpoolState.THROTTLE_UNLIMITED
    if modes.auto.land_state == DESCENDING:
        precision_land.descend(v)
        return done
    reached = waypoint.advance(modes.nav, control, est, p, v.time_us)
    ground.fly(modes.auto_yaw, control, est, p)
    if reached:
        begin_descent(modes, v.time_us, control, est, p)
    return done


@law
def is_guided(modes: Modes) -> bool:
    """Whether set-points are flown: in GUIDED, and where a mission allows them."""
    return modes.number == guided.GUIDED or (modes.number == AUTO and modes.auto.submode == kinds.GUIDED)


def is_on_a_path(nav: CopterNav) -> bool:
    """Whether the command under way follows a path to a position that it has not reached."""
    return nav.command_kind in (kinds.WAYPOINT, kinds.LOITER_UNLIMITED, kinds.LOITER_TIME) and not nav.reached


@law
def is_landing(modes: Modes) -> bool:
    """Whether the descent to the ground has begun."""
    auto = modes.auto
    return rtl.is_landing(modes) if auto.submode == RTL else auto.submode == LAND and auto.land_state == DESCENDING


@law
def is_taking_off(modes: Modes) -> bool:
    """Whether a take-off command is not done yet."""
    return modes.auto.submode == TAKEOFF and not modes.takeoff.complete


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
