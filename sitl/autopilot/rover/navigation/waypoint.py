# SPDX-License-Identifier: BSD-3-Clause
"""Drives to destinations: along planned legs with rounded corners, or after a target that is shaped towards them.

For the modes, positions NE metres from the EKF origin::

    start       a mode begins: limits from the parameters, forwards, no destination
    path.request_leg    to a point along a leg; one that was reached just now is continued from its end. The shell plans
                the leg: it is there on the next period
    path.request_legs   the same with the destination after it, for a corner without a stop; ``request_leg(s)`` to the
                second when the first is reached takes its leg over
    set_destination_shaped      without a plan, for destinations that change often
    follow      one period (50 Hz); then ``nav.drive`` has desired_speed, desired_turn_rate and desired_lat_accel.
                Brakes without a destination, disarmed, or without a position
    reached     whether it is at the destination (a corner: when the next leg takes over)
    set_speed, set_reversed, stop, stopping_point

and ``distance``, ``bearing`` of ``navigation.path``, ``pivot.is_active``, ``nav.drive.crosstrack``, ``nudge_speed``.
In AUTO the shell plans the legs of a mission before it gives the command: then ``follow`` is all there is to call.
WP_SPEED, WP_RADIUS, WP_ACCEL, WP_JERK, WP_PIVOT_*, TURN_RADIUS, ATC_TURN_MAX_G as ArduPilot uses them
(https://ardupilot.org/rover/docs/rover-tuning-navigation.html).
"""

from __future__ import annotations

import math

from ....core.algebra import cross2, dot2, horizontal, norm2, with_down
from ....core.elementary import atan2, hypot
from ....core.kernels import law
from ....core.scalars import finite, wrap_pi
from ....core.vectors import Vec2, Vec3
from ...control.shaping import Motion2
from ...navigation import path
from ...navigation.state import BENT, STRAIGHT
from ...state import Estimate
from ..control import position, speed
from ..control.state import DT, Control, PositionState
from ..control.steering import lat_accel_max, turn_rate_from_heading
from ..parameters import Parameters
from ..parameters.control import Attitude
from . import pivot
from .state import DriveState, RoverNav

ACTIVE_US = 100_000
"""A path followed within this time is still the one under way."""
SPEED_MIN = 0.05
"""Least speed limit [m/s]."""
UNLIMITED = 20.0
"""Acceleration when no parameter limits it [m/s^2]."""
SPEED_CHANGE_US = 500_000
"""The speed limit changes no more often: each change plans the legs anew."""
ARRIVED = 0.01
"""A shaped target this near to the destination has come there [m]."""


@law
def top_speed(nav: RoverNav, params: Parameters) -> float:
    """Speed limit of the path [m/s]: WP_SPEED as the mode began, or what a command set; or the pilot's nudge above."""
    limit = nav.speed_ne if nav.speed_ne > 0.0 else params.WP.SPEED
    return max(limit, SPEED_MIN, nav.drive.nudge_speed)


@law
def accel_max(params: Parameters) -> float:
    """Acceleration and deceleration along legs [m/s^2]: WP_ACCEL within ATC_ACCEL_MAX and ATC_DECEL_MAX."""
    limit = min(params.ATC.ACCEL_MAX, speed.decel_max(params.ATC))
    if limit <= 0.0:
        limit = UNLIMITED
    return min(params.WP.ACCEL, limit) if params.WP.ACCEL > 0.0 else limit


@law
def jerk_max(params: Parameters) -> float:
    """[m/s^3]: WP_JERK; 0 there means as much as the acceleration."""
    return params.WP.JERK if params.WP.JERK > 0.0 else accel_max(params)


@law
def corner_radius(params: Parameters) -> float:
    """Corners stay this near to their waypoint [m]."""
    return max(params.WP.RADIUS, position.turn_radius(params))


@law
def set_limits(c: PositionState, nav: RoverNav, params: Parameters) -> None:
    """Give the position controller the limits of the path."""
    limit = top_speed(nav, params)
    position.set_limits(c, limit, accel_max(params), lat_accel_max(params.ATC), jerk_max(params))


@law
def stopping_point(estimate: Estimate, params: Attitude) -> Vec2:
    """Where braking from the present motion ends [m]."""
    pos, vel = horizontal(estimate.pos), horizontal(estimate.vel)
    size = norm2(vel)
    if size <= 0.0:
        return pos
    return pos + vel / size * speed.stopping_distance(size, params)


@law
def start(nav: RoverNav, c: PositionState, params: Parameters) -> None:
    """A mode begins: limits from the parameters, forwards, no destination."""
    stop(nav)
    nav.time_scale = 1.0
    nav.speed_ne = max(params.WP.SPEED, SPEED_MIN)  # as ArduRover: one that is set on the way acts in the next mode
    nav.drive.nudge_speed = 0.0
    nav.drive.reversed = False
    set_limits(c, nav, params)


@law
def stop(nav: RoverNav) -> None:
    """Forget the destination."""
    drive = nav.drive
    path.stop(nav)
    drive.shaped = False
    drive.crosstrack = 0.0
    drive.pivot_next = False
    pivot.end(drive)


@law
def set_destination_shaped(nav: RoverNav, estimate: Estimate, time_us: int, point: Vec2, params: Parameters) -> None:
    """Drive to a point after a shaped target and stop there."""
    going_on = nav.drive.shaped and is_active(nav, time_us)
    nav.drive.origin = horizontal(nav.target) if going_on else stopping_point(estimate, params.ATC)
    path.clear_legs(nav)
    nav.request_pending = 0
    nav.target = with_down(point, 0.0)
    nav.reached = False
    nav.drive.shaped = True
    pivot.check(nav.drive, time_us, heading_error(nav, estimate), False, params)


@law
def begin_leg(nav: RoverNav, estimate: Estimate, time_us: int, params: Parameters) -> None:
    """The shell has planned a leg to ``nav.target``: turn towards it first if that is far."""
    drive = nav.drive
    drive.origin = horizontal(nav.current.origin)
    drive.shaped = False
    if nav.fresh:
        nav.fresh = False
        nav.vel = Vec3(0.0, 0.0, 0.0)
    if not nav.joined:
        pivot.end(drive)
        pivot.check(drive, time_us, heading_error(nav, estimate), drive.pivot_next, params)
    drive.pivot_next = False


@law
def set_speed(nav: RoverNav, wanted: float) -> bool:
    """Speed limit [m/s] from now on, until a mode begins anew; False for one that is too slow or not finite."""
    if not wanted >= SPEED_MIN or not finite(wanted):
        return False
    nav.speed_ne = wanted
    return True


@law
def set_reversed(nav: RoverNav, estimate: Estimate, backward: bool, params: Parameters) -> None:
    """Drive backwards or forwards; a skid-steered vehicle on its way turns round first."""
    if backward == nav.drive.reversed:
        return
    nav.drive.reversed = backward
    if has_destination(nav) and pivot.would_turn(heading_error(nav, estimate), params):
        pivot.begin(nav.drive)


@law
def is_active(nav: RoverNav, time_us: int) -> bool:
    """Whether ``follow`` ran a moment ago."""
    return nav.active_us > 0 and time_us - nav.active_us < ACTIVE_US


@law
def has_destination(nav: RoverNav) -> bool:
    """Whether there is anywhere to go."""
    return nav.drive.shaped or nav.current.segments > 0 or nav.request_pending != 0


@law
def reached(nav: RoverNav) -> bool:
    """Whether it is at the destination; False while a new one is being planned."""
    return nav.reached and nav.request_pending == 0


@law
def heading_to_destination(nav: RoverNav, pos: Vec3) -> float:
    """Heading that takes a vehicle at ``pos`` [m] to the destination [rad], nose or tail first."""
    goal = nav.detour.bent_target if nav.detour.bend == BENT else nav.target
    towards = atan2(goal.y - pos.y, goal.x - pos.x)
    return wrap_pi(towards + math.pi) if nav.drive.reversed else towards


@law
def heading_error(nav: RoverNav, estimate: Estimate) -> float:
    """From the nose to that heading [rad], not wrapped."""
    return heading_to_destination(nav, estimate.pos) - estimate.yaw


@law
def command(drive: DriveState, speed: float, turn_rate: float, lat_accel: float) -> None:
    """What the mode hands to the controllers [m/s, rad/s, m/s^2]."""
    drive.desired_speed = speed
    drive.desired_turn_rate = turn_rate
    drive.desired_lat_accel = lat_accel


@law
def follow(nav: RoverNav, control: Control, estimate: Estimate, armed: bool, time_us: int, params: Parameters) -> bool:
    """One period; whether the speed limit has changed, so that the shell must plan the legs anew."""
    drive = nav.drive
    if not (armed and estimate.position_ok and control.speed.forward_ok and has_destination(nav)):
        command(drive, speed.accel_limited(control, 0.0, params.ATC), 0.0, 0.0)
        drive.crosstrack = 0.0
        return False
    if not is_active(nav, time_us):
        command(drive, control.speed.forward, 0.0, 0.0)
    nav.active_us = time_us
    if nav.request_pending != 0:
        return False
    changed = follow_speed_limit(nav, control.position, time_us, params)
    move_target(nav, control, estimate, params)
    drive.crosstrack = crosstrack(drive.origin, horizontal(nav.target), horizontal(estimate.pos))
    c = control.position
    c.reversed = drive.reversed
    position.follow_target(control, estimate, armed, params)
    if pivot.is_active(drive, params):
        turn_on_the_spot(nav, control, estimate, time_us, params)
    else:
        command(drive, c.desired_speed, c.desired_turn_rate, c.desired_lat_accel)
    return changed and not drive.shaped


@law
def turn_on_the_spot(nav: RoverNav, control: Control, estimate: Estimate, time_us: int, params: Parameters) -> None:
    """One period of a pivot turn: first it stops."""
    drive = nav.drive
    command(drive, speed.accel_limited(control, 0.0, params.ATC), 0.0, 0.0)
    if drive.desired_speed == 0.0:
        error = heading_error(nav, estimate)
        rate_max = math.radians(params.WP.PIVOT_RATE)
        drive.desired_turn_rate = turn_rate_from_heading(wrap_pi(error), rate_max, params.ATC)
        pivot.check(drive, time_us, error, False, params)


@law
def follow_speed_limit(nav: RoverNav, c: PositionState, time_us: int, params: Parameters) -> bool:
    """Give the position controller a speed limit that has changed; whether it has."""
    drive = nav.drive
    if top_speed(nav, params) == c.speed_max:
        return False
    if drive.speed_us > 0 and time_us - drive.speed_us < SPEED_CHANGE_US:
        return False
    drive.speed_us = time_us
    set_limits(c, nav, params)
    return True


@law
def move_target(nav: RoverNav, control: Control, estimate: Estimate, params: Parameters) -> None:
    """Move the position controller's target on, unless the vehicle turns on the spot."""
    c = control.position
    if not position.is_active(control):
        position.init(c, estimate)
    if pivot.is_active(nav.drive, params):
        return
    if nav.detour.bend != STRAIGHT:
        position.input_pos(c, horizontal(nav.detour.bent_target))
    elif nav.drive.shaped:
        position.input_pos(c, horizontal(nav.target))
        nav.reached = nav.reached or has_arrived(c, horizontal(nav.target), params.WP.RADIUS)
    else:
        advance(nav, c, estimate, params)


@law
def has_arrived(c: PositionState, destination: Vec2, radius: float) -> bool:
    """Whether a shaped target has come to the destination [m] and the vehicle is within ``radius`` [m] of it."""
    left = destination - c.pos_target
    return dot2(left, left) < ARRIVED * ARRIVED and dot2(c.pos_error, c.pos_error) < radius * radius


@law
def advance(nav: RoverNav, c: PositionState, estimate: Estimate, params: Parameters) -> None:
    """Move the target along the legs."""
    pos = estimate.pos
    feasible = path.feasible_time_scale(nav, pos, estimate.vel, params.PSC.POS_P)
    path.scale_time(nav, feasible, accel_max(params) / jerk_max(params), DT)
    done = path.move(nav, nav.time_scale * DT, corner_radius(params), lat_accel_max(params.ATC))
    position.set_pos_vel_accel(c, Motion2(horizontal(nav.pos), horizontal(nav.vel), horizontal(nav.acc)))
    if done and not nav.reached:
        near = path.distance(nav, pos) <= params.WP.RADIUS
        if nav.current.fast or near or has_passed(nav.drive.origin, horizontal(nav.target), horizontal(pos)):
            path.arrive(nav)


@law
def has_passed(origin: Vec2, target: Vec2, pos: Vec2) -> bool:
    """Whether ``pos`` is beyond the end of the line from ``origin`` to ``target`` [m]."""
    return dot2(target - origin, target - pos) <= 0.0


@law
def crosstrack(origin: Vec2, target: Vec2, pos: Vec2) -> float:
    """Distance of ``pos`` from the line between the waypoints [m], negative to its right.

    From the point when they are one.
    """
    line = target - origin
    length = hypot(line.x, line.y)
    if length < 1e-6:
        return hypot(target.x - pos.x, target.y - pos.y)
    return cross2(pos - origin, line) / length
