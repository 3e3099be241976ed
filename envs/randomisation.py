# SPDX-License-Identifier: BSD-3-Clause
"""Domain randomisation: figures of the robot, by name, drawn anew for every episode."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import replace
from typing import Any

import numpy as np

from .options import EnvOptionError, unknown
from .robots.robot import Robot

Randomise = Mapping[str, tuple[float, float] | Callable[[np.random.Generator], float]]
"""Figure -> (low, high), of which it is drawn evenly, or a function that draws it."""


class Randomisation:
    """Draws figures.

    Raises:
        EnvOptionError: no such figure, a range that is none, or one beyond the figure's limits.
    """

    def __init__(self, ranges: Randomise, robot: Robot) -> None:
        self.ranges = dict(ranges)
        for name, values in self.ranges.items():
            if name not in robot.figures:
                raise unknown("randomise: figure", name, robot.figures)
            if not callable(values):
                self._check(name, values, robot)

    @staticmethod
    def _check(name: str, values: Any, robot: Robot) -> None:
        figure = robot.figures[name]
        try:
            low, high = (float(v) for v in values)
        except (TypeError, ValueError):
            raise EnvOptionError(f"randomise: {name} = {values!r}; it must be (low, high) or a function") from None
        if not figure.low <= low <= high <= figure.high:
            limits = f"{figure.low:g} .. {figure.high:g} {figure.unit}".strip()
            raise EnvOptionError(f"randomise: {name} = {values!r}; it must be low <= high within {limits}")
        if name == "range_max":
            robot.range_max = max(robot.range_max, high)
        if name == "radius":  # random places have room for the greatest
            robot.volume = replace(robot.volume, radius=max(robot.volume.radius, high))

    def draw(self, index: int, robot: Robot, rng: np.random.Generator) -> None:
        """Give one robot its figures for the next episode."""
        for name, values in self.ranges.items():
            value = values(rng) if callable(values) else rng.uniform(*values)
            robot.set_figure(index, name, float(value))
