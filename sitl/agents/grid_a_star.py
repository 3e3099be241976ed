# SPDX-License-Identifier: BSD-3-Clause
"""A* on a grid around the solids of a world: what a pilot who knows the world plans."""

from __future__ import annotations

import heapq
import math

import numpy as np
import numpy.typing as npt

from sitl.core.algebra import ZERO2
from sitl.core.array_kernels import Kernel, Table
from sitl.core.elementary import hypot
from sitl.core.kernels import law
from sitl.core.sums import separation
from sitl.core.vectors import Vec2
from sitl.envs.robots.robot import Robot
from sitl.worlds.contact import Volume, nearest_of
from sitl.worlds.shapes import to_ned

Floats = npt.NDArray[np.float64]
CELL, MOST_CELLS = 0.2, 40_000
"""Side of a cell [m], which grows where a world would have more cells than that."""
LEAST = 0.05
"""Clearance that a path leaves at least [m]."""
CROWDED = 4.0
"""A metre close to solids counts as so many more, one with enough clearance as one."""
_NEAR = [(i, j, hypot(i, j)) for i in (-1, 0, 1) for j in (-1, 0, 1) if (i, j) != (0, 0)]


@law
def write_clearance(solids: Table, first: Vec2, cell: float, robot: Volume, out: Table) -> None:
    """Write how far a robot is from solids in the centres of the cells of a grid.

    Args:
        solids: rows of a ``Geometry``.
        first: north and east of the centre of cell (0, 0) [m]; north grows with the row, east falls with the column.
        cell: side of a cell [m].
        robot: its volume, anywhere.
        out: distances [m], shape (rows, columns).
    """
    for i in range(out.shape[0]):
        for j in range(out.shape[1]):
            there = Vec2(first.x + cell * i, first.y - cell * j)
            volume = Volume(there, robot.top, robot.bottom, robot.radius)
            out[i, j] = nearest_of(solids, solids.shape[0], volume).distance


_clearance = Kernel(write_clearance)


class GridAStar:
    """Shortest paths of a robot in its world, at the height of its start, which prefer clearance.

    Args:
        robot: with its world and volume.
        reach: how far beyond the world's solids paths may lead [m].
        comfort: clearance beyond which more is of no use [m].
    """

    def __init__(self, robot: Robot, reach: float, comfort: float) -> None:
        x0, y0, x1, y1 = robot.world.bounds
        x, y, z = robot.world.start(robot.name).position
        low = np.array([min(x0, x), min(y0, y)]) - reach
        extent = np.array([max(x1, x), max(y1, y)]) + reach - low
        self._cell = cell = max(CELL, math.sqrt(float(extent[0] * extent[1]) / MOST_CELLS))
        self._low = low
        rows, columns = (math.ceil(length / cell) for length in extent.tolist())
        clearance, volume = np.empty((rows, columns)), robot.volume
        first_x, first_y = (low + 0.5 * cell).tolist()
        north, east, down = to_ned(first_x, first_y, z)
        body = Volume(ZERO2, down - volume.top, down - volume.bottom, volume.radius)
        _clearance(robot.world.geometry.solids, Vec2(north, east), cell, body, clearance)
        self._free = clearance > LEAST
        self._costs = 1.0 + CROWDED * np.clip(1.0 - clearance / comfort, 0.0, 1.0)

    def _cell_of(self, position: Floats) -> tuple[int, int]:
        """The free cell that is nearest to x, y [m]."""
        at = np.clip(((position - self._low) / self._cell).astype(int), 0, np.array(self._free.shape) - 1)
        if not self._free[tuple(at)]:
            cells = np.argwhere(self._free)
            at = cells[np.square(cells - at).sum(axis=1).argmin()]
        return int(at[0]), int(at[1])

    def path(self, here: Floats, there: Floats) -> Floats:
        """Positions from here to there (x, y [m]), both included, shape (n, 2); a straight line where none is found."""
        start, goal = self._cell_of(here), self._cell_of(there)
        free, costs, rows, columns = self._free, self._costs, *self._free.shape
        best, before = {start: 0.0}, {start: start}
        todo = [(separation(start, goal), start)]
        while todo:
            _, cell = heapq.heappop(todo)
            if cell == goal:
                break
            so_far = best[cell]
            for i, j, length in _NEAR:
                near = cell[0] + i, cell[1] + j
                if not (0 <= near[0] < rows and 0 <= near[1] < columns and free[near]):
                    continue
                cost = so_far + length * float(costs[near])
                if cost < best.get(near, math.inf):
                    best[near], before[near] = cost, cell
                    heapq.heappush(todo, (cost + separation(near, goal), near))
        if goal not in before:
            return np.array([here, there])
        cells = [goal]
        while cells[-1] != start:
            cells.append(before[cells[-1]])
        middle = self._low + self._cell * (np.array(cells[-2:0:-1]).reshape(-1, 2) + 0.5)
        return np.concatenate([here[None], middle, there[None]])
