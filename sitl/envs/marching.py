# SPDX-License-Identifier: BSD-3-Clause
"""The fast marching method: lengths of the shortest ways over a grid to one place."""

from __future__ import annotations

import math

from sitl.core.array_kernels import IntLine, Line, Table
from sitl.core.kernels import law


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
def reach(a: float, b: float, cost: float) -> float:
    """Distance of a cell whose neighbours along the two axes have the distances ``a`` and ``b``: where the distance
    grows by ``cost`` a cell. inf: no way leads over that neighbour."""
    low, high = min(a, b), max(a, b)
    if high - low >= cost:
        return low + cost
    return 0.5 * (low + high + math.sqrt(2.0 * cost * cost - (high - low) * (high - low)))


@law
def march(costs: Table, row: float, column: float, keys: Line, items: IntLine, out: Table) -> None:
    """Write what the way of least cost over free cells costs from each cell to a place: its length where each costs 1.

    Source: Sethian, "A fast marching level set method for monotonically advancing fronts", PNAS 93, 1996.

    Args:
        costs: of a cell's side of way in each cell; 0: no way leads there; shape (rows, columns).
        row, column: the place; the middle of the first cell is 0, 0.
        keys, items: room for the heap, shape (4 * rows * columns + 9,).
        out: cost of the way, in cells where each costs 1, shape (rows, columns); inf where no way leads.
    """
    rows, columns, count = costs.shape[0], costs.shape[1], 0
    for i in range(rows):
        for j in range(columns):
            out[i, j] = math.inf
    first, second = int(row + 0.5), int(column + 0.5)
    for i in range(max(first - 1, 0), min(first + 2, rows)):
        for j in range(max(second - 1, 0), min(second + 2, columns)):
            if costs[i, j] > 0.0:
                out[i, j] = costs[i, j] * math.sqrt((i - row) * (i - row) + (j - column) * (j - column))
                count = push(keys, items, count, out[i, j], i * columns + j)
    while count > 0:
        key, row_now, column_now = keys[0], items[0] // columns, items[0] % columns
        count = pop(keys, items, count)
        if key > out[row_now, column_now]:
            continue
        for side in range(4):
            i = row_now + (1 if side == 0 else -1 if side == 1 else 0)
            j = column_now + (1 if side == 2 else -1 if side == 3 else 0)
            if i < 0 or j < 0 or i >= rows or j >= columns or costs[i, j] == 0.0 or out[i, j] <= key:
                continue  # no way there, or as short as one over this cell can be
            a = min(out[i - 1, j] if i > 0 else math.inf, out[i + 1, j] if i + 1 < rows else math.inf)
            b = min(out[i, j - 1] if j > 0 else math.inf, out[i, j + 1] if j + 1 < columns else math.inf)
            there = reach(a, b, costs[i, j])
            if there < out[i, j]:
                out[i, j] = there
                count = push(keys, items, count, there, i * columns + j)
