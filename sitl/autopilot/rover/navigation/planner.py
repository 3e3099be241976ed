# SPDX-License-Identifier: BSD-3-Clause
"""Limits of a rover's legs, and where they start (shell)."""

from __future__ import annotations

import math
from typing import Any

from ...navigation.leg import Limits
from ...navigation.planner import Planner, Point
from . import pivot, waypoint

SNAP = 15.0
"""Greatest snap along legs [m/s^4] (ArduRover's)."""


class RoverPlanner(Planner):
    """Plans a rover's legs."""

    active_us = waypoint.ACTIVE_US

    def limits(self, ap: Any, direction: Point) -> Limits:
        """The position controller's.

        Jerk that follows half a cosine needs pi/2 of jerk/snap to rise; the same time is taken here.
        """
        jerk = float(waypoint.jerk_max(ap))
        return Limits(
            float(ap.control.position.speed_max), float(waypoint.accel_max(ap)), jerk, 0.5 * math.pi * jerk / SNAP
        )

    def stopping_point(self, ap: Any) -> Point:
        """Where it would come to rest."""
        n, e = waypoint.stopping_point(ap)
        return (float(n), float(e), 0.0)

    def may_join(self, ap: Any, corner: Point, target: Point) -> bool:
        """Not when it would turn on the spot there."""
        nav = ap.modes.nav
        before = math.atan2(corner[1] - float(nav.drive.origin[1]), corner[0] - float(nav.drive.origin[0]))
        after = math.atan2(target[1] - corner[1], target[0] - corner[0])
        turns = bool(pivot.would_turn(ap, after - before))
        nav.drive.pivot_next = int(turns)
        return not turns

    def begin(self, ap: Any, time_us: int, target: Point) -> None:
        """With today's limits."""
        waypoint.set_limits(ap)
        super().begin(ap, time_us, target)
        if ap.modes.nav.joined != 0 and ap.modes.nav.current.top_speed != ap.control.position.speed_max:
            self.change_speed(ap)  # it was planned ahead, before the mission changed the speed
        waypoint.begin_leg(ap, time_us)

    def look_ahead(self, ap: Any, target: Point | None) -> None:
        """Forget what was known of the next corner."""
        if ap.modes.nav.next.started == 0:
            ap.modes.nav.drive.pivot_next = 0
        super().look_ahead(ap, target)

    def start(self, ap: Any, time_us: int) -> None:
        """Nothing more to do: ``update`` follows the legs."""


PLANNER = RoverPlanner()
