# SPDX-License-Identifier: BSD-3-Clause
"""Plans the legs of one vehicle and writes them to its record (shell: Python,
only when a leg begins or limits change).
"""

from __future__ import annotations

import math
from abc import ABC, abstractmethod
from typing import Any

from .leg import SHORTEST, LegError, Limits, bounded, plan, write
from .profile import clear, evaluate

Point = tuple[float, float, float]
"""NED from the origin [m]."""


def end(leg: Any) -> Point:
    """Where a leg ends."""
    return tuple(float(leg.origin[k] + leg.unit[k] * leg.length) for k in range(3))  # type: ignore[return-value]


class Planner(ABC):
    """Plans the legs of a firmware's vehicles."""

    active_us: int
    """A path followed within this time [us] is still the one under way."""

    @abstractmethod
    def limits(self, ap: Any, direction: Point) -> Limits:
        """Limits along a straight leg in ``direction`` (unit vector NED)."""

    @abstractmethod
    def stopping_point(self, ap: Any) -> Point:
        """Where the vehicle would come to rest."""

    @abstractmethod
    def start(self, ap: Any, time_us: int) -> None:
        """Begin at the planned legs, as a mode does for those of a mission."""

    def may_join(self, ap: Any, corner: Point, target: Point) -> bool:
        """Whether the vehicle goes round this corner without a stop."""
        return True

    def plan_leg(self, ap: Any, leg: Any, origin: Point, target: Point) -> None:
        """Plan a leg from rest to rest into a leg record.

        An origin that is not finite (parameters can spoil the estimate that it comes from) has no line to the target:
        the leg is the target alone.

        Raises:
            LegError: the target is not finite.
        """
        length = math.dist(origin, target)
        if length < SHORTEST or (not all(map(math.isfinite, origin)) and all(map(math.isfinite, target))):
            write(leg, plan(0.0, Limits(1.0, 1.0, 1.0)), target, (0.0, 0.0, 0.0), 0.0)
            return
        direction = (
            (target[0] - origin[0]) / length,
            (target[1] - origin[1]) / length,
            (target[2] - origin[2]) / length,
        )
        wanted = bounded(self.limits(ap, direction))
        write(leg, plan(length, wanted), origin, direction, length)
        leg.top_speed = wanted.speed

    def is_active(self, ap: Any, time_us: int) -> bool:
        """Whether a path was followed a moment ago."""
        nav = ap.modes.nav
        return bool(nav.active_us > 0 and time_us - nav.active_us <= self.active_us)

    def continues(self, ap: Any, time_us: int) -> bool:
        """Whether the next leg starts at the end of the one under way."""
        nav = ap.modes.nav
        return bool(self.is_active(ap, time_us) and nav.reached != 0 and nav.current.segments > 0)

    def origin_of_next(self, ap: Any, time_us: int) -> tuple[Point, bool]:
        """(where the next leg starts, whether it continues the one under way)."""
        if self.continues(ap, time_us):
            return end(ap.modes.nav.current), True
        return self.stopping_point(ap), False

    def begin(self, ap: Any, time_us: int, target: Point) -> None:
        """Make the leg to ``target`` the current one.

        It continues the leg just travelled when that was reached (and takes over the leg planned ahead, which may be
        under way already), and else starts at the point where the vehicle would come to rest.
        """
        nav = ap.modes.nav
        origin, continues = self.origin_of_next(ap, time_us)
        planned = continues and nav.current.fast != 0 and nav.next.segments > 0
        nav.joined = 0
        if planned and math.dist(end(nav.next), target) < 1e-3:
            nav.previous = nav.current
            nav.current = nav.next
            nav.current.fast = 0
            nav.joined = 1
        else:
            if planned and nav.next.started != 0:  # the mission changed in the middle of a turn
                origin, continues = self.stopping_point(ap), False
            clear(nav.previous)
            self.plan_leg(ap, nav.current, origin, target)
        clear(nav.next)
        nav.fresh = 0 if continues else 1
        nav.reached = 0
        for k in range(3):
            nav.target[k] = target[k]

    def look_ahead(self, ap: Any, target: Point | None) -> None:
        """Plan the leg after the current one, to be joined without a stop; None: stop at the end of the current one."""
        nav = ap.modes.nav
        if nav.next.started != 0:
            return
        clear(nav.next)
        nav.current.fast = 0
        if target is None or math.dist(end(nav.current), target) < SHORTEST or nav.current.length < SHORTEST:
            return
        if not self.may_join(ap, end(nav.current), target):
            return
        self.plan_leg(ap, nav.next, end(nav.current), target)
        nav.current.fast = 1

    def change_speed(self, ap: Any) -> None:
        """Plan the legs anew after a limit changed; a leg under way goes on from its speed and acceleration."""
        nav = ap.modes.nav
        if nav.current.segments > 0 and nav.next.started == 0:
            self._replan(ap, nav.current)
        if nav.next.segments > 0:
            self._replan(ap, nav.next)

    def _replan(self, ap: Any, leg: Any) -> None:
        target, fast, started = end(leg), int(leg.fast), int(leg.started)
        p, v, a = evaluate(leg, float(leg.elapsed))
        left = float(leg.length) - p
        if started == 0:
            self.plan_leg(ap, leg, tuple(float(x) for x in leg.origin), target)  # type: ignore[arg-type]
        elif left > SHORTEST and leg.elapsed < leg.turn_out:
            direction: Point = tuple(float(x) for x in leg.unit)  # type: ignore[assignment]
            here: Point = tuple(float(leg.origin[k] + direction[k] * p) for k in range(3))  # type: ignore[assignment]
            wanted = bounded(self.limits(ap, direction))
            try:
                profile = plan(left, wanted, v, a)
            except LegError:
                return  # limits that this motion cannot be brought within: it goes on as planned
            write(leg, profile, here, direction, left)
            leg.top_speed = wanted.speed
        leg.fast, leg.started = fast, started

    def serve(self, ap: Any, time_us: int) -> None:
        """Give the legs that the core asked for (``path.request_leg``, ``request_legs``), if any, and start them."""
        nav = ap.modes.nav
        if nav.request_pending == 0:
            return
        self.begin(ap, time_us, tuple(float(x) for x in nav.request))  # type: ignore[arg-type]
        if nav.request_pending == 2:
            self.look_ahead(ap, tuple(float(x) for x in nav.request_next))  # type: ignore[arg-type]
        nav.request_pending = 0
        self.start(ap, time_us)
