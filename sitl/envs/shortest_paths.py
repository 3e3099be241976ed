# SPDX-License-Identifier: BSD-3-Clause
"""How far it is to a goal around a world's solids: the straight distance leads into a dead end, this one out of it."""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np
import numpy.typing as npt

from sitl.core.array_kernels import IntTable, Kernel, Line, NarrowTable, Table
from sitl.core.elementary import sincos
from sitl.core.kernels import law
from sitl.worlds import World

from .marching import LISTS, march
from .robots.robot import Floats, Robot, world_of
from .starts import ReachableCells
from .worlds import PerWorld

CLEARANCE = 1.0
"""A route keeps so far away from cells where the robot has no clearance, if there is a path [m]."""
BESIDE = 5.0
"""A metre along the edge of such cells costs 1 + this; the excess falls with the square of the distance, to 0 at
``CLEARANCE``."""
CELLS = 20_000
"""About so many cells has the grid: a path to one goal is found in some milliseconds."""


UNKNOWN = 1 << 62
"""Square of a distance that is not known yet."""


class Around(NamedTuple):
    """Where a position lies in a robot's grid."""

    at: int
    """Number of the cell before it along both axes."""
    u: float
    v: float
    """How far it is from that cell's middle, along rows and columns [cells]."""


@law
def around(grids: Table, k: int, x: float, y: float) -> Around:
    """Where x, y [m] lies in the grid of robot ``k``; positions outside count as at its edge."""
    rows, columns, cell = int(grids[k, 0]), int(grids[k, 1]), grids[k, 4]
    row = min(max((x - grids[k, 2]) / cell, 0.0), rows - 1.0)
    column = min(max((y - grids[k, 3]) / cell, 0.0), columns - 1.0)
    i, j = min(int(row), rows - 2), min(int(column), columns - 2)
    return Around(i * columns + j, row - i, column - j)


@law
def length_at(fields: NarrowTable, k: int, columns: int, here: Around) -> float:
    """Length of the path of robot ``k`` from a position, between the middles of cells in proportion [m]."""
    at, u, v = here.at, here.u, here.v
    below = (1.0 - v) * float(fields[k, at]) + v * float(fields[k, at + 1])
    above = (1.0 - v) * float(fields[k, at + columns]) + v * float(fields[k, at + columns + 1])
    return (1.0 - u) * below + u * above


@law
def read_lengths(fields: NarrowTable, grids: Table, pose: Table, out: Line) -> None:
    """Read the length of the path of each robot.

    Args:
        fields: lengths [m] of each robot's paths, row after row of its grid, shape (count, rows * columns or more).
        grids: of each robot, shape (count, 5): rows, columns, x, y of the middle of the first cell [m], side of a
            cell [m].
        pose: x, y [m] and more, shape (count, 2 or more).
        out: [m], shape (count,).
    """
    for k in range(out.shape[0]):
        out[k] = length_at(fields, k, int(grids[k, 1]), around(grids, k, pose[k, 0], pose[k, 1]))


@law
def follow_paths(
    routes: NarrowTable, fields: NarrowTable, grids: Table, pose: Table, ahead: float, out: Table, first: int
) -> None:
    """Write to where each robot's route leads next: down the field of its costs, in steps of half a cell.

    Args:
        routes: costs of each robot's routes, as ``fields`` has lengths.
        fields, grids: see ``read_lengths``.
        pose: x, y, z [m], yaw [rad] and more, shape (count, 4 or more).
        ahead: how far along the path [m].
        out: forward, left of the robot's heading, and the length of the shortest path [m], shape (count, columns).
        first: column of the first one.
    """
    for k in range(out.shape[0]):
        columns, step = int(grids[k, 1]), 0.5 * grids[k, 4]
        x, y, gone = pose[k, 0], pose[k, 1], 0.0
        here = around(grids, k, x, y)
        length, left = length_at(fields, k, columns, here), length_at(routes, k, columns, here)
        while gone < ahead and step < left < math.inf:
            at, u, v = here.at, here.u, here.v
            a, b = float(routes[k, at]), float(routes[k, at + 1])
            c, d = float(routes[k, at + columns]), float(routes[k, at + columns + 1])
            down, right = (1.0 - v) * (c - a) + v * (d - b), (1.0 - u) * (b - a) + u * (d - c)
            slope = math.sqrt(down * down + right * right)
            if not 0.0 < slope < math.inf:
                break  # as far from the goal along two paths, or none leads from here
            far = min(step, ahead - gone)
            x, y, gone = x - far * down / slope, y - far * right / slope, gone + far
            here = around(grids, k, x, y)
            left = length_at(routes, k, columns, here)
        s, c = sincos(pose[k, 3])
        x, y = x - pose[k, 0], y - pose[k, 1]
        out[k, first], out[k, first + 1], out[k, first + 2] = x * c + y * s, y * c - x * s, length


@law
def pass_on(down: IntTable, right: IntTable, squares: IntTable, i_step: int, j_step: int) -> bool:
    """Offer to each cell what its neighbour at ``-i_step``, ``-j_step`` knows; whether any takes it.

    Cells are gone through against that direction, so that each is offered what its neighbour knew before.
    """
    rows, columns, taken = squares.shape[0], squares.shape[1], False
    up, left = (-1 if i_step > 0 else 1), (-1 if j_step > 0 else 1)
    for i in range(rows - 1 if up < 0 else 0, i_step - 1 if up < 0 else rows + i_step, up):
        for j in range(columns - 1 if left < 0 else 0, j_step - 1 if left < 0 else columns + j_step, left):
            a, b = i - i_step, j - j_step
            if squares[a, b] != UNKNOWN:
                along, across = down[a, b] + i_step, right[a, b] + j_step
                square = along * along + across * across
                if square < squares[i, j]:
                    down[i, j], right[i, j], squares[i, j], taken = along, across, square, True
    return taken


@law
def spread(down: IntTable, right: IntTable, squares: IntTable) -> None:
    """Spread from cell to cell which free one is the nearest, until no cell finds a nearer one.

    Args:
        down, right: rows and columns from the nearest free cell, at first 0; shape (rows, columns).
        squares: of the distance to it [cells]; at first 0 of free cells, ``UNKNOWN`` of others.
    """
    changed = True
    while changed:
        changed = False
        for i_step, j_step in ((1, 0), (-1, 0), (0, 1), (0, -1), (1, 1), (1, -1), (-1, 1), (-1, -1)):
            if pass_on(down, right, squares, i_step, j_step):
                changed = True


@law
def write_lengths(
    field: Line, nearest: IntTable, beside: Table, more: float, cell: float, out: NarrowTable, k: int
) -> None:
    """Write the lengths of paths to the goal of robot ``k``.

    Args:
        field: costs of paths, in cells, as ``march`` writes them.
        nearest: number of the nearest free cell of each cell in ``field``, shape (rows, columns).
        beside: how far it is [cells].
        more: how far the goal is from its nearest free cell [cells].
        cell: side of a cell [m].
        out: [m], shape (count, rows * columns or more).
        k: the robot.
    """
    rows, columns = nearest.shape[0], nearest.shape[1]
    for i in range(rows):
        for j in range(columns):
            out[k, i * columns + j] = cell * (field[nearest[i, j]] + beside[i, j] + more)


_march = Kernel(march)
_write = Kernel(write_lengths)
_spread = Kernel(spread)
_read = Kernel(read_lengths)
_follow = Kernel(follow_paths)


class Ground(NamedTuple):
    """A world's grid, seen from above."""

    free: Floats
    """1 where a path can lead, row after row, with an edge of zeros; shape ((rows + 2) * (columns + 2),)."""
    costs: Floats
    """The same of the cost of a cell of a route, which keeps away from solids where there is space."""
    nearest: npt.NDArray[np.int64]
    """Number among these of the nearest free cell of each cell, shape (rows, columns)."""
    beside: Floats
    """How far it is [cells]."""
    low: Floats
    """x, y of the middle of the first cell [m]."""
    cell: float
    """Side of a cell [m]."""


class ShortestPaths:
    """Lengths of the shortest free paths of robots to their goals, seen from above.

    A path is free where the robot's volume fits at the height of its start, with the margin of random positions
    (``starts.ReachableCells``). From positions where it does not fit, the path begins at the nearest one where it does.

    Args:
        robot: robots whose worlds, start and volume are used.
        crash_range: a reading below it is a crash [m].
    """

    def __init__(self, robot: Robot, crash_range: float = 0.0) -> None:
        self._robot, self._crash_range = robot, crash_range
        self._in = PerWorld(self._ground)
        size = self._in(robot.world).nearest.size
        self._grids = np.zeros((robot.count, 5))
        self._grids[:, :2], self._grids[:, 4] = 2.0, 1.0
        self._fields = np.zeros((robot.count, size), np.float32)
        self._out = np.zeros(robot.count)
        self._firsts, self._links = np.empty(LISTS, np.int64), np.empty((0, 3), np.int64)  # cells that wait
        self._routes: npt.NDArray[np.float32] | None = None
        """Costs of routes, as ``_fields`` has lengths; None: nothing asks for them."""

    def _ground(self, world: World) -> Ground:
        found = ReachableCells(self._robot, self._crash_range, CELLS, world)
        free = np.zeros(found.shape, np.bool_)
        free[found.cells[:, 0], found.cells[:, 1]] = True
        clearance = np.ones(free.shape)
        if not free.all():
            clearance = np.minimum(found.cell * _nearest(~free)[1] / CLEARANCE, 1.0)
        lack = 1.0 - clearance
        costs = np.where(free, 1.0 + BESIDE * lack * lack, 0.0)
        nearest, beside = _nearest(free)
        i, j = np.divmod(nearest, free.shape[1])
        nearest = np.where(nearest < 0, 0, (i + 1) * (free.shape[1] + 2) + j + 1)  # 0: at the edge
        low = found.low + 0.5 * found.cell
        return Ground(_edged(free.astype(np.float64)), _edged(costs), nearest, beside, low, found.cell)

    def plan_routes(self) -> None:
        """``follow`` is going to be called; before the first goal."""
        if self._routes is None:
            self._routes = np.zeros_like(self._fields)

    def aim(self, index: int, x: float, y: float) -> None:
        """Give a robot its goal, x, y in the frame of its world [m]."""
        ground = self._in(world_of(self._robot, index))
        rows, columns = ground.nearest.shape
        row, column = (np.array([x, y]) - ground.low) / ground.cell
        i, j = (int(np.clip(np.rint(at), 0, last - 1)) for at, last in ((row, rows), (column, columns)))
        beside = float(ground.beside[i, j])
        if beside > 0.0:
            row, column = (at - 1 for at in divmod(int(ground.nearest[i, j]), columns + 2))
        self._fields = self._marched(self._fields, index, ground, ground.free, float(row), float(column), beside)
        if self._routes is not None:
            self._routes = self._marched(self._routes, index, ground, ground.costs, float(row), float(column), beside)
        self._grids[index] = rows, columns, *ground.low, ground.cell

    def _marched(
        self, fields: npt.NDArray[np.float32], index: int, ground: Ground, costs: Floats, row: float, column: float,
        beside: float,
    ) -> npt.NDArray[np.float32]:  # fmt: skip
        """``fields`` with the one of a robot's new goal, or a larger array with these."""
        size, edged = ground.nearest.size, len(costs)
        if edged > len(self._links):
            self._links = np.empty((edged, 3), np.int64)
        if size > fields.shape[1]:
            more = np.zeros((len(fields), size - fields.shape[1]), np.float32)
            fields = np.concatenate((fields, more), axis=1)
        field, columns = np.empty(edged), ground.nearest.shape[1] + 2
        _march.unchecked()(costs, columns, row + 1.0, column + 1.0, self._firsts, self._links, field)
        _write.unchecked()(field, ground.nearest, ground.beside, beside, ground.cell, fields, index)
        return fields

    def lengths(self, pose: Floats) -> Floats:
        """Length of each robot's path from a pose (x, y, ...) [m], shape (count,); the array is used again."""
        _read.unchecked()(self._fields, self._grids, np.ascontiguousarray(pose), self._out)
        return self._out

    def follow(self, pose: Floats, ahead: float, out: Floats, first: int = 0) -> None:
        """Write to where each robot's route leads from a pose, ``ahead`` [m] along it; see ``follow_paths``."""
        assert self._routes is not None
        _follow.unchecked()(self._routes, self._fields, self._grids, np.ascontiguousarray(pose), ahead, out, first)


def _edged(cells: Floats) -> Floats:
    """With an edge of zeros, row after row."""
    return np.pad(cells, 1).ravel()


def _nearest(free: npt.NDArray[np.bool_]) -> tuple[npt.NDArray[np.int64], Floats]:
    """Number of the nearest free cell of each cell, and how far it is [cells]."""
    down, right = np.zeros((2, *free.shape), np.int64)
    squares = np.where(free, 0, UNKNOWN)
    _spread.unchecked()(down, right, squares)
    i, j = np.ogrid[: free.shape[0], : free.shape[1]]
    known = squares != UNKNOWN
    nearest = np.where(known, (i - down) * free.shape[1] + j - right, -1)
    return nearest, np.sqrt(np.where(known, squares, math.inf))
