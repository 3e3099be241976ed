# SPDX-License-Identifier: BSD-3-Clause
"""Laps of worlds that are a loop: how often a robot has gone round what is in the middle."""

from __future__ import annotations

import math

CENTRES = {"circuit": (2.0, -1.9), "circuit2": (-1.7, -3.5), "circuit2c": (-1.7, -3.5), "round": (0.8, -2.25)}
"""World -> x, y of a place inside of the solids that the loop goes round [m]."""


class LapCounter:
    """Counts the turns of a path round a place.

    Args:
        centre: x, y [m].
    """

    def __init__(self, centre: tuple[float, float]) -> None:
        self._centre = centre
        self._angle: float | None = None
        self.turned = 0.0
        """Sum of the angle, clockwise positive [rad]."""

    def take(self, x: float, y: float) -> None:
        """The next place of the path [m], less than half a turn from the last."""
        angle = math.atan2(y - self._centre[1], x - self._centre[0])
        if self._angle is not None:
            self.turned += math.remainder(self._angle - angle, 2.0 * math.pi)
        self._angle = angle

    @property
    def laps(self) -> float:
        """Net, in the direction that there are more of."""
        return abs(self.turned) / (2.0 * math.pi)
