# SPDX-License-Identifier: BSD-3-Clause
"""CIRCLE: flies around a point ahead of it (CIRCLE_RADIUS, CIRCLE_RATE), nose inwards; the throttle stick climbs.

With CIRCLE_OPTIONS 1 the pitch stick changes the radius, at up to WPNAV_SPEED, and the roll stick the turn rate, at up
to 1 deg/s each second. The rate does not change its sign on the way: it stays zero until the stick was centred. The yaw
stick takes the heading over for good.
"""

from __future__ import annotations

import math

from ....core.elementary import atan2, sincos
from ....core.kernels import law
from ....core.scalars import constrain, wrap_pi
from ....core.vectors import Vec3
from ...modes import ModeResult
from ..control import altitude, altitude_start, position_start
from ..control.spool import DesiredSpoolState
from ..control.state import DT
from ..navigation import circle
from ..navigation.state import CopterNav
from ..navigation.waypoint import CM
from ..parameters import Parameters
from ..state import Vehicle
from . import alt_hold, auto_yaw, ground
from .mode import CopterMode, never_arms
from .state import CircleState, PilotState

CIRCLE = 7

# CIRCLE_OPTIONS
_STICKS = 1
_FACE_TRAVEL = 2
_AROUND_HERE = 4

_RATE_CHANGE = math.radians(1.0)
"""Of a full roll stick [rad/s^2] (ArduPilot's)."""
_RATE_MAX = math.radians(90.0)


@law
def start(v: Vehicle) -> int:
    """Enter: the centre is ahead of where the vehicle can stop, or there (CIRCLE_OPTIONS 4)."""
    ap = v.autopilot
    control, est, p = ap.control, ap.estimate, ap.params
    nav, state = ap.modes.nav, ap.modes.circle
    position_start.set_max_speed_accel_ne(control.pos_ne, p, max(CM * p.WPNAV.SPEED, 0.1), CM * p.WPNAV.ACCEL)
    position_start.init_ne_stopping_point(control, est, p)
    alt_hold.set_limits(control.pos_d, p)
    if not altitude_start.is_active_d(control):
        altitude_start.init_d(control, est, p)
    state.radius_set = CM * p.CIRCLE.RADIUS
    state.radius = state.radius_set
    state.rate = math.radians(p.CIRCLE.RATE)
    state.may_turn_back = False
    stop = control.pos_ne.pos_desired
    ahead = 0.0 if (int(p.CIRCLE.OPTIONS) & _AROUND_HERE) != 0 else state.radius
    east, north = sincos(est.yaw)
    n, e = stop.x + ahead * north, stop.y + ahead * east
    nav.circle_centre = Vec3(n, e, est.pos.z)
    circle.start(nav, Vec3(stop.x, stop.y, est.pos.z), est.yaw)
    apply(nav, state, p)
    auto_yaw.set_mode(ap.modes.auto_yaw, auto_yaw.CIRCLE, control.attitude, est)
    return ModeResult.ACCEPTED


@law
def apply(nav: CopterNav, state: CircleState, p: Parameters) -> None:
    """Give the circle its radius and turn rate, as far as WPNAV_SPEED and WPNAV_ACCEL allow."""
    nav.circle_radius = state.radius
    circle.set_limits(nav, state.rate, max(CM * p.WPNAV.SPEED, 0.1), CM * p.WPNAV.ACCEL)
    if state.rate < 0.0:
        nav.circle_top_rate = -nav.circle_top_rate


@law
def steer(state: CircleState, sticks: PilotState, top_rate: float, speed: float) -> None:
    """One tick of the pilot's sticks; ``top_rate`` [rad/s]: as limited, ``speed`` [m/s] of the radius."""
    state.radius = max(state.radius + sticks.pitch * speed * DT, 0.0)
    change = sticks.roll * _RATE_CHANGE * DT
    if change == 0.0:
        state.may_turn_back = True
    elif state.rate > 0.0:
        state.rate = constrain(top_rate + change, 0.0, _RATE_MAX)
        state.may_turn_back = False
    elif state.rate < 0.0:
        state.rate = constrain(top_rate + change, -_RATE_MAX, 0.0)
        state.may_turn_back = False
    elif state.may_turn_back:
        state.rate = change
        state.may_turn_back = False


@law
def heading(nav: CopterNav, pos: Vec3, faces_travel: bool) -> float:
    """Where the nose points [rad] at ``pos`` (NED [m]): to the centre, or along the circle."""
    inward = atan2(nav.circle_centre.y - pos.y, nav.circle_centre.x - pos.x)
    if not faces_travel:
        return inward
    return wrap_pi(inward - (0.5 * math.pi if nav.circle_top_rate >= 0.0 else -0.5 * math.pi))


@law
def run(v: Vehicle) -> None:
    """One tick."""
    ap = v.autopilot
    modes, control, est, p = ap.modes, ap.control, ap.estimate, ap.params
    nav, state, options = modes.nav, modes.circle, int(p.CIRCLE.OPTIONS)
    alt_hold.set_limits(control.pos_d, p)
    if ground.is_grounded(ap.arming):
        ground.rest(ap.arming.armed, control, est, p)
        return
    control.motors.desired_spool = DesiredSpoolState.THROTTLE_UNLIMITED
    if state.radius_set != CM * p.CIRCLE.RADIUS:
        state.radius_set = CM * p.CIRCLE.RADIUS
        state.radius = state.radius_set
    if (options & _STICKS) != 0:
        steer(state, modes.pilot, nav.circle_top_rate, max(CM * p.WPNAV.SPEED, 0.1))
    apply(nav, state, p)
    circle.advance(nav)
    circle.follow(nav, control)
    climb = alt_hold.kept_below(v, alt_hold.FLYING, alt_hold.climb_rate(modes, ap.rc, control.pos_d, p))
    altitude.input_vel_accel_d(control.pos_d, -climb, 0.0)
    auto_yaw.follow_pilot(modes, control.attitude, est)
    if modes.auto_yaw.mode == auto_yaw.CIRCLE:
        modes.auto_yaw.yaw = heading(nav, est.pos, (options & _FACE_TRAVEL) != 0)
        modes.auto_yaw.rate = 0.0
    ground.fly(modes.auto_yaw, control, est, p)


MODE = CopterMode(
    number=CIRCLE,
    name="CIRCLE",
    start=start,
    run=run,
    needs_position=True,
    autonomous=True,
    ignores_simple=True,
    may_arm=never_arms,
)
