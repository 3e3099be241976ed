# SPDX-License-Identifier: BSD-3-Clause
"""A world's solids as flat arrays for compiled code, in NED, with a grid that finds the few that a ray can meet.

Every solid is a rounded rectangle seen from above, between two heights: a box has rounding 0, a cylinder a rectangle
of no size. So contacts know one shape, and a row means the same in a world and in a vehicle's short list.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np
import numpy.typing as npt

from ..core.array_kernels import IntLine, Line, Table
from ..core.elementary import cos, sin
from .shapes import Box, Cylinder, Solid, to_heading, to_ned

Floats = npt.NDArray[np.float64]
Integers = npt.NDArray[np.int64]

# Columns of a solid's row.
NORTH, EAST = 0, 1
"""Middle [m]."""
COS, SIN = 2, 3
"""Of its heading: its own first axis points to (cos, sin) in north and east."""
HALF_LENGTH, HALF_WIDTH = 4, 5
"""Along its own axes [m]."""
RADIUS = 6
"""Rounding [m]: above 0 for a cylinder."""
TOP, BOTTOM = 7, 8
"""Down coordinates [m]: top < bottom."""
SOLID_COLUMNS = 9
"""Numbers in a row."""

# Numbers of the grid.
GRID_NORTH, GRID_EAST = 0, 1
"""South-west corner [m]."""
CELL, PER_METRE = 2, 3
"""Side of a cell [m] and 1 / that."""
ROWS, COLUMNS = 4, 5
"""Cells northward and eastward (whole numbers)."""
FLOOR = 6
"""Down coordinate of the floor [m]."""
GRID_NUMBERS = 7

_MARGIN = 1e-6
"""A solid is listed in every cell that comes this near to it [m]: far more than rounding, so that the walk through the
grid (``raycast.walk``) meets every solid that testing all of them would."""
_CELLS_EACH = 6
"""Cells aimed at for a solid; a few more or less cost little."""
_MOST_CELLS = 65_536
_LEAST_CELL = 0.1
"""[m]."""


class Solids(NamedTuple):
    """A world's solids as laws take them."""

    rows: Table
    """Shape (n, SOLID_COLUMNS)."""
    grid: Line
    """Shape (GRID_NUMBERS,)."""
    cells: IntLine
    """See ``Geometry``."""


@dataclass(frozen=True, eq=False)
class Geometry:
    """What ray casting and contacts work on; pickles as it is."""

    solids: Floats
    """Shape (n, SOLID_COLUMNS): a row a solid, in the order of the world's solids."""
    grid: Floats
    """Shape (GRID_NUMBERS,)."""
    cells: Integers
    """ROWS * COLUMNS + 1 offsets in this array, where each cell's list begins; then the lists: numbers of solids."""

    def __len__(self) -> int:
        return len(self.solids)

    @property
    def arrays(self) -> Solids:
        """All that laws need."""
        return Solids(self.solids, self.grid, self.cells)

    @property
    def floor(self) -> float:
        """Down coordinate of the floor [m]."""
        return float(self.grid[FLOOR])


def compile_geometry(solids: Sequence[Solid], floor_z: float, cells_each: int = _CELLS_EACH) -> Geometry:
    """The arrays of a world.

    Args:
        solids: of a world file, in its frame.
        floor_z: height of the floor [m].
        cells_each: about how many cells the grid has for a solid; 0 makes a single cell that lists all.
    """
    rows = np.array([_row(solid) for solid in solids], dtype=np.float64).reshape(-1, SOLID_COLUMNS)
    grid, cells = _grid(rows, 0.0 - floor_z, cells_each)
    return Geometry(rows, grid, cells)


def _row(solid: Solid) -> list[float]:
    north, east, _ = to_ned(*solid.centre)
    _, _, top = to_ned(0.0, 0.0, solid.high)
    _, _, bottom = to_ned(0.0, 0.0, solid.low)
    if isinstance(solid, Cylinder):
        return [north, east, 1.0, 0.0, 0.0, 0.0, solid.radius, top, bottom]
    assert isinstance(solid, Box)
    heading = to_heading(solid.yaw)
    half_length, half_width = 0.5 * solid.size[0], 0.5 * solid.size[1]
    return [north, east, cos(heading), sin(heading), half_length, half_width, 0.0, top, bottom]


def _extents(rows: Floats) -> tuple[Floats, Floats]:
    """Half lengths northward and eastward of the solids' bounding rectangles [m]."""
    c, s = np.abs(rows[:, COS]), np.abs(rows[:, SIN])
    length, width, radius = rows[:, HALF_LENGTH], rows[:, HALF_WIDTH], rows[:, RADIUS]
    return c * length + s * width + radius, s * length + c * width + radius


def _grid(rows: Floats, floor: float, cells_each: int) -> tuple[Floats, Integers]:
    if not len(rows):
        return np.array([0.0, 0.0, 1.0, 1.0, 0.0, 0.0, floor]), np.zeros(1, np.int64)
    north, east = _extents(rows)
    low = np.array([(rows[:, NORTH] - north).min(), (rows[:, EAST] - east).min()]) - _MARGIN
    high = np.array([(rows[:, NORTH] + north).max(), (rows[:, EAST] + east).max()]) + _MARGIN
    extent = high - low
    wanted = min(cells_each * len(rows), _MOST_CELLS // 2)
    cell = max(math.sqrt(extent[0] * extent[1] / wanted), _LEAST_CELL) if wanted else float(extent.max()) + _MARGIN
    cell = max(cell, float(extent.max()) / 4096)  # a long narrow world
    n_rows, n_columns = (math.ceil(length / cell) for length in extent)
    lists: list[list[int]] = [[] for _ in range(n_rows * n_columns)]
    for number, row in enumerate(rows):
        for r, c in _cells_near(row, low, cell, (n_rows, n_columns), north[number], east[number]):
            lists[r * n_columns + c].append(number)
    begins = len(lists) + 1 + np.cumsum([0, *map(len, lists)])
    cells = np.concatenate([begins, np.array([n for numbers in lists for n in numbers])]).astype(np.int64)
    grid = np.array([low[0], low[1], cell, 1.0 / cell, float(n_rows), float(n_columns), floor])
    return grid, cells


def _cells_near(
    row: Floats, low: Floats, cell: float, shape: tuple[int, int], north: float, east: float
) -> list[tuple[int, int]]:
    """Row and column of every cell within the margin of the solid (of its axes' slabs: a few more at round corners)."""
    middle, half = row[[NORTH, EAST]], np.array([north, east]) + _MARGIN
    first = np.maximum(np.floor((middle - half - low) / cell).astype(int), 0)
    last = np.minimum(np.floor((middle + half - low) / cell).astype(int), np.array(shape) - 1)
    rs, cs = np.meshgrid(np.arange(first[0], last[0] + 1), np.arange(first[1], last[1] + 1), indexing="ij")
    dn = low[0] + (rs + 0.5) * cell - row[NORTH]
    de = low[1] + (cs + 0.5) * cell - row[EAST]
    c, s = row[COS], row[SIN]
    reach = 0.5 * cell * (abs(c) + abs(s)) + row[RADIUS] + _MARGIN  # of a cell along the solid's axes
    near = (np.abs(c * dn + s * de) <= row[HALF_LENGTH] + reach) & (np.abs(c * de - s * dn) <= row[HALF_WIDTH] + reach)
    return [(int(r), int(k)) for r, k in zip(rs[near], cs[near])]
