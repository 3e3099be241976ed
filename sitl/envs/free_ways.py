# SPDX-License-Identifier: BSD-3-Clause
"""How far it is to a goal around a world's solids: the straight distance leads into a dead end, this one out of it."""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np
import numpy.typing as npt

from sitl.core import elementary_arrays as arrays
from sitl.core.array_kernels import IntLine, IntTable, Kernel, Line, NarrowTable, Table
from sitl.core.kernels import law
from sitl.worlds import World

from .robots.robot import Floats, Robot, world_of
from .starts import ReachableCells
from .worlds import PerWorld

CELLS = 20_000
"""About so many cells has the grid: a way to one goal is found in some milliseconds."""
_AROUND = ((1, 0), (-1, 0), (0, 1), (0, -1), (1, 1), (1, -1), (-1, 1), (-1, -1))


@law
def push(keys: Line, items: IntLine, count: int, key: float, item: int) -> int:
    """Put an item into a heap of ``count`` items, the least key first; returns how many there are then."""
    at = count
    while at > 0 and keys[(at - 1) // 2] > key:
        keys[at], items[at] = keys[(at - 1) // 2], items[(at - 1) // 2]
        at = (at - 1) // 2
    keys[at], items[at] = key, item
    return count + 1


@law
def pop(keys: Line, items: IntLine, count: int) -> int:
    """Take the first item out of a heap of ``count`` items, at least one; returns how many are left."""
    last = count - 1
    key, item = keys[last], items[last]
    at, child = 0, 1
    while child < last:
        if child + 1 < last and keys[child + 1] < keys[child]:
            child += 1
        if keys[child] >= key:
            break
        keys[at], items[at] = keys[child], items[child]
        at, child = child, 2 * child + 1
    keys[at], items[at] = key, item
    return last


@law
def reach(a: float, b: float) -> float:
    """Distance of a cell whose neighbours along the two axes have the distances ``a`` and ``b``, in cells: where the
    distance grows by 1 a cell. inf: no way leads over that neighbour."""
    low, high = min(a, b), max(a, b)
    if high - low >= 1.0:
        return low + 1.0
    return 0.5 * (low + high + math.sqrt(2.0 - (high - low) * (high - low)))


@law
def march(free: IntTable, row: float, column: float, keys: Line, items: IntLine, out: Table) -> None:
    """Write the length of the shortest way over free cells from each cell to a place.

    Source: Sethian, "A fast marching level set method for monotonically advancing fronts", PNAS 93, 1996.

    Args:
        free: 1 where a way can lead, shape (rows, columns).
        row, column: the place; the middle of the first cell is 0, 0.
        keys, items: room for the heap, shape (4 * rows * columns + 9,).
        out: in cells, shape (rows, columns); inf where no way leads.
    """
    rows, columns, count = free.shape[0], free.shape[1], 0
    for i in range(rows):
        for j in range(columns):
            out[i, j] = math.inf
    first, second = int(row + 0.5), int(column + 0.5)
    for i in range(max(first - 1, 0), min(first + 2, rows)):
        for j in range(max(second - 1, 0), min(second + 2, columns)):
            if free[i, j] != 0:
                out[i, j] = math.sqrt((i - row) * (i - row) + (j - column) * (j - column))
                count = push(keys, items, count, out[i, j], i * columns + j)
    while count > 0:
        key, row_now, column_now = keys[0], items[0] // columns, items[0] % columns
        count = pop(keys, items, count)
        if key > out[row_now, column_now]:
            continue
        for side in range(4):
            i = row_now + (1 if side == 0 else -1 if side == 1 else 0)
            j = column_now + (1 if side == 2 else -1 if side == 3 else 0)
            if i < 0 or j < 0 or i >= rows or j >= columns or free[i, j] == 0 or out[i, j] <= key:
                continue  # no way there, or as short as one over this cell can be
            a = min(out[i - 1, j] if i > 0 else math.inf, out[i + 1, j] if i + 1 < rows else math.inf)
            b = min(out[i, j - 1] if j > 0 else math.inf, out[i, j + 1] if j + 1 < columns else math.inf)
            there = reach(a, b)
            if there < out[i, j]:
                out[i, j] = there
                count = push(keys, items, count, there, i * columns + j)


@law
def read_ways(fields: NarrowTable, grids: Table, pose: Table, out: Line) -> None:
    """Read the length of the way of each robot, between the middles of cells in proportion.

    Args:
        fields: lengths [m] of each robot's ways, row after row of its grid, shape (count, rows * columns or more).
        grids: of each robot, shape (count, 5): rows, columns, x, y of the middle of the first cell [m], side of a
            cell [m].
        pose: x, y [m] and more, shape (count, 2 or more).
        out: [m], shape (count,).
    """
    for k in range(out.shape[0]):
        rows, columns, cell = int(grids[k, 0]), int(grids[k, 1]), grids[k, 4]
        x = min(max((pose[k, 0] - grids[k, 2]) / cell, 0.0), rows - 1.0)
        y = min(max((pose[k, 1] - grids[k, 3]) / cell, 0.0), columns - 1.0)
        i, j = min(int(x), rows - 2), min(int(y), columns - 2)
        u, v, at = x - i, y - j, i * columns + j
        below = (1.0 - v) * float(fields[k, at]) + v * float(fields[k, at + 1])
        above = (1.0 - v) * float(fields[k, at + columns]) + v * float(fields[k, at + columns + 1])
        out[k] = (1.0 - u) * below + u * above


_march = Kernel(march)
_read = Kernel(read_ways)


class Ground(NamedTuple):
    """A world's grid, seen from above."""

    free: npt.NDArray[np.int64]
    """1 where a way can lead, shape (rows, columns)."""
    nearest: npt.NDArray[np.int32]
    """Number of the nearest free cell of each cell."""
    beside: Floats
    """How far it is [cells]."""
    low: Floats
    """x, y of the middle of the first cell [m]."""
    cell: float
    """Side of a cell [m]."""


class FreeWays:
    """Lengths of the shortest free ways of robots to their goals, seen from above.

    A way is free where the robot's volume has room at the height of its start, with the margin of random places
    (``starts.ReachableCells``). Of places without that room the way begins at the nearest one with room.

    Args:
        robot: robots whose worlds, start and volume are used.
        crash_range: a reading below it is a crash [m].
    """

    def __init__(self, robot: Robot, crash_range: float = 0.0) -> None:
        self._robot, self._crash_range = robot, crash_range
        self._in = PerWorld(self._ground)
        size = self._in(robot.world).free.size
        self._grids = np.zeros((robot.count, 5))
        self._grids[:, :2], self._grids[:, 4] = 2.0, 1.0
        self._fields = np.zeros((robot.count, size), np.float32)
        self._out = np.zeros(robot.count)
        self._keys, self._items = np.empty(0), np.empty(0, np.int64)  # room for the heap

    def _ground(self, world: World) -> Ground:
        found = ReachableCells(self._robot, self._crash_range, CELLS, world)
        free = np.zeros(found.shape, np.bool_)
        free[found.cells[:, 0], found.cells[:, 1]] = True
        return Ground(free.astype(np.int64), *_nearest(free), found.low + 0.5 * found.cell, found.cell)

    def aim(self, index: int, x: float, y: float) -> None:
        """Give a robot its goal, x, y in the frame of its world [m]."""
        ground = self._in(world_of(self._robot, index))
        rows, columns = ground.free.shape
        row, column = (np.array([x, y]) - ground.low) / ground.cell
        i, j = (int(np.clip(np.rint(at), 0, last - 1)) for at, last in ((row, rows), (column, columns)))
        beside = float(ground.beside[i, j])
        if beside > 0.0:
            row, column = divmod(int(ground.nearest[i, j]), columns)
        size = ground.free.size
        if len(self._keys) < 4 * size + 9:
            self._keys, self._items = np.empty(4 * size + 9), np.empty(4 * size + 9, np.int64)
        field = np.empty(ground.free.shape)
        _march(ground.free, float(row), float(column), self._keys, self._items, field)
        lengths = field.ravel()[ground.nearest] + ground.beside + beside
        if size > self._fields.shape[1]:
            more = np.zeros((len(self._fields), size - self._fields.shape[1]), np.float32)
            self._fields = np.concatenate((self._fields, more), axis=1)
        self._fields[index, :size] = (ground.cell * lengths).ravel()
        self._grids[index] = rows, columns, *ground.low, ground.cell

    def lengths(self, pose: Floats) -> Floats:
        """Length of each robot's way from a pose (x, y, ...) [m], shape (count,); the array is used again."""
        _read.unchecked()(self._fields, self._grids, np.ascontiguousarray(pose), self._out)
        return self._out


def _nearest(free: npt.NDArray[np.bool_]) -> tuple[npt.NDArray[np.int32], Floats]:
    """Number of the nearest free cell of each cell, and how far it is [cells]."""
    rows, columns = free.shape
    at = np.arange(free.size).reshape(free.shape)
    nearest = np.where(free, at, -1)
    distance = np.where(free, 0.0, np.inf)
    i, j = np.divmod(at, columns)
    changed = True
    while changed:
        changed = False
        for down, right in _AROUND:
            here = slice(max(down, 0), rows + min(down, 0)), slice(max(right, 0), columns + min(right, 0))
            there = slice(max(-down, 0), rows + min(-down, 0)), slice(max(-right, 0), columns + min(-right, 0))
            offered = nearest[there]
            a, b = np.divmod(offered, columns)
            far = np.where(offered < 0, np.inf, arrays.hypot(i[here] - a, j[here] - b))
            better = far < distance[here]
            if better.any():
                nearest[here][better], distance[here][better] = offered[better], far[better]
                changed = True
    return nearest.astype(np.int32), distance
