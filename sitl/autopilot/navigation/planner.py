# SPDX-License-Identifier: BSD-3-Clause
"""Plans the legs of one vehicle and writes them to its record (shell: Python,
only when a leg begins or limits change).
"""

from __future__ import annotations

import math
from typing import Any

from ..control.altitude import stopping_point_d
from ..control.position import stopping_point_ne
from . import waypoint
from .leg import SHORTEST, Limits, axis_limits, plan, write
from .profile import clear, evaluate
from .state import LOITER_TURNS, TAKEOFF

GRAVITY = 9.80665
Point = tuple[float, float, float]
"""NED from the origin [m]."""


def jerk_limits(params: Any) -> tuple[float, float]:
    """(jerk [m/s^3], rise [s]) of legs.

    Leaning makes horizontal acceleration, so the lean rate limits jerk (ATC_RATE_*_MAX) and the lean rate's
    time constant (ATC_INPUT_TC) and acceleration (ATC_ACCEL_*_MAX) limit snap, half of which is used. Jerk
    that follows half a cosine needs pi/2 of jerk/snap to rise; the same time is taken here.
    """
    jerk = max(float(params.WPNAV_JERK), 0.1)
    lean_rate = math.radians(min(float(params.ATC_RATE_R_MAX), float(params.ATC_RATE_P_MAX)))
    if lean_rate > 0.0:
        jerk = min(jerk, lean_rate * GRAVITY)
    snap = 0.5 * math.pi * jerk / max(float(params.ATC_INPUT_TC), 0.1)
    lean_acceleration = math.radians(0.01 * min(float(params.ATC_ACCEL_R_MAX), float(params.ATC_ACCEL_P_MAX)))
    if lean_acceleration > 0.0:
        snap = min(snap, lean_acceleration * GRAVITY)
    return jerk, 0.5 * math.pi * jerk / (0.5 * snap)


def limits(ap: Any, direction: Point) -> Limits:
    """Limits along a straight leg in ``direction`` (unit vector NED)."""
    vertical = max(waypoint.CM * float(ap.params.WPNAV_ACCEL_Z), 0.1)
    horizontal = max(waypoint.CM * float(ap.params.WPNAV_ACCEL), 0.1)
    jerk, rise = jerk_limits(ap.params)
    return Limits(
        axis_limits(direction, waypoint.speed_ne(ap), waypoint.speed_up(ap), waypoint.speed_down(ap)),
        axis_limits(direction, horizontal, vertical, vertical),
        jerk,
        rise,
    )


def plan_leg(ap: Any, leg: Any, origin: Point, target: Point) -> None:
    """Plan a leg from rest to rest into a leg record."""
    length = math.dist(origin, target)
    if length < SHORTEST:
        write(leg, plan(0.0, Limits(1.0, 1.0, 1.0)), target, (0.0, 0.0, 0.0), 0.0)
        return
    direction = (
        (target[0] - origin[0]) / length,
        (target[1] - origin[1]) / length,
        (target[2] - origin[2]) / length,
    )
    wanted = limits(ap, direction)
    write(leg, plan(length, wanted), origin, direction, length)
    leg.top_speed = wanted.speed


def end(leg: Any) -> Point:
    """Where a leg ends."""
    return tuple(float(leg.origin[k] + leg.unit[k] * leg.length) for k in range(3))  # type: ignore[return-value]


def stopping_point(ap: Any) -> Point:
    """Where the vehicle would come to rest."""
    waypoint.set_limits(ap)
    n, e = stopping_point_ne(ap)
    return (float(n), float(e), float(stopping_point_d(ap)))


def is_active(ap: Any, time_us: int) -> bool:
    """Whether a path was followed a moment ago."""
    nav = ap.modes.nav
    return bool(nav.active_us > 0 and time_us - nav.active_us <= waypoint.ACTIVE_US)


def origin_of_next(ap: Any, time_us: int) -> tuple[Point, bool]:
    """(where the next leg starts, whether it continues the one under way)."""
    nav = ap.modes.nav
    circling = nav.command_kind == LOITER_TURNS and nav.circle_running != 0
    if is_active(ap, time_us) and nav.reached != 0 and nav.current.segments > 0 and not circling:
        return end(nav.current), True
    n, e, d = stopping_point(ap)
    if nav.command_kind == TAKEOFF and nav.completed != 0:
        d = float(nav.target[2])
    return (n, e, d), False


def begin(ap: Any, time_us: int, target: Point) -> None:
    """Make the leg to ``target`` the current one.

    It continues the leg just flown when that was reached (and takes over the leg planned ahead, which may be
    under way already), and else starts at the point where the vehicle would come to rest.
    """
    nav = ap.modes.nav
    origin, continues = origin_of_next(ap, time_us)
    planned = continues and nav.current.fast != 0 and nav.next.segments > 0
    if planned and math.dist(end(nav.next), target) < 1e-3:
        nav.previous = nav.current
        nav.current = nav.next
        nav.current.fast = 0
    else:
        if planned and nav.next.started != 0:  # the mission changed in the middle of a turn
            origin, continues = stopping_point(ap), False
        clear(nav.previous)
        plan_leg(ap, nav.current, origin, target)
    clear(nav.next)
    nav.fresh = 0 if continues else 1
    nav.reached = 0
    for k in range(3):
        nav.target[k] = target[k]


def look_ahead(ap: Any, target: Point | None) -> None:
    """Plan the leg after the current one, to be joined without a stop; None:
    stop at the end of the current one.
    """
    nav = ap.modes.nav
    if nav.next.started != 0:
        return
    clear(nav.next)
    nav.current.fast = 0
    if target is None or math.dist(end(nav.current), target) < SHORTEST or nav.current.length < SHORTEST:
        return
    plan_leg(ap, nav.next, end(nav.current), target)
    nav.current.fast = 1


def change_speed(ap: Any) -> None:
    """Plan the legs anew after a limit changed; a leg under way goes on from its speed and acceleration."""
    nav = ap.modes.nav
    if nav.current.segments > 0 and nav.next.started == 0:
        _replan(ap, nav.current)
    if nav.next.segments > 0:
        _replan(ap, nav.next)


def _replan(ap: Any, leg: Any) -> None:
    target, fast, started = end(leg), int(leg.fast), int(leg.started)
    p, v, a = evaluate(leg, float(leg.elapsed))
    left = float(leg.length) - p
    if started == 0:
        plan_leg(ap, leg, tuple(float(x) for x in leg.origin), target)  # type: ignore[arg-type]
    elif left > SHORTEST and leg.elapsed < leg.turn_out:
        direction: Point = tuple(float(x) for x in leg.unit)  # type: ignore[assignment]
        here: Point = tuple(float(leg.origin[k] + direction[k] * p) for k in range(3))  # type: ignore[assignment]
        wanted = limits(ap, direction)
        write(leg, plan(left, wanted, v, a), here, direction, left)
        leg.top_speed = wanted.speed
    leg.fast, leg.started = fast, started


def serve(ap: Any, time_us: int) -> None:
    """Give the legs that the core asked for (``waypoint.request_leg``, ``request_legs``), if any,
    and start them.
    """
    nav = ap.modes.nav
    if nav.request_pending == 0:
        return
    begin(ap, time_us, tuple(float(x) for x in nav.request))  # type: ignore[arg-type]
    if nav.request_pending == 2:
        look_ahead(ap, tuple(float(x) for x in nav.request_next))  # type: ignore[arg-type]
    nav.request_pending = 0
    waypoint.start(ap, time_us)
