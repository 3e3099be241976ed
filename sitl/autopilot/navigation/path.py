# SPDX-License-Identifier: BSD-3-Clause
"""The path under way: a target that moves along planned legs and rounds corners.

What every firmware shares; ``waypoint`` of each adds its limits and controllers. The shell plans the legs
(``planner``) when a mission begins a command or a mode asks by ``request_leg``.

A corner is rounded as ArduPilot does: the next leg starts from rest while the current one still brakes, and
the two motions are added. It starts as early as the middle of the turn stays within a radius of the corner,
slower than both legs are, and within an acceleration (https://ardupilot.org/copter/docs/common-scurves.html).
"""

from __future__ import annotations

from ...core.algebra import dot, dot2, horizontal, norm
from ...core.elementary import atan2, hypot
from ...core.kernels import law
from ...core.vectors import Vec3
from ..control.shaping import Motion
from ..events import Events, emit_and_return
from ..fence.checks import active
from ..fence.state import AREAS, FenceState
from ..params.avoidance import PathPlanning
from ..params.fence_parameters import Fence
from .leg_motion import clear, evaluate, finished, remaining, step
from .state import DETOUR_REQUEST, GO_ON, LEG_ENDING, LEG_REQUEST, STRAIGHT, Detour, Leg, Nav

DIJKSTRA = (2.0, 3.0)
"""OA_TYPE"""
AGAIN_US = 1_000_000
"""Where there is no path, one is looked for again so often."""


@law
def clear_legs(nav: Nav) -> None:
    """Forget all legs."""
    clear(nav.previous)
    clear(nav.current)
    clear(nav.next)
    nav.detour.left = nav.detour.blocked_us = 0


@law
def stop(nav: Nav) -> None:
    """Forget all legs and what was asked for."""
    clear_legs(nav)
    nav.request_pending = 0
    nav.active_us = 0
    nav.reached = False
    nav.detour.bend = STRAIGHT


@law
def request_leg(nav: Nav, events: Events, time_us: int, target: Vec3) -> None:
    """Ask the shell for a leg to a point, NED [m]: it is there, begun, on the next tick, and ``request_pending`` 0."""
    nav.request = target
    nav.request_pending = 1
    emit_and_return(events, time_us, LEG_ENDING, LEG_REQUEST, 0.0)


@law
def request_legs(nav: Nav, events: Events, time_us: int, target: Vec3, following: Vec3) -> None:
    """Ask for a leg to a point and one from there to the following point, joined without a stop, NED [m].

    ``request_leg`` to the following point when the first is reached takes the second leg over.
    """
    request_leg(nav, events, time_us, target)
    nav.request_next = following
    nav.request_pending = 2


@law
def set_position(detour: Detour, k: int, position: Vec3) -> None:
    """Position ``k`` of a detour, NED [m]."""
    rows = detour.waypoints
    rows[3 * k], rows[3 * k + 1], rows[3 * k + 2] = position.x, position.y, position.z


@law
def arrive(nav: Nav) -> None:
    """The leg under way is at its end: the destination, or a position of a detour, after which the shell
    plans the next leg."""
    if nav.detour.left == 0:
        nav.reached = True
    elif nav.detour.blocked_us == 0:
        nav.request_pending = GO_ON


@law
def areas_of(fence: FenceState, oa: PathPlanning, params: Fence) -> int:
    """A number for the areas that paths lead around now (OA_TYPE); 0: none."""
    if oa.TYPE not in DIJKSTRA or (active(fence, params) & AREAS) == 0:
        return 0
    return fence.shapes << 32 | fence.corners


@law
def watch_detour(nav: Nav, areas: int, events: Events, time_us: int) -> None:
    """Ten times a second: where there was no path, look again each second; where the ``areas`` (``areas_of``) are
    others than before, plan the path anew."""
    if nav.active_us == 0 or time_us - nav.active_us >= AGAIN_US:
        return
    blocked = nav.detour.blocked_us
    if (blocked > 0 and time_us - blocked >= AGAIN_US) or (areas != nav.detour.areas and not nav.next.started):
        emit_and_return(events, time_us, LEG_ENDING, DETOUR_REQUEST, 0.0)


@law
def distance(nav: Nav, pos: Vec3) -> float:
    """Horizontal distance from ``pos`` to the destination, both NED [m]."""
    return hypot(nav.target.x - pos.x, nav.target.y - pos.y)


@law
def bearing(nav: Nav, pos: Vec3) -> float:
    """Bearing from ``pos``, NED [m], to the destination [rad]."""
    return atan2(nav.target.y - pos.y, nav.target.x - pos.x)


@law
def feasible_time_scale(nav: Nav, pos: Vec3, vel: Vec3, pos_p: float) -> float:
    """How fast path time may run, 0 .. 1, for a vehicle at ``pos`` [m] with ``vel`` [m/s], NED.

    That is the vehicle's speed along the path plus what closes the gap (``pos_p``: gain of the position loop [1/s]),
    over the target's speed. 5 % more is allowed.
    """
    speed = norm(nav.vel)
    if not speed > 1e-6:
        return 1.0
    lag = dot(nav.pos - pos, nav.vel)
    flown = dot(vel, nav.vel)
    return min(max(0.05 + (flown - pos_p * lag) / (speed * speed), 0.0), 1.0)


@law
def scale_time(nav: Nav, feasible: float, time_constant: float, dt: float) -> None:
    """Path time runs as fast as is ``feasible``; its rate follows with a time constant [s], at least ``dt``.

    ArduPilot takes acceleration over jerk.
    """
    nav.time_scale += (feasible - nav.time_scale) * dt / max(time_constant, dt)


@law
def move(nav: Nav, dt: float, radius: float, accel_max: float) -> bool:
    """Move path time on by ``dt`` and sum the legs into ``nav.pos``, ``vel``, ``acc``; whether the current one is over.

    Corners stay within ``radius`` [m] of their waypoint and ``accel_max`` [m/s^2].
    """
    nav.pos = nav.current.origin
    nav.vel = Vec3(0.0, 0.0, 0.0)
    nav.acc = Vec3(0.0, 0.0, 0.0)
    if nav.previous.segments > 0:
        step(nav.previous, dt)
        along = evaluate(nav.previous, nav.previous.elapsed)
        add_motion(nav, nav.previous.unit, Motion(along.pos - nav.previous.length, along.vel, along.acc))
        if finished(nav.previous):
            nav.previous.segments = 0
    nav.current.started = True
    step(nav.current, dt)
    along = evaluate(nav.current, nav.current.elapsed)
    add_motion(nav, nav.current.unit, along)
    done = finished(nav.current)
    if nav.current.fast and nav.next.segments > 0:
        if not nav.next.started:
            nav.next.started = may_turn(nav.current, nav.next, along.vel, radius, accel_max)
        if nav.next.started:
            step(nav.next, dt)
            add_motion(nav, nav.next.unit, evaluate(nav.next, nav.next.elapsed))
            done = done or nav.next.elapsed >= remaining(nav.current)
    return done


@law
def add_motion(nav: Nav, direction: Vec3, along: Motion) -> None:
    """Add a motion along a leg to the target's."""
    nav.pos += direction * along.pos
    nav.vel += direction * along.vel
    nav.acc += direction * along.acc


@law
def may_turn(current: Leg, following: Leg, speed: float, radius: float, accel_max: float) -> bool:
    """Whether the following leg may start at ``speed`` [m/s] along the current one.

    The middle of the turn must be within ``radius`` [m] of the waypoint, slow, and within ``accel_max`` [m/s^2].
    """
    left = remaining(current)
    elapsed = current.elapsed
    if elapsed < current.turn_out - following.turn_in or elapsed < 0.5 * current.duration:
        return False
    if left > 0.5 * following.duration:
        return False
    before = evaluate(current, elapsed + 0.5 * left)
    after = evaluate(following, 0.5 * left)
    away = current.unit * (before.pos - current.length) + following.unit * after.pos
    vel = horizontal(current.unit * before.vel + following.unit * after.vel)
    acc = horizontal(current.unit * before.acc + following.unit * after.acc)
    slowest = min(speed, evaluate(following, left).vel)
    near = dot(away, away) < radius * radius
    return near and dot2(vel, vel) <= slowest * slowest + 1e-9 and dot2(acc, acc) < accel_max * accel_max
