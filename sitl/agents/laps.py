# SPDX-License-Identifier: BSD-3-Clause
"""Counts laps in worlds that are a loop around a central solid."""

from __future__ import annotations

import math

CENTRES = {"circuit": (2.0, -1.9), "circuit2": (-1.7, -3.5), "circuit2c": (-1.7, -3.5), "round": (0.8, -2.25)}
"""World -> x, y of a position inside the central solids [m]."""


class LapCounter:
    """Counts the turns of a path around a position.

    Args:
        centre: x, y [m].
    """

    def __init__(self, centre: tuple[float, float]) -> None:
        self._centre = centre
        self._angle: float | None = None
        self.turned = 0.0
        """Accumulated angle, positive clockwise [rad]."""

    def take(self, x: float, y: float) -> None:
        """Add the next position of the path [m], less than half a turn from the last."""
        angle = math.atan2(y - self._centre[1], x - self._centre[0])
        if self._angle is not None:
            self.turned += math.remainder(self._angle - angle, 2.0 * math.pi)
        self._angle = angle

    @property
    def laps(self) -> float:
        """Net number of turns, in the predominant direction."""
        return abs(self.turned) / (2.0 * math.pi)
