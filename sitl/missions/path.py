# SPDX-License-Identifier: BSD-3-Clause
"""Distance, speed, height of a flight, and its deviation from the lines of its mission."""

from __future__ import annotations

import math
from dataclasses import dataclass

from sitl.autopilot.mission import item as commands
from sitl.autopilot.mission.place import down, point
from sitl.simulation import Simulation

Point = tuple[float, float, float]
LEGS = (commands.NAV_WAYPOINT, commands.NAV_LOITER_TIME, commands.NAV_LOITER_UNLIM)
"""Commands flown on a straight line from the end of the command before."""
_NOWHERE: Point = (math.nan, math.nan, math.nan)


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
        self._flat = simulation.kind.name == "rover"
        self.distance = self.top_speed = 0.0
        """Distance along the path [m]; greatest ground speed [m/s]."""
        self.top_height = 0.0
        """Greatest height above home [m]."""
        self.deviation = Deviation()
        self._last: Point | None = None
        self._seq = 0
        self._end: Point = _NOWHERE
        self._legs: list[tuple[Point, Point]] = []

    def look(self) -> None:
        """Process the vehicle's current state."""
        ap = self._simulation.v.autopilot
        here: Point = tuple(float(x) for x in ap.estimate.pos)  # type: ignore[assignment]
        if self._flat:
            here = (here[0], here[1], 0.0)
        if self._last is not None:
            self.distance += math.dist(self._last, here)
        self._last = here
        self.top_speed = max(self.top_speed, math.hypot(float(ap.estimate.vel[0]), float(ap.estimate.vel[1])))
        self.top_height = max(self.top_height, float(ap.home.pos[2]) - here[2])
        seq = int(ap.modes.nav.command_seq)
        if seq != self._seq:
            self._begin(seq, here)
        if self._legs:
            away = min(_distance(here, *leg) for leg in self._legs)
            if away > self.deviation.distance:
                self.deviation = Deviation(away, seq, self._simulation.time_us * 1e-6)

    def _begin(self, seq: int, here: Point) -> None:
        """A new navigation command starts: find the lines that are flown now."""
        ap = self._simulation.v.autopilot
        item = self._simulation.mission.get(seq)
        self._seq = seq
        start = here if math.isnan(self._end[0]) else self._end
        before = self._legs[-1:]
        self._legs, self._end = [], _NOWHERE
        if item is None:
            return
        if item.command in LEGS:
            end = point(ap, item, start)
            self._end = (end[0], end[1], 0.0) if self._flat else end
            self._legs = [*before, (start, self._end)]
        elif item.command == commands.NAV_TAKEOFF:
            self._end = (here[0], here[1], down(ap, item))
        elif item.command == commands.NAV_DELAY:
            self._end = start
            self._legs = [*before, (start, start)]


def _distance(p: Point, a: Point, b: Point) -> float:
    """Distance of a point from the line segment from a to b [m]."""
    along = tuple(y - x for x, y in zip(a, b))
    square = sum(x * x for x in along)
    fraction = 0.0 if square == 0.0 else sum(x * (q - r) for x, q, r in zip(along, p, a)) / square
    fraction = min(max(fraction, 0.0), 1.0)
    return math.dist(p, tuple(x + fraction * y for x, y in zip(a, along)))
