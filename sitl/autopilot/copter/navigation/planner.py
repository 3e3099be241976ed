# SPDX-License-Identifier: BSD-3-Clause
"""Limits of a copter's legs, and where they start (shell)."""

from __future__ import annotations

import math

from ....core.algebra import with_down
from ....core.vectors import Vec3
from ...navigation.leg import Limits, axis_limits
from ...navigation.planner import Planner
from ...navigation.state import LOITER_TURNS, TAKEOFF
from ..control.altitude_start import stopping_point_d
from ..control.position_start import stopping_point_ne
from ..parameters import Parameters
from ..state import Autopilot
from . import waypoint

GRAVITY = 9.80665


def jerk_limits(params: Parameters) -> tuple[float, float]:
    """(jerk [m/s^3], rise [s]) of legs.

    Leaning makes horizontal acceleration, so the lean rate limits jerk (ATC_RATE_*_MAX) and the lean rate's
    time constant (ATC_INPUT_TC) and acceleration (ATC_ACCEL_*_MAX) limit snap, half of which is used. Jerk
    that follows half a cosine needs pi/2 of jerk/snap to rise; the same time is taken here.
    """
    jerk = max(params.WPNAV.JERK, 0.1)
    lean_rate = math.radians(min(params.ATC.RATE_R_MAX, params.ATC.RATE_P_MAX))
    if lean_rate > 0.0:
        jerk = min(jerk, lean_rate * GRAVITY)
    snap = 0.5 * math.pi * jerk / max(params.ATC.INPUT_TC, 0.1)
    lean_acceleration = math.radians(0.01 * min(params.ATC.ACCEL_R_MAX, params.ATC.ACCEL_P_MAX))
    if lean_acceleration > 0.0:
        snap = min(snap, lean_acceleration * GRAVITY)
    return jerk, 0.5 * math.pi * jerk / (0.5 * snap)


class CopterPlanner(Planner[Autopilot]):
    """Plans a copter's legs."""

    active_us = 200_000

    def limits(self, ap: Autopilot, direction: Vec3) -> Limits:
        """Speed [m/s] and acceleration [m/s^2] of whichever axis is used up first."""
        nav, p = ap.modes.nav, ap.params.WPNAV
        vertical = max(waypoint.CM * p.ACCEL_Z, 0.1)
        horizontal = max(waypoint.CM * p.ACCEL, 0.1)
        jerk, rise = jerk_limits(ap.params)
        return Limits(
            axis_limits(direction, waypoint.speed_ne(nav, p), waypoint.speed_up(nav, p), waypoint.speed_down(nav, p)),
            axis_limits(direction, horizontal, vertical, vertical),
            jerk,
            rise,
        )

    def stopping_point(self, ap: Autopilot) -> Vec3:
        """Where the controllers would bring it to rest, NED [m]."""
        control, est, p = ap.control, ap.estimate, ap.params
        waypoint.set_limits(control, ap.modes.nav, p)
        return with_down(stopping_point_ne(control.pos_ne, est, p.PSC), stopping_point_d(control.pos_d, est, p.PSC))

    def origin_of_next(self, ap: Autopilot, time_us: int) -> tuple[Vec3, bool]:
        """A circle under way is left from where the vehicle is; a take-off ends at its height."""
        nav = ap.modes.nav
        circling = nav.command_kind == LOITER_TURNS and nav.circle_running
        if self.continues(ap, time_us) and not circling:
            return super().origin_of_next(ap, time_us)
        rest = self.stopping_point(ap)
        if nav.command_kind == TAKEOFF and nav.completed:
            rest = rest.replace(z=nav.target.z)
        return rest, False

    def start(self, ap: Autopilot, time_us: int) -> None:
        """Hand the legs to the follower."""
        waypoint.start(ap.modes.nav, ap.control, ap.estimate, ap.params, time_us)


PLANNER = CopterPlanner()
