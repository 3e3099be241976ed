# SPDX-License-Identifier: BSD-3-Clause
"""Drives to destinations: along planned legs with rounded corners, or after a target that is shaped towards them.

For the modes, positions NE metres from the EKF origin::

    start(v)                    a mode begins: limits from the parameters, forwards, no destination
    set_destination(v, n, e)    along a leg; one that was reached just now is continued from its end. The shell plans
                                the leg (as RTL of the copter): it is there on the next period
    set_destinations(v, n, e, n2, e2)   the same with the destination after it, for a corner without a stop;
                                ``set_destination(s)`` to the second when the first is reached takes its leg over
    set_destination_shaped(v, n, e)     without a plan, for destinations that change often
    update(v)                   one period (50 Hz); then ``nav.drive`` has desired_speed, desired_turn_rate and
                                desired_lat_accel. Brakes without a destination, disarmed, or without a position
    reached(ap)                 1 at the destination (a corner: when the next leg takes over)
    set_speed(ap, speed), set_nudge_speed(ap, speed), set_reversed(ap, backward)
    stop(v)                     forget the destination
    is_fast(ap), stopping_point(ap)

and ``distance``, ``bearing`` of ``navigation.path``, ``pivot.is_active``, ``nav.drive.crosstrack``.
In AUTO the shell plans the legs of a mission before it gives the command: then ``update`` is all there is to call.
WP_SPEED, WP_RADIUS, WP_ACCEL, WP_JERK, WP_PIVOT_*, TURN_RADIUS, ATC_TURN_MAX_G as ArduPilot uses them
(https://ardupilot.org/rover/docs/rover-tuning-navigation.html).
"""

from __future__ import annotations

import math

from ....core.kernels import law
from ....core.scalars import wrap_pi
from ...events import LEG_ENDING, emit_and_return
from ...navigation import path
from ...navigation.state import SPEED_REQUEST
from ..control import position, speed
from ..control.state import DT
from ..control.steering import lat_accel_max
from . import pivot

ACTIVE_US = 100_000
"""A path followed within this time is still the one under way."""
SLOWEST = 0.05
"""Least speed limit [m/s]."""
UNLIMITED = 20.0
"""Acceleration when no parameter limits it [m/s^2]."""
SPEED_CHANGE_US = 500_000
"""The speed limit changes no more often: each change plans the legs anew."""
ARRIVED = 0.01
"""A shaped target this near to the destination has come there [m]."""


@law
def top_speed(ap):
    """Speed limit of the path [m/s]: WP_SPEED or what a command set, or the pilot's nudge above it."""
    nav = ap.modes.nav
    limit = float(nav.speed_ne) if nav.speed_ne > 0.0 else float(ap.params.WP.SPEED)
    return max(limit, SLOWEST, float(nav.drive.nudge_speed))


@law
def accel_max(ap):
    """Acceleration and deceleration along legs [m/s^2]: WP_ACCEL within ATC_ACCEL_MAX and ATC_DECEL_MAX."""
    most = min(float(ap.params.ATC.ACCEL_MAX), speed.decel_max(ap))
    if most <= 0.0:
        most = UNLIMITED
    return min(float(ap.params.WP.ACCEL), most) if ap.params.WP.ACCEL > 0.0 else most


@law
def jerk_max(ap):
    """[m/s^3]: WP_JERK; 0 there means as much as the acceleration."""
    return float(ap.params.WP.JERK) if ap.params.WP.JERK > 0.0 else accel_max(ap)


@law
def corner_radius(ap):
    """Corners stay this near to their waypoint [m]."""
    return max(float(ap.params.WP.RADIUS), position.turn_radius(ap))


@law
def set_limits(ap):
    """Give the position controller the limits of the path."""
    position.set_limits(ap, top_speed(ap), accel_max(ap), lat_accel_max(ap), jerk_max(ap))


@law
def stopping_point(ap):
    """(north, east) [m] where braking from the present motion ends."""
    n, e = float(ap.estimate.pos[0]), float(ap.estimate.pos[1])
    vn, ve = float(ap.estimate.vel[0]), float(ap.estimate.vel[1])
    size = math.sqrt(vn * vn + ve * ve)
    if size <= 0.0:
        return (n, e)
    way = speed.stopping_distance(ap, size)
    return (n + vn / size * way, e + ve / size * way)


@law
def start(v):
    """A mode begins: limits from the parameters, forwards, no destination."""
    ap = v.autopilot
    drive = ap.modes.nav.drive
    stop(v)
    ap.modes.nav.time_scale = 1.0
    ap.modes.nav.speed_ne = 0.0
    drive.nudge_speed = 0.0
    drive.reversed = 0
    set_limits(ap)


@law
def stop(v):
    """Forget the destination."""
    ap = v.autopilot
    path.stop(ap.modes.nav)
    ap.modes.nav.drive.shaped = 0
    ap.modes.nav.drive.crosstrack = 0.0
    ap.modes.nav.drive.pivot_next = 0
    pivot.end(ap)


@law
def set_destination(v, n, e):
    """Drive to a point along a planned leg and stop there."""
    path.request_leg(v.autopilot, v.time_us, n, e, 0.0)


@law
def set_destinations(v, n, e, n2, e2):
    """Drive to a point along a planned leg, without a stop if a second point is to follow."""
    path.request_legs(v.autopilot, v.time_us, n, e, 0.0, n2, e2, 0.0)


@law
def set_destination_shaped(v, n, e):
    """Drive to a point after a shaped target and stop there."""
    ap = v.autopilot
    nav = ap.modes.nav
    if nav.drive.shaped == 0 or not is_active(ap, v.time_us):
        nav.target[0], nav.target[1] = stopping_point(ap)
    nav.drive.origin[0] = nav.target[0]
    nav.drive.origin[1] = nav.target[1]
    path.clear_legs(nav)
    nav.request_pending = 0
    nav.target[0] = n
    nav.target[1] = e
    nav.target[2] = 0.0
    nav.reached = 0
    nav.drive.shaped = 1
    pivot.check(ap, v.time_us, heading(ap), False)


@law
def begin_leg(ap, time_us):
    """The shell has planned a leg to ``nav.target``: turn towards it first if that is far."""
    nav = ap.modes.nav
    drive = nav.drive
    drive.origin[0] = nav.current.origin[0]
    drive.origin[1] = nav.current.origin[1]
    drive.shaped = 0
    if nav.fresh != 0:
        nav.fresh = 0
        for k in range(3):
            nav.vel[k] = 0.0
    if nav.joined == 0:
        pivot.end(ap)
        pivot.check(ap, time_us, heading(ap), drive.pivot_next != 0)
    drive.pivot_next = 0


@law
def set_speed(ap, wanted):
    """Speed limit [m/s] from now on, until a mode begins anew; 1, or 0 for one that is too slow or not a number."""
    if not wanted >= SLOWEST or wanted - wanted != 0.0:
        return 0
    ap.modes.nav.speed_ne = wanted
    return 1


@law
def set_nudge_speed(ap, wanted):
    """Speed limit [m/s] that the pilot asks for, whatever the direction; counts while it is above the other."""
    ap.modes.nav.drive.nudge_speed = wanted


@law
def set_reversed(ap, backward):
    """Drive backwards (1) or forwards (0); a skid-steered vehicle on its way turns round first."""
    drive = ap.modes.nav.drive
    if backward == drive.reversed:
        return
    drive.reversed = backward
    if has_destination(ap) and pivot.would_turn(ap, heading(ap) - float(ap.estimate.euler[2])):
        pivot.begin(ap)


@law
def is_active(ap, time_us):
    """Whether ``update`` ran a moment ago."""
    nav = ap.modes.nav
    return nav.active_us > 0 and time_us - nav.active_us < ACTIVE_US


@law
def has_destination(ap):
    """Whether there is anywhere to go."""
    nav = ap.modes.nav
    return nav.drive.shaped != 0 or nav.current.segments > 0 or nav.request_pending != 0


@law
def reached(ap):
    """1 at the destination; 0 while a new one is being planned."""
    nav = ap.modes.nav
    return 1 if nav.reached != 0 and nav.request_pending == 0 else 0


@law
def is_fast(ap):
    """Whether the destination is passed without a stop."""
    return ap.modes.nav.current.fast != 0


@law
def heading(ap):
    """Heading that takes the vehicle to the destination [rad], nose or tail first."""
    towards = path.bearing(ap)
    return wrap_pi(towards + math.pi) if ap.modes.nav.drive.reversed != 0 else towards


@law
def update(v):
    """One period."""
    ap = v.autopilot
    nav = ap.modes.nav
    drive = nav.drive
    known, forward = speed.forward_speed(v)
    if ap.arming.armed == 0 or ap.estimate.position_ok == 0 or known == 0 or not has_destination(ap):
        drive.desired_speed = speed.desired_speed_accel_limited(ap, 0.0)
        drive.desired_turn_rate = 0.0
        drive.desired_lat_accel = 0.0
        drive.crosstrack = 0.0
        return
    if not is_active(ap, v.time_us):
        drive.desired_speed = forward
        drive.desired_turn_rate = 0.0
        drive.desired_lat_accel = 0.0
    nav.active_us = v.time_us
    if nav.request_pending != 0:
        return
    _change_speed(v)
    if not position.is_active(ap):
        position.init(ap)
    if not pivot.is_active(ap):
        if drive.shaped != 0:
            _shape(ap)
        else:
            _advance(ap)
    drive.crosstrack = _crosstrack(ap)
    position.set_reversed(ap, int(drive.reversed))
    position.update(v)
    if pivot.is_active(ap):
        drive.desired_speed = speed.desired_speed_accel_limited(ap, 0.0)
        drive.desired_lat_accel = 0.0
        drive.desired_turn_rate = 0.0
        if drive.desired_speed == 0.0:
            drive.desired_turn_rate = pivot.turn_rate(ap, v.time_us, heading(ap))
        return
    drive.desired_speed = ap.control.position.desired_speed
    drive.desired_turn_rate = ap.control.position.desired_turn_rate
    drive.desired_lat_accel = ap.control.position.desired_lat_accel


@law
def _change_speed(v):
    """Follow a change of the speed limit; the shell plans the legs anew."""
    ap = v.autopilot
    drive = ap.modes.nav.drive
    if top_speed(ap) == ap.control.position.speed_max:
        return
    if drive.speed_us > 0 and v.time_us - drive.speed_us < SPEED_CHANGE_US:
        return
    drive.speed_us = v.time_us
    set_limits(ap)
    if drive.shaped == 0:
        emit_and_return(ap.events, v.time_us, LEG_ENDING, SPEED_REQUEST, 0.0)


@law
def _shape(ap):
    """Move a shaped target on; reached when it has arrived and the vehicle is near."""
    nav = ap.modes.nav
    c = ap.control.position
    position.input_pos(ap, float(nav.target[0]), float(nav.target[1]))
    n, e = float(nav.target[0] - c.pos_target[0]), float(nav.target[1] - c.pos_target[1])
    away = float(c.pos_error[0]) * float(c.pos_error[0]) + float(c.pos_error[1]) * float(c.pos_error[1])
    if n * n + e * e < ARRIVED * ARRIVED and away < ap.params.WP.RADIUS * ap.params.WP.RADIUS:
        nav.reached = 1


@law
def _advance(ap):
    """Move the target along the legs."""
    nav = ap.modes.nav
    path.scale_time(ap, ap.params.PSC.POS_P, accel_max(ap) / jerk_max(ap), DT)
    done = path.move(nav, nav.time_scale * DT, corner_radius(ap), lat_accel_max(ap))
    position.set_pos_vel_accel(ap, nav.pos[0], nav.pos[1], nav.vel[0], nav.vel[1], nav.acc[0], nav.acc[1])
    if done != 0 and nav.reached == 0:
        if nav.current.fast != 0 or path.distance(ap) <= ap.params.WP.RADIUS or _has_passed(ap):
            nav.reached = 1


@law
def _has_passed(ap):
    """Whether the vehicle is beyond the end of the leg."""
    nav = ap.modes.nav
    n, e = nav.target[0] - nav.drive.origin[0], nav.target[1] - nav.drive.origin[1]
    north, east = nav.target[0] - ap.estimate.pos[0], nav.target[1] - ap.estimate.pos[1]
    return n * north + e * east <= 0.0


@law
def _crosstrack(ap):
    """Distance from the line between the waypoints [m], negative to its right; from the point when they are one."""
    nav = ap.modes.nav
    n, e = nav.target[0] - nav.drive.origin[0], nav.target[1] - nav.drive.origin[1]
    length = math.hypot(n, e)
    if length < 1e-6:
        return path.distance(ap)
    north, east = ap.estimate.pos[0] - nav.drive.origin[0], ap.estimate.pos[1] - nav.drive.origin[1]
    return (north * e - east * n) / length
