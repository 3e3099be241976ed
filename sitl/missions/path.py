# SPDX-License-Identifier: BSD-3-Clause
"""Distance, speed, height of a flight, and its deviation from the lines of its mission."""

from __future__ import annotations

import math
from dataclasses import dataclass
from itertools import pairwise
from typing import cast

from sitl.autopilot.copter.navigation import spline
from sitl.autopilot.copter.navigation.state import CopterNav
from sitl.autopilot.mission.location import down, point
from sitl.core.algebra import dot
from sitl.core.elementary import hypot
from sitl.core.mavlink import MavCmd
from sitl.core.sums import separation
from sitl.core.vectors import Vec3
from sitl.simulation import Simulation

LEGS = (MavCmd.NAV_WAYPOINT, MavCmd.NAV_LOITER_TIME, MavCmd.NAV_LOITER_UNLIM)
"""Commands flown on a straight line from the end of the command before."""
PIECES = 32
"""Straight pieces as which a curve is looked at."""
_NOWHERE = Vec3(math.nan, math.nan, math.nan)


@dataclass
class Deviation:
    """The greatest distance from the lines of the mission."""

    distance: float = 0.0
    """Distance [m]."""
    seq: int = 0
    """Number of the current item."""
    time: float = 0.0
    """Time since the start of the simulation [s]."""


class PathWatch:
    """Measures one vehicle's flight by its own estimate; call ``look`` at equal time steps while it is armed.

    Rovers are judged in the plane. Where two lines meet, the nearer counts: corners are cut as the firmware cuts them.
    """

    def __init__(self, simulation: Simulation) -> None:
        self._simulation = simulation
        self._flat = not simulation.kind.flies
        self.distance = self.top_speed = 0.0
        """Distance along the path [m]; greatest ground speed [m/s]."""
        self.top_height = 0.0
        """Greatest height above home [m]."""
        self.deviation = Deviation()
        self._last: Vec3 | None = None
        self._seq = 0
        self._end: Vec3 = _NOWHERE
        self._legs: list[tuple[Vec3, Vec3]] = []

    def look(self) -> None:
        """Process the vehicle's current state."""
        ap = self._simulation.v.autopilot
        here = self._in_plane(ap.estimate.pos)
        if self._last is not None:
            self.distance += separation(self._last, here)
        self._last = here
        self.top_speed = max(self.top_speed, hypot(ap.estimate.vel.x, ap.estimate.vel.y))
        self.top_height = max(self.top_height, ap.home.pos.z - here.z)
        seq = ap.modes.nav.command_seq
        if seq != self._seq:
            self._begin(seq, here)
        if self._legs:
            away = min(_distance(here, *leg) for leg in self._legs)
            if away > self.deviation.distance:
                self.deviation = Deviation(away, seq, self._simulation.time_us * 1e-6)

    def _in_plane(self, p: Vec3) -> Vec3:
        """The point itself; of a rover its position in the plane."""
        return p.replace(z=0.0) if self._flat else p

    def _begin(self, seq: int, here: Vec3) -> None:
        """A new navigation command starts: find the lines that are flown now."""
        ap = self._simulation.v.autopilot
        item = self._simulation.mission.get(seq)
        self._seq = seq
        start = here if math.isnan(self._end.x) else self._end
        before = self._legs[-1:]
        self._legs, self._end = [], _NOWHERE
        if item is None:
            return
        if item.command in LEGS:
            self._end = self._in_plane(point(ap, item, start))
            self._legs = [*before, (start, self._end)]
        elif item.command == MavCmd.NAV_SPLINE_WAYPOINT:
            curve = cast("CopterNav", ap.modes.nav).spline
            marks = [spline.position(curve, k / PIECES) for k in range(PIECES + 1)]
            self._end = marks[-1]
            self._legs = [*before, *pairwise(marks)]
        elif item.command == MavCmd.NAV_TAKEOFF:
            self._end = here.replace(z=down(ap, item))
        elif item.command == MavCmd.NAV_DELAY:
            self._end = start
            self._legs = [*before, (start, start)]


def _distance(p: Vec3, a: Vec3, b: Vec3) -> float:
    """Distance of a point from the line segment from a to b [m]."""
    along = b - a
    square = dot(along, along)
    fraction = 0.0 if square == 0.0 else dot(along, p - a) / square
    return separation(p, a + along * min(max(fraction, 0.0), 1.0))
