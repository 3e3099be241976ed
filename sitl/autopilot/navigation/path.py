# SPDX-License-Identifier: BSD-3-Clause
"""The path under way: a target that moves along planned legs and rounds corners.

What every firmware shares; ``waypoint`` of each adds its limits and controllers. The shell plans the legs
(``planner``) when a mission begins a command or a mode asks by ``request_leg``.

A corner is rounded as ArduPilot does: the next leg starts from rest while the current one still brakes, and
the two motions are added. It starts as early as the middle of the turn stays within a radius of the corner,
slower than both legs are, and within an acceleration (https://ardupilot.org/copter/docs/common-scurves.html).
"""

from __future__ import annotations

import math

from ...core.kernels import law
from ..events import LEG_ENDING, emit_and_return
from .profile import clear, evaluate, finished, remaining, step
from .state import LEG_REQUEST


@law
def clear_legs(nav):
    """Forget all legs."""
    clear(nav.previous)
    clear(nav.current)
    clear(nav.next)


@law
def stop(nav):
    """Forget all legs and what was asked for."""
    clear_legs(nav)
    nav.request_pending = 0
    nav.active_us = 0
    nav.reached = 0


@law
def request_leg(ap, time_us, n, e, d):
    """Ask the shell for a leg to a point, NED [m]: it is there, begun, on the next tick, and ``request_pending`` 0."""
    nav = ap.modes.nav
    nav.request[0] = n
    nav.request[1] = e
    nav.request[2] = d
    nav.request_pending = 1
    emit_and_return(ap.events, time_us, LEG_ENDING, LEG_REQUEST, 0.0)


@law
def request_legs(ap, time_us, n, e, d, n2, e2, d2):
    """Ask for a leg to a point and one from there to a second point, joined without a stop, NED [m].

    ``request_leg`` to the second point when the first is reached takes the second leg over.
    """
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
def scale_time(ap, gain, constant, dt):
    """Path time runs as fast as the vehicle can follow.

    That is its speed along the path plus what closes the gap (``gain`` of the position loop [1/s]), over the
    target's speed. 5 % more is allowed; the rate follows with the time ``constant`` [s], at least ``dt``: ArduPilot
    takes acceleration over jerk.
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
        wanted = 0.05 + (flown - gain * lag) / (speed * speed)
        wanted = min(max(wanted, 0.0), 1.0)
    nav.time_scale += (wanted - nav.time_scale) * dt / max(constant, dt)


@law
def move(nav, dt, radius, corner):
    """Move path time on by ``dt`` and sum the legs into ``nav.pos``, ``vel``, ``acc``; 1 when the current leg is over.

    Corners stay within ``radius`` [m] of their waypoint and ``corner`` [m/s^2].
    """
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
        if nav.next.started == 0 and _may_turn(nav, v, radius, corner) != 0:
            nav.next.started = 1
        if nav.next.started != 0:
            step(nav.next, dt)
            p, v, a = evaluate(nav.next, nav.next.elapsed)
            _add(nav, nav.next, p, v, a)
            if nav.next.elapsed >= remaining(nav.current):
                done = 1
    return done


@law
def _add(nav, leg, p, v, a):
    """Add a motion along a leg to the target."""
    for k in range(3):
        nav.pos[k] += leg.unit[k] * p
        nav.vel[k] += leg.unit[k] * v
        nav.acc[k] += leg.unit[k] * a


@law
def _may_turn(nav, speed, radius, corner):
    """1 when the next leg may start: the middle of the turn is close to the waypoint, slow and gentle enough."""
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
    slowest = min(speed, met)
    if away < radius * radius and turn_speed <= slowest * slowest + 1e-9 and turn_acc < corner * corner:
        return 1
    return 0
