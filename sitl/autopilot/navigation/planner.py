# SPDX-License-Identifier: BSD-3-Clause
"""Plans the legs of one vehicle and writes them to its record (shell: Python, when a leg begins or limits change)."""

from __future__ import annotations

import math
from abc import ABC, abstractmethod
from typing import Any, Generic, TypeVar

from ...core.algebra import ZERO, horizontal, vector_at, with_down
from ...core.geodesy import location_e7
from ...core.mavlink import MavSeverity
from ...core.sums import separation
from ...core.vectors import Vec3
from ..avoidance.shortest_path import a_star
from ..events import Event, Row, emit
from ..state import Autopilot
from .leg import SHORTEST, LegError, Limits, bounded, plan, write
from .leg_motion import clear, evaluate
from .path import areas_of, set_position
from .state import DETOUR, ENDED, GO_ON, STRAIGHT, Leg

A = TypeVar("A", bound=Autopilot)
REPORT_INTERVAL_US = 5_000_000
"""That there is no path is said no more often."""


def _rows(v: Any, is_closed: bool) -> list[Row]:
    """OADJ"""
    nav, est = v.autopilot.modes.nav, v.autopilot.estimate
    detour = nav.detour
    goal = vector_at(detour.waypoints, 0) if detour.left > 0 else nav.target
    state = (
        (3, 2, 0, 0) if is_closed else (2, 0, 1, min(detour.left + 2, 255))
    )  # an error: no path; found: so many points
    locations = (location_e7(est.origin_lat, est.origin_lon, position.x, position.y) for position in (goal, nav.target))
    return [("OADJ", (*state, *next(locations), *next(locations)))]


NO_PATH = Event(60, MavSeverity.CRITICAL, "Dijkstra: could not find path", log=lambda v, a, b: _rows(v, True))
"""There is no path around the areas of the fence."""
PATH_PLANNED = Event(75, log=lambda v, a, b: _rows(v, False))
"""The path around them has turns."""


def end(leg: Leg) -> Vec3:
    """Where a leg ends, NED [m]."""
    return leg.origin + leg.unit * leg.length


class Planner(ABC, Generic[A]):
    """Plans the legs of a firmware's vehicles. Points are NED metres from the EKF origin."""

    active_us: int
    """A path followed within this time [us] is still the one under way."""

    @abstractmethod
    def limits(self, ap: A, direction: Vec3) -> Limits:
        """Limits along a straight leg in ``direction`` (unit vector NED)."""

    @abstractmethod
    def stopping_point(self, ap: A) -> Vec3:
        """Where the vehicle would come to rest, NED from the origin [m]."""

    @abstractmethod
    def start(self, ap: A, time_us: int) -> None:
        """Begin at the planned legs, as a mode does for those of a mission."""

    def may_join(self, ap: A, corner: Vec3, target: Vec3) -> bool:
        """Whether the vehicle goes round this corner (NED [m]) without a stop."""
        return True

    def plan_leg(self, ap: A, leg: Leg, origin: Vec3, target: Vec3) -> None:
        """Plan a leg from rest to rest (NED [m]) into a leg record.

        An origin that is not finite (parameters can spoil the estimate that it comes from) has no line to the target:
        the leg is the target alone.

        Raises:
            LegError: the target is not finite.
        """
        length = separation(origin, target)
        if length < SHORTEST or (not all(map(math.isfinite, origin)) and all(map(math.isfinite, target))):
            write(leg, plan(0.0, Limits(1.0, 1.0, 1.0)), target, ZERO, 0.0)
            return
        direction = (target - origin) / length
        wanted = bounded(self.limits(ap, direction))
        write(leg, plan(length, wanted), origin, direction, length)
        leg.top_speed = wanted.speed

    def is_active(self, ap: A, time_us: int) -> bool:
        """Whether a path was followed a moment ago."""
        nav = ap.modes.nav
        return nav.active_us > 0 and time_us - nav.active_us <= self.active_us

    def continues(self, ap: A, time_us: int) -> bool:
        """Whether the next leg starts at the end of the one under way."""
        nav = ap.modes.nav
        return self.is_active(ap, time_us) and nav.reached and nav.current.segments > 0

    def origin_of_next(self, ap: A, time_us: int) -> tuple[Vec3, bool]:
        """(where the next leg starts, NED [m], whether it continues the one under way)."""
        if self.continues(ap, time_us):
            return end(ap.modes.nav.current), True
        return self.stopping_point(ap), False

    def begin(self, ap: A, time_us: int, target: Vec3) -> None:
        """Set off to ``target`` (NED [m]), around what is in the way (OA_TYPE); where there is no path it stops."""
        nav = ap.modes.nav
        detour = nav.detour
        detour.left = detour.blocked_us = 0
        detour.bend = STRAIGHT
        detour.areas = areas_of(ap.fence, ap.params.OA, ap.params.FENCE)
        if detour.areas == 0:
            self.begin_leg(ap, time_us, target)
            return
        origin, _ = self.origin_of_next(ap, time_us)
        path = a_star(ap.fence, horizontal(origin), horizontal(target), ap.params.OA.MARGIN_MAX)
        if path is None or len(path) > DETOUR:
            self.begin_leg(ap, time_us, self.stopping_point(ap))
            set_position(detour, 0, target)
            detour.left, detour.blocked_us = 1, time_us
            if time_us - detour.reported_us >= REPORT_INTERVAL_US or detour.reported_us == 0:
                detour.reported_us = time_us
                emit(ap.events, time_us, NO_PATH, 0.0, 0.0)
            return
        positions = [with_down(position, target.z) for position in path[:-1]] + [target]
        for k, position in enumerate(reversed(positions)):
            set_position(detour, k, position)
        detour.left = len(positions)
        self._go_to_next(ap, time_us)
        if len(positions) > 1:
            emit(ap.events, time_us, PATH_PLANNED, 0.0, 0.0)

    def go_on(self, ap: A, time_us: int) -> None:
        """A position of a detour is reached: on to the next one. Where there was no path, or the areas are others than
        before, a path to the destination is planned anew."""
        nav = ap.modes.nav
        detour = nav.detour
        has_bent = detour.bend == ENDED
        detour.bend = STRAIGHT if has_bent else detour.bend
        is_old = has_bent or detour.blocked_us != 0 or detour.areas != areas_of(ap.fence, ap.params.OA, ap.params.FENCE)
        if is_old and not nav.reached and nav.current.segments > 0:
            target = vector_at(detour.waypoints, 0) if detour.left > 0 else end(nav.current)
            self.begin(ap, time_us, target)
        elif nav.request_pending == GO_ON and detour.left > 0:
            nav.reached = True
            self._go_to_next(ap, time_us)
        else:
            detour.areas = areas_of(ap.fence, ap.params.OA, ap.params.FENCE)
            return
        nav.request_pending = 0
        self.start(ap, time_us)

    def _go_to_next(self, ap: A, time_us: int) -> None:
        detour = ap.modes.nav.detour
        detour.left -= 1
        self.begin_leg(ap, time_us, vector_at(detour.waypoints, 3 * detour.left))
        if detour.left > 0:
            self.look_ahead(ap, None)

    def begin_leg(self, ap: A, time_us: int, target: Vec3) -> None:
        """Make the leg to ``target`` (NED [m]) the current one.

        It continues the leg just travelled when that was reached (and takes over the leg planned ahead, which may be
        under way already), and else starts at the point where the vehicle would come to rest.
        """
        nav = ap.modes.nav
        origin, continues = self.origin_of_next(ap, time_us)
        planned = continues and nav.current.fast and nav.next.segments > 0
        nav.joined = False
        if planned and separation(end(nav.next), target) < 1e-3:
            nav.previous = nav.current
            nav.current = nav.next
            nav.current.fast = False
            nav.joined = True
        else:
            if planned and nav.next.started:  # the mission changed in the middle of a turn
                origin, continues = self.stopping_point(ap), False
            clear(nav.previous)
            self.plan_leg(ap, nav.current, origin, target)
        clear(nav.next)
        nav.fresh = not continues
        nav.reached = False
        nav.target = target

    def look_ahead(self, ap: A, target: Vec3 | None) -> None:
        """Plan the leg after the current one, to be joined without a stop; None: stop at the end of the current one.

        On a detour it is the leg to the detour's next position.
        """
        nav = ap.modes.nav
        if nav.next.started:
            return
        if nav.detour.left > 0:
            target = vector_at(nav.detour.waypoints, 3 * nav.detour.left - 3)
        clear(nav.next)
        nav.current.fast = False
        if target is None or separation(end(nav.current), target) < SHORTEST or nav.current.length < SHORTEST:
            return
        if not self.may_join(ap, end(nav.current), target):
            return
        self.plan_leg(ap, nav.next, end(nav.current), target)
        nav.current.fast = True

    def change_speed(self, ap: A) -> None:
        """Plan the legs anew after a limit changed; a leg under way goes on from its speed and acceleration."""
        nav = ap.modes.nav
        if nav.current.segments > 0 and not nav.next.started:
            self._replan(ap, nav.current)
        if nav.next.segments > 0:
            self._replan(ap, nav.next)

    def _replan(self, ap: A, leg: Leg) -> None:
        target, fast, started = end(leg), leg.fast, leg.started
        now, last = evaluate(leg, leg.elapsed), leg.v[leg.segments - 1]
        left = leg.length - now.pos
        if not started and now.vel == 0.0 and last == 0.0:
            self.plan_leg(ap, leg, leg.origin, target)
        elif left > SHORTEST and leg.elapsed < leg.turn_out:
            self.go_on_to(ap, leg, last)
        leg.fast, leg.started = fast, started

    def go_on_to(self, ap: A, leg: Leg, last: float) -> None:
        """Plan the rest of a leg under way anew, to end with a speed [m/s]."""
        now, started = evaluate(leg, leg.elapsed), leg.started
        left = leg.length - now.pos
        wanted = bounded(self.limits(ap, leg.unit))
        try:
            profile = plan(left, wanted, now.vel, now.acc, min(last, wanted.speed))
        except LegError:
            return  # limits that this motion cannot be brought within: it goes on as planned
        write(leg, profile, leg.origin + leg.unit * now.pos, leg.unit, left)
        leg.started, leg.top_speed = started, wanted.speed

    def serve(self, ap: A, time_us: int) -> None:
        """Give the legs that the core asked for (``path.request_leg``, ``request_legs``), if any, and start them."""
        nav = ap.modes.nav
        if nav.request_pending == 0:
            return
        self.begin(ap, time_us, nav.request)
        if nav.request_pending == 2:
            self.look_ahead(ap, nav.request_next)
        nav.request_pending = 0
        self.start(ap, time_us)
