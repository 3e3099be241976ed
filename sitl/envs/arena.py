# SPDX-License-Identifier: BSD-3-Clause
"""The space of an episode: where positions are drawn, and which an agent's positions are scaled to."""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np

from sitl.worlds import World

from .actions import POSITION, Continuous, Normalised, Setpoint
from .options import EnvOptionError
from .robots.robot import Floats, Robot

REACH = 10.0
"""An arena reaches at least so far from the start [m]."""
LOWEST, HIGHEST = 1.0, 8.0
"""Heights above the floor between which positions in the air are drawn [m]."""


class Arena(NamedTuple):
    """An upright box in the world's frame [m]."""

    low: tuple[float, float, float]
    high: tuple[float, float, float]

    def draw(self, rng: np.random.Generator, margin: float = 0.0) -> Floats:
        """A position in it, ``margin`` [m] from its sides, shape (3,)."""
        low, high = np.array(self.low), np.array(self.high)
        low[:2], high[:2] = low[:2] + margin, high[:2] - margin
        return rng.uniform(low, np.maximum(high, low))

    def around(self, positions: Floats) -> Arena:
        """The smallest one that holds this one and positions, shape (n, 3)."""
        low, high = np.minimum(self.low, positions.min(axis=0)), np.maximum(self.high, positions.max(axis=0))
        return Arena(tuple(low.tolist()), tuple(high.tolist()))

    def grown(self, by: float) -> Arena:
        """The same with its sides so far out [m]; its floor stays."""
        x, y, z = self.low
        a, b, c = self.high
        return Arena((x - by, y - by, z - by), (a + by, b + by, c + by))


def arena_of(robot: Robot, reach: float = REACH, world: World | None = None) -> Arena:
    """The world's solids and markings, and ``reach`` round the robot's start [m]; a robot that does not fly stays at
    the height of its start. ``world``: None: that of the first robot."""
    world = world or robot.world
    if not 0.0 < reach < math.inf:
        raise EnvOptionError(f"arena: reach = {reach!r}; it must be above 0 m")
    x, y, z = world.start(robot.name).position
    x0, y0, x1, y1 = world.bounds
    low, high = (min(x0, x - reach), min(y0, y - reach)), (max(x1, x + reach), max(y1, y + reach))
    floor = world.floor_z
    heights = (floor + LOWEST, floor + HIGHEST) if flies(robot) else (z, z)
    return Arena((*low, heights[0]), (*high, heights[1]))


def flies(robot: Robot) -> bool:
    """Whether it moves up and down."""
    return bool(getattr(getattr(robot, "kind", None), "takes_off", False))


def normalised(robot: Robot, setpoint: Setpoint) -> Normalised:
    """A robot's usual continuous actions within [-1, 1]; positions are scaled to its arena."""
    box = robot.action("agile", setpoint)
    if not isinstance(box, Continuous):
        raise EnvOptionError(f'action "normalised": {robot.name} has no continuous actions for {setpoint.name!r}')
    if setpoint is POSITION:
        arena = arena_of(robot)
        low, high = (*arena.low, -math.pi), (*arena.high, math.pi)
        box = Continuous(POSITION, [low[c] for c in box.columns], [high[c] for c in box.columns], box.columns)
    return Normalised(box)
