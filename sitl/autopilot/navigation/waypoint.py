# SPDX-License-Identifier: BSD-3-Clause
"""Follows planned legs: the target moves along the path, rounds corners, and waits for a vehicle that lags.

For the modes::

    start(ap, time_us)              begin at the planned legs (AUTO: when a command with legs was given)
    advance(ap, time_us) -> int     one tick: moves the target, hands it to the controllers; 1 when reached
    request_leg(ap, time_us, n, e, d)   ask the shell for a leg from here to a point (RTL); it is there on the
    next tick,
                                    started, with ``nav.request_pending`` back to 0
    request_legs(ap, time_us, n, e, d, n2, e2, d2)   the same with a second leg that is joined without a stop;
                                    ``request_leg`` to the second point when the first is reached takes it
                                    over
    stop(ap)                        forget all legs
    distance(ap), bearing(ap)       to the destination [m], [rad]

After ``advance``, ``nav.pos``, ``nav.vel``, ``nav.acc`` hold the target.

A corner is rounded as ArduPilot does: the next leg starts from rest while the current one still brakes, and
the two motions are added. It starts as early as the middle of the turn stays within WPNAV_RADIUS of the
corner, slower than both legs are, and within WPNAV_ACCEL_C
(https://ardupilot.org/copter/docs/common-scurves.html).
"""

from __future__ import annotations

import math

from ...core.kernels import law
from ..control.altitude import init_d_stopping_point, set_max_speed_accel_d, set_pos_vel_accel_d
from ..control.position import init_ne_stopping_point, set_max_speed_accel_ne, set_pos_vel_accel_ne
from ..events import LEG_ENDING, emit_and_return
from .profile import clear, evaluate, finished, remaining, step
from .state import LEG_REQUEST

DT = 0.0025
ACTIVE_US = 200000
"""A path followed within this time is still the one under way."""
CM = 0.01


@law
def speed_ne(ap):
    """Horizontal speed limit along legs [m/s]."""
    nav = ap.modes.nav
    return nav.speed_ne if nav.speed_ne > 0.0 else max(CM * ap.params.WPNAV_SPEED, 0.1)


@law
def speed_up(ap):
    """Climb speed limit along legs [m/s]."""
    nav = ap.modes.nav
    return nav.speed_up if nav.speed_up > 0.0 else max(CM * ap.params.WPNAV_SPEED_UP, 0.1)


@law
def speed_down(ap):
    """Descent speed limit along legs [m/s]."""
    nav = ap.modes.nav
    return nav.speed_down if nav.speed_down > 0.0 else max(CM * ap.params.WPNAV_SPEED_DN, 0.1)


@law
def set_limits(ap):
    """Give the position controllers the limits of legs."""
    set_max_speed_accel_ne(ap, speed_ne(ap), CM * ap.params.WPNAV_ACCEL)
    set_max_speed_accel_d(ap, speed_down(ap), speed_up(ap), CM * ap.params.WPNAV_ACCEL_Z)


@law
def start(ap, time_us):
    """Begin at the planned legs.

    A leg that continues the one just flown keeps the controllers as they are.
    """
    nav = ap.modes.nav
    set_limits(ap)
    if nav.fresh != 0:
        nav.fresh = 0
        init_ne_stopping_point(ap)
        init_d_stopping_point(ap)
        nav.time_scale = 1.0
        nav.pause_scale = 1.0
        nav.pause_rate = 0.0
        for k in range(3):
            nav.pos[k] = nav.current.origin[k]
            nav.vel[k] = 0.0
            nav.acc[k] = 0.0
    nav.active_us = time_us


@law
def stop(ap):
    """Forget all legs."""
    nav = ap.modes.nav
    clear(nav.previous)
    clear(nav.current)
    clear(nav.next)
    nav.request_pending = 0
    nav.active_us = 0
    nav.reached = 0
    nav.paused = 0


@law
def request_leg(ap, time_us, n, e, d):
    """Ask the shell for a leg to a point, NED [m]; until it is there,
    ``advance`` returns 0 and moves nothing.
    """
    nav = ap.modes.nav
    nav.request[0] = n
    nav.request[1] = e
    nav.request[2] = d
    nav.request_pending = 1
    emit_and_return(ap.events, time_us, LEG_ENDING, LEG_REQUEST, 0.0)


@law
def request_legs(ap, time_us, n, e, d, n2, e2, d2):
    """Ask for a leg to a point and one from there to a second point, NED [m]."""
    nav = ap.modes.nav
    request_leg(ap, time_us, n, e, d)
    nav.request_next[0] = n2
    nav.request_next[1] = e2
    nav.request_next[2] = d2
    nav.request_pending = 2


@law
def distance(ap):
    """Horizontal distance from the vehicle to the destination [m]."""
    nav = ap.modes.nav
    return math.hypot(nav.target[0] - ap.estimate.pos[0], nav.target[1] - ap.estimate.pos[1])


@law
def bearing(ap):
    """Bearing from the vehicle to the destination [rad]."""
    nav = ap.modes.nav
    return math.atan2(nav.target[1] - ap.estimate.pos[1], nav.target[0] - ap.estimate.pos[0])


@law
def advance(ap, time_us):
    """One tick along the legs; 1 when the destination is reached (a corner: when the next leg takes over)."""
    nav = ap.modes.nav
    if nav.request_pending != 0 or nav.current.segments < 1:
        return 0
    nav.active_us = time_us
    _scale_time(ap)
    _scale_pause(ap)
    done = _move(ap, nav.time_scale * nav.pause_scale * DT)
    set_pos_vel_accel_ne(ap, nav.pos[0], nav.pos[1], nav.vel[0], nav.vel[1], nav.acc[0], nav.acc[1])
    set_pos_vel_accel_d(ap, nav.pos[2], nav.vel[2], nav.acc[2])
    if done != 0 and nav.reached == 0:
        if nav.current.fast != 0 or _near_end(ap) != 0:
            nav.reached = 1
    return int(nav.reached)


@law
def _scale_time(ap):
    """Path time runs as fast as the vehicle can follow.

    That is its speed along the path plus what closes the gap, over the target's speed.
    5 % more is allowed, and the rate follows with a time constant of acceleration over jerk, as ArduPilot's.
    """
    nav = ap.modes.nav
    speed = math.sqrt(nav.vel[0] * nav.vel[0] + nav.vel[1] * nav.vel[1] + nav.vel[2] * nav.vel[2])
    wanted = 1.0
    if speed > 1e-6:
        lag = 0.0
        flown = 0.0
        for k in range(3):
            lag += (nav.pos[k] - ap.estimate.pos[k]) * nav.vel[k]
            flown += ap.estimate.vel[k] * nav.vel[k]
        wanted = 0.05 + (flown - ap.params.PSC_POSXY_P * lag) / (speed * speed)
        wanted = min(max(wanted, 0.0), 1.0)
    constant = max(CM * ap.params.WPNAV_ACCEL / max(ap.params.WPNAV_JERK, 0.1), DT)
    nav.time_scale += (wanted - nav.time_scale) * DT / constant


@law
def _scale_pause(ap):
    """Path time stops when paused and runs again after,
    with WPNAV_ACCEL and PSC_JERK_XY felt at full speed.
    """
    nav = ap.modes.nav
    wanted = 0.0 if nav.paused != 0 else 1.0
    error = wanted - nav.pause_scale
    if error == 0.0 and nav.pause_rate == 0.0:
        return
    top = speed_ne(ap)
    rate = CM * ap.params.WPNAV_ACCEL / top
    change = max(ap.params.PSC_JERK_XY, 0.1) / top * DT
    aim = min(rate, math.sqrt(2.0 * change / DT * abs(error)))
    aim = aim if error > 0.0 else -aim
    nav.pause_rate += min(max(aim - nav.pause_rate, -change), change)
    nav.pause_scale += nav.pause_rate * DT
    if abs(wanted - nav.pause_scale) < 1e-4 or (wanted - nav.pause_scale) * error < 0.0:
        nav.pause_scale = wanted
        nav.pause_rate = 0.0


@law
def _move(ap, dt):
    """Move path time on by ``dt`` and sum the legs into the target; 1 when the current leg is over."""
    nav = ap.modes.nav
    for k in range(3):
        nav.pos[k] = nav.current.origin[k]
        nav.vel[k] = 0.0
        nav.acc[k] = 0.0
    if nav.previous.segments > 0:
        step(nav.previous, dt)
        p, v, a = evaluate(nav.previous, nav.previous.elapsed)
        _add(nav, nav.previous, p - nav.previous.length, v, a)
        if finished(nav.previous):
            nav.previous.segments = 0
    nav.current.started = 1
    step(nav.current, dt)
    p, v, a = evaluate(nav.current, nav.current.elapsed)
    _add(nav, nav.current, p, v, a)
    done = 1 if finished(nav.current) else 0
    if nav.current.fast != 0 and nav.next.segments > 0:
        if nav.next.started == 0 and _may_turn(ap, v) != 0:
            nav.next.started = 1
        if nav.next.started != 0:
            step(nav.next, dt)
            p, v, a = evaluate(nav.next, nav.next.elapsed)
            _add(nav, nav.next, p, v, a)
            if nav.next.elapsed >= remaining(nav.current):
                done = 1
    for k in range(3):
        nav.acc[k] = nav.acc[k] * nav.pause_scale * nav.pause_scale + nav.vel[k] * nav.pause_rate
        nav.vel[k] = nav.vel[k] * nav.pause_scale
    return done


@law
def _add(nav, leg, p, v, a):
    """Add a motion along a leg to the target."""
    for k in range(3):
        nav.pos[k] += leg.unit[k] * p
        nav.vel[k] += leg.unit[k] * v
        nav.acc[k] += leg.unit[k] * a


@law
def _may_turn(ap, speed):
    """1 when the next leg may start: the middle of the turn is close to the corner,
    slow and gentle enough.
    """
    nav = ap.modes.nav
    left = remaining(nav.current)
    elapsed = nav.current.elapsed
    if elapsed < nav.current.turn_out - nav.next.turn_in or elapsed < 0.5 * nav.current.duration:
        return 0
    if left > 0.5 * nav.next.duration:
        return 0
    p, v, a = evaluate(nav.current, elapsed + 0.5 * left)
    p -= nav.current.length
    q, w, b = evaluate(nav.next, 0.5 * left)
    _, met, _ = evaluate(nav.next, left)
    away = 0.0
    turn_speed = 0.0
    turn_acc = 0.0
    for k in range(3):
        x = nav.current.unit[k] * p + nav.next.unit[k] * q
        away += x * x
        if k < 2:
            x = nav.current.unit[k] * v + nav.next.unit[k] * w
            turn_speed += x * x
            x = nav.current.unit[k] * a + nav.next.unit[k] * b
            turn_acc += x * x
    radius = CM * ap.params.WPNAV_RADIUS
    slowest = min(speed, met)
    corner = CM * (ap.params.WPNAV_ACCEL_C if ap.params.WPNAV_ACCEL_C > 0.0 else 2.0 * ap.params.WPNAV_ACCEL)
    if away < radius * radius and turn_speed <= slowest * slowest + 1e-9 and turn_acc < corner * corner:
        return 1
    return 0


@law
def _near_end(ap):
    """1 when the vehicle is within WPNAV_RADIUS of the end of the current leg."""
    nav = ap.modes.nav
    away = 0.0
    for k in range(3):
        x = nav.current.origin[k] + nav.current.unit[k] * nav.current.length - ap.estimate.pos[k]
        away += x * x
    radius = CM * ap.params.WPNAV_RADIUS
    return 1 if away <= radius * radius else 0
