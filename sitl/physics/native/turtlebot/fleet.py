# SPDX-License-Identifier: BSD-3-Clause
"""The compiled call: any number of Turtlebots in one world, each moved on by its own number of ticks, then its scan."""

from __future__ import annotations

import math
from typing import NamedTuple

from ....core.array_kernels import IntLine, Kernel, NarrowTable, Table
from ....core.kernels import law
from ....core.records import Records
from ....worlds.geometry import Solids
from .scan import Beams, add_noise, scan
from .state import TICK_US, Turtlebot
from .step import commanded, move


class Orders(NamedTuple):
    """What each robot of a fleet does next."""

    commands: Table
    """Forward speed [m/s] and turn rate [rad/s], counter-clockwise, shape (n, 2); a row that begins with nan is no new
    command: the last one holds until its time-out."""
    ticks: IntLine
    """How far it moves on [physics steps], shape (n,); 0: only its lidar is read; -1: neither."""


@law
def advance_fleet(
    fleet: Records[Turtlebot], orders: Orders, solids: Solids, beams: Beams, readings: NarrowTable
) -> None:
    """Command the robots, move them on, read their lidars.

    Args:
        fleet: records, shape (n,).
        orders: of each.
        solids: of the world.
        beams: of the lidar.
        readings: shape (n, readings) [m].
    """
    commands, ticks = orders.commands, orders.ticks
    for i in range(ticks.shape[0]):
        if ticks[i] < 0:
            continue
        v = fleet[i]
        if ticks[i] > 0:
            v.body.collided = False
            if not math.isnan(commands[i, 0]):
                c = v.command
                c.forward, c.turn, c.time_us = commands[i, 0], commands[i, 1], v.time_us
        for _ in range(ticks[i]):
            move(v.body, v.figures, commanded(v.figures, v.command, v.time_us), solids.rows)
            v.time_us += TICK_US
        scan(v.body, v.figures, solids, beams, readings[i])
        add_noise(readings[i], v.figures, v.rng)


advance = Kernel(advance_fleet)
