# SPDX-License-Identifier: BSD-3-Clause
"""Limits of a rover's legs, and where they start (shell)."""

from __future__ import annotations

import math

from ....core.algebra import with_down
from ....core.elementary import atan2
from ....core.vectors import Vec3
from ...navigation.leg import Limits
from ...navigation.planner import Planner
from ..state import Autopilot
from . import pivot, waypoint

SNAP = 15.0
"""Greatest snap along legs [m/s^4] (ArduRover's)."""


class RoverPlanner(Planner[Autopilot]):
    """Plans a rover's legs."""

    active_us = waypoint.ACTIVE_US

    def limits(self, ap: Autopilot, direction: Vec3) -> Limits:
        """The position controller's.

        Jerk that follows half a cosine needs pi/2 of jerk/snap to rise; the same time is taken here.
        """
        jerk = waypoint.jerk_max(ap.params)
        acceleration = waypoint.accel_max(ap.params)
        return Limits(ap.control.position.speed_max, acceleration, jerk, 0.5 * math.pi * jerk / SNAP)

    def stopping_point(self, ap: Autopilot) -> Vec3:
        """Where it would come to rest, NED [m]."""
        return with_down(waypoint.stopping_point(ap.estimate, ap.params.ATC), 0.0)

    def may_join(self, ap: Autopilot, corner: Vec3, target: Vec3) -> bool:
        """Not when it would turn on the spot there."""
        drive = ap.modes.nav.drive
        before = atan2(corner.y - drive.origin.y, corner.x - drive.origin.x)
        after = atan2(target.y - corner.y, target.x - corner.x)
        drive.pivot_next = pivot.would_turn(after - before, ap.params)
        return not drive.pivot_next

    def begin_leg(self, ap: Autopilot, time_us: int, target: Vec3) -> None:
        """With today's limits."""
        waypoint.set_limits(ap.control.position, ap.modes.nav, ap.params)
        super().begin_leg(ap, time_us, target)
        if ap.modes.nav.joined and ap.modes.nav.current.top_speed != ap.control.position.speed_max:
            self.change_speed(ap)  # it was planned ahead, before the mission changed the speed
        waypoint.begin_leg(ap.modes.nav, ap.estimate, time_us, ap.params)

    def look_ahead(self, ap: Autopilot, target: Vec3 | None) -> None:
        """Forget what was known of the next corner."""
        if not ap.modes.nav.next.started:
            ap.modes.nav.drive.pivot_next = False
        super().look_ahead(ap, target)

    def start(self, ap: Autopilot, time_us: int) -> None:
        """Nothing more to do: ``follow`` moves along the legs."""


PLANNER = RoverPlanner()
