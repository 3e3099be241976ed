# SPDX-License-Identifier: BSD-3-Clause
"""The fast marching method: lengths of the shortest paths over a grid to one position."""

from __future__ import annotations

import math

from sitl.core.array_kernels import IntLine, IntTable, Line
from sitl.core.kernels import law

LISTS = 64
"""Number of lists in which cells wait, by the cost of their path in whole numbers; a power of two."""
COST_MOST = 30.0
"""Of a cell: what it adds to a path must not reach round all lists."""
NOBODY = -1


@law
def reach(a: float, b: float, cost: float) -> float:
    """Distance of a cell whose neighbours along the two axes have the distances ``a`` and ``b``: where the distance
    grows by ``cost`` a cell. inf: no path leads over that neighbour."""
    low, high = min(a, b), max(a, b)
    if high - low >= cost:
        return low + cost
    return 0.5 * (low + high + math.sqrt(2.0 * cost * cost - (high - low) * (high - low)))


@law
def leave(firsts: IntLine, links: IntTable, cell: int) -> None:
    """Take a cell out of the list in which it waits."""
    before, after = links[cell, 0], links[cell, 1]
    if before == NOBODY:
        firsts[links[cell, 2] & (LISTS - 1)] = after
    else:
        links[before, 1] = after
    if after != NOBODY:
        links[after, 0] = before
    links[cell, 2] = NOBODY


@law
def wait(firsts: IntLine, links: IntTable, cell: int, length: float) -> int:
    """Let a cell wait in the list for its path's cost; returns how many more cells wait now."""
    number, waits = int(length), links[cell, 2]
    if waits == number:
        return 0
    if waits != NOBODY:
        leave(firsts, links, cell)
    at = number & (LISTS - 1)
    after = firsts[at]
    links[cell, 0], links[cell, 1], links[cell, 2], firsts[at] = NOBODY, after, number, cell
    if after != NOBODY:
        links[after, 0] = cell
    return 1 if waits == NOBODY else 0


@law
def march(costs: Line, columns: int, row: float, column: float, firsts: IntLine, links: IntTable, out: Line) -> None:
    """Write what the path of least cost over free cells costs from each cell to a position: its length where each costs
    1.

    Cells wait in lists, by the cost of their path, not in a heap. One that has passed on its way, and then gets a
    cheaper one from a cell of the same list, waits again. So the numbers are those of a heap, in half the time.

    Sources: Sethian, "A fast marching level set method for monotonically advancing fronts", PNAS 93, 1996; Yatziv,
    Bartesaghi and Sapiro, "O(N) implementation of the fast marching algorithm", J. Comput. Phys. 212, 2006 (lists).

    Args:
        costs: of a cell's side of path in each cell, row after row, up to ``COST_MOST``; 0: no path leads there, as at
            the whole edge; shape (rows * columns,).
        columns: of the grid.
        row, column: the position; the middle of the first cell is 0, 0.
        firsts: memory for the lists, shape (LISTS,).
        links: memory for who waits where, shape (rows * columns or more, 3): the cells before and after in a list, and
            the whole number that the list is for.
        out: cost of the path, in cells where each costs 1, shape (rows * columns,); inf where no path leads.
    """
    rows, waiting, number = costs.shape[0] // columns, 0, 0
    for cell in range(costs.shape[0]):
        out[cell] = math.inf
        links[cell, 2] = NOBODY
    for at in range(LISTS):
        firsts[at] = NOBODY
    first, second = int(row + 0.5), int(column + 0.5)
    for i in range(max(first - 1, 0), min(first + 2, rows)):
        for j in range(max(second - 1, 0), min(second + 2, columns)):
            cell = i * columns + j
            if costs[cell] > 0.0:
                out[cell] = costs[cell] * math.sqrt((i - row) * (i - row) + (j - column) * (j - column))
                waiting += wait(firsts, links, cell, out[cell])
    while waiting > 0:
        cell = firsts[number & (LISTS - 1)]
        if cell == NOBODY:
            number += 1
            continue
        leave(firsts, links, cell)
        waiting -= 1
        key = out[cell]
        for side in range(4):
            there = cell + (1 if side == 0 else -1 if side == 1 else columns if side == 2 else -columns)
            cost, before = costs[there], out[there]
            if cost == 0.0 or before <= key:
                continue  # no path there, or as short as one over this cell can be
            length = reach(min(out[there - columns], out[there + columns]), min(out[there - 1], out[there + 1]), cost)
            if length < before:
                out[there] = length
                waiting += wait(firsts, links, there, length)
