# SPDX-License-Identifier: BSD-3-Clause
"""The marching of ways over a grid, beside the same equations solved with a heap."""

from __future__ import annotations

import heapq
import math

import numpy as np
import pytest

from sitl.envs.marching import COST_MOST, LISTS, march, reach
from sitl.envs.shortest_paths import BESIDE

SIDES = ((1, 0), (-1, 0), (0, 1), (0, -1))


def marched(costs, row, column):
    rows, columns = costs.shape
    edged = np.pad(costs, 1).ravel()
    out = np.empty(edged.size)
    march(
        edged, columns + 2, row + 1.0, column + 1.0, np.empty(LISTS, np.int64), np.empty((edged.size, 3), np.int64), out
    )
    assert not np.isfinite(out[edged == 0.0]).any()
    return out.reshape(rows + 2, columns + 2)[1:-1, 1:-1]


def by_a_heap(costs, row, column):
    """Sethian's own way: the cell with the cheapest way is passed first."""
    found, waiting = np.full(costs.shape, math.inf), []

    def at(i, j):
        return found[i, j] if 0 <= i < costs.shape[0] and 0 <= j < costs.shape[1] else math.inf

    for i, j in np.argwhere(costs > 0.0):
        if abs(i - math.floor(row + 0.5)) <= 1 and abs(j - math.floor(column + 0.5)) <= 1:
            found[i, j] = costs[i, j] * math.hypot(i - row, j - column)
            heapq.heappush(waiting, (found[i, j], i, j))
    while waiting:
        length, i, j = heapq.heappop(waiting)
        for down, right in SIDES if length == found[i, j] else ():
            a, b = i + down, j + right
            if 0 <= a < costs.shape[0] and 0 <= b < costs.shape[1] and costs[a, b] > 0.0:
                new = reach(min(at(a - 1, b), at(a + 1, b)), min(at(a, b - 1), at(a, b + 1)), costs[a, b])
                if new < found[a, b]:
                    found[a, b] = new
                    heapq.heappush(waiting, (new, a, b))
    return found


@pytest.mark.parametrize("seed", range(12))
def test_the_numbers_are_those_of_a_heap(seed):
    rng = np.random.default_rng(seed)
    shape = tuple(rng.integers(1, 26, 2))
    costs = np.where(rng.random(shape) < (0.0, 0.2, 0.35)[seed % 3], 0.0, 1.0)
    if seed % 2:
        costs *= 1.0 + 5.0 * rng.random(shape) ** 2
    row, column = rng.random(2) * (shape[0] - 1, shape[1] - 1)
    found, wanted = marched(costs, row, column), by_a_heap(costs, row, column)
    assert np.array_equal(found.astype(np.float32), wanted.astype(np.float32))


def test_what_a_cell_of_a_route_costs_does_not_reach_round_all_lists():
    diagonal = 1.5 * math.sqrt(2.0)  # of a place to a cell that begins with it
    assert 1.0 + BESIDE <= COST_MOST and COST_MOST * diagonal < LISTS


def test_no_way_leads_to_a_cell_that_is_shut_in_nor_from_a_place_that_is():
    costs = np.ones((5, 5))
    costs[1:4, 1:4] = 0.0
    costs[2, 2] = 1.0
    assert np.isfinite(marched(costs, 0.0, 0.0)).sum() == 16
    assert np.isfinite(marched(costs, 2.0, 2.0)).sum() == 1
    costs[2, 2] = 0.0
    assert not np.isfinite(marched(costs, 2.0, 2.0)).any()
