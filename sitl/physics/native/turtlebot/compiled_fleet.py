# SPDX-License-Identifier: BSD-3-Clause
"""The compiled call: any number of Turtlebots in one world, each moved on by its own number of ticks, then its scan."""

from __future__ import annotations

import math
from typing import NamedTuple

from ....core.array_kernels import IntLine, IntTable, Kernel, NarrowLine, NarrowTable, Table
from ....core.kernels import law
from ....core.memory import floats_at, ints_at, table_at
from ....core.records import Records
from ....core.vectors import Vec2
from ....worlds.geometry import GRID_NUMBERS, SOLID_COLUMNS, Solids
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
    for i in range(orders.ticks.shape[0]):
        if orders.ticks[i] >= 0:
            advance_one(fleet[i], Vec2(orders.commands[i, 0], orders.commands[i, 1]), orders.ticks[i], solids)
            look(fleet[i], solids, beams, readings[i])


@law
def advance_one(v: Turtlebot, command: Vec2, ticks: int, solids: Solids) -> None:
    """Command one robot (see ``Orders``) and move it on by some physics steps."""
    if ticks > 0:
        v.body.collided = False
        if not math.isnan(command.x):
            c = v.command
            c.forward, c.turn, c.time_us = command.x, command.y, v.time_us
    for _ in range(ticks):
        move(v.body, v.airframe, commanded(v.airframe, v.command, v.time_us), solids.rows)
        v.time_us += TICK_US


@law
def look(v: Turtlebot, solids: Solids, beams: Beams, readings: NarrowLine) -> None:
    """Read one robot's lidar."""
    scan(v.body, v.airframe, solids, beams, readings)
    add_noise(readings, v.airframe, v.rng)


SOLIDS, SOLID_COUNT, GRID, CELLS, CELL_COUNT = 0, 1, 2, 3, 4
"""Columns of ``worlds``: addresses and lengths of the arrays of a ``Geometry``."""


@law
def advance_in_worlds(
    fleet: Records[Turtlebot], orders: Orders, worlds: IntTable, beams: Beams, readings: NarrowTable
) -> None:
    """The same for robots that are each in a world of their own; ``worlds``: a row a robot, shape (n, 5)."""
    for i in range(orders.ticks.shape[0]):
        if orders.ticks[i] >= 0:
            rows = table_at(worlds[i, SOLIDS], worlds[i, SOLID_COUNT], SOLID_COLUMNS)
            grid, cells = floats_at(worlds[i, GRID], GRID_NUMBERS), ints_at(worlds[i, CELLS], worlds[i, CELL_COUNT])
            solids = Solids(rows, grid, cells)
            advance_one(fleet[i], Vec2(orders.commands[i, 0], orders.commands[i, 1]), orders.ticks[i], solids)
            look(fleet[i], solids, beams, readings[i])


advance = Kernel(advance_fleet)
advance_apart = Kernel(advance_in_worlds)
