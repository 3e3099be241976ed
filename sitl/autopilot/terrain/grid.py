# SPDX-License-Identifier: BSD-3-Clause
"""The grid of heights that MAVLink's terrain protocol knows: blocks of 7 x 8 parts of 4 x 4 points.

A block is known by its south-west corner. Blocks overlap by a part: every square of four points is in one.
https://mavlink.io/en/services/terrain.html
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator, Mapping
from typing import NamedTuple

from ...core.elementary import hypot
from ...core.geodesy import add_offset, offset_ne

SIDE = 4
"""Points of a side of a part."""
ROWS, COLUMNS = 7, 8
PARTS = ROWS * COLUMNS
STRIDE_N, STRIDE_E = (ROWS - 1) * SIDE, (COLUMNS - 1) * SIDE
"""Points from one block to the next."""
_DEGREE = 10_000_000
SPACING, OPTIONS, MARGIN, OFFSET_MAX, SIM_TERRAIN = (
    "TERRAIN_SPACING", "TERRAIN_OPTIONS", "TERRAIN_MARGIN", "TERRAIN_OFS_MAX", "SIM_TERRAIN",
)  # fmt: skip
MEANINGS = {
    SPACING: "Distance between two points of the grid of heights [m], 1 to 10000",
    OPTIONS: "1: nobody is asked for heights of the ground",
    MARGIN: "Greatest distance of an answer's location from what was asked for [m]",
    OFFSET_MAX: "Most that the told height of the ground is corrected by, to be home's where it is armed [m]",
    SIM_TERRAIN: "1: the simulated ground is as high as the heights say, beside where it started",
}
Part = tuple[int, ...]
"""Heights [m above sea level] of 16 points, eastward, then row by row northward; empty: not known."""
NOTHING: tuple[Part, ...] = ((),) * PARTS


class Block(NamedTuple):
    """South-west corner of a block [degE7]."""

    lat: int
    lon: int


Blocks = Mapping[Block, tuple[Part, ...]]
"""Parts by their number: eastward, then northward."""


class Square(NamedTuple):
    """Four points around a location."""

    north: float
    """South-west corner, from the location [m]."""
    east: float
    corners: tuple[int, int, int, int] | None
    """Heights [m]: south-west, south-east, north-west, north-east; None: not all of them are known."""


def block_of(lat: float, lon: float, spacing: float) -> Block:
    """The block in which a location [degE7] lies; ``spacing`` of the points [m]. Blocks count from whole degrees."""
    south, west = math.floor(lat / _DEGREE) * _DEGREE, math.floor(lon / _DEGREE) * _DEGREE
    away, step_n, step_e = offset_ne(south, west, lat, lon), STRIDE_N * spacing, STRIDE_E * spacing
    corner = add_offset(south, west, math.floor(away.x / step_n) * step_n, math.floor(away.y / step_e) * step_e)
    return Block(round(corner.lat), round(corner.lon))


def around(lat: float, lon: float, spacing: float) -> Iterator[Block]:
    """The block in which a location [degE7] lies, and its eight neighbours."""
    here = block_of(lat, lon, spacing)
    yield here
    for north in (-1, 0, 1):
        for east in (-1, 0, 1):
            if north or east:
                step_n, step_e = (0.5 + north) * STRIDE_N * spacing, (0.5 + east) * STRIDE_E * spacing
                yield block_of(*add_offset(here.lat, here.lon, step_n, step_e), spacing)


def between(lat: float, lon: float, end_lat: float, end_lon: float, spacing: float) -> Iterator[Block]:
    """The blocks on the way from one location to another [degE7]."""
    offset = offset_ne(lat, lon, end_lat, end_lon)
    steps = max(math.ceil(hypot(offset.x, offset.y) / (0.5 * STRIDE_N * spacing)), 1)
    for k in range(1, steps + 1):
        yield block_of(*add_offset(lat, lon, offset.x * k / steps, offset.y * k / steps), spacing)


def square_of(blocks: Blocks, lat: float, lon: float, spacing: float) -> Square:
    """The four points around a location [degE7]."""
    block = block_of(lat, lon, spacing)
    position = offset_ne(block.lat, block.lon, lat, lon)
    row = min(max(math.floor(position.x / spacing), 0), ROWS * SIDE - 2)
    column = min(max(math.floor(position.y / spacing), 0), COLUMNS * SIDE - 2)
    found = [_point(blocks.get(block, NOTHING), row + n, column + e) for n in (0, 1) for e in (0, 1)]
    known = [height for height in found if height is not None]
    corners = (known[0], known[1], known[2], known[3]) if len(known) == len(found) else None
    return Square(row * spacing - position.x, column * spacing - position.y, corners)


def _point(parts: tuple[Part, ...], row: int, column: int) -> int | None:
    part = parts[row // SIDE * COLUMNS + column // SIDE]
    return part[row % SIDE * SIDE + column % SIDE] if part else None


def height_of(blocks: Blocks, lat: float, lon: float, spacing: float) -> float | None:
    """Height of the ground at a location [degE7], in metres above sea level, between the four points around it."""
    square = square_of(blocks, lat, lon, spacing)
    if square.corners is None:
        return None
    sw, se, nw, ne = square.corners
    u, w = -square.north / spacing, -square.east / spacing
    south, north = sw + w * (se - sw), nw + w * (ne - nw)
    return south + u * (north - south)


def locations_of(block: Block, part: int, spacing: float) -> Iterator[tuple[float, float]]:
    """The locations [degE7] of the points of a part, as the protocol counts them."""
    for k in range(SIDE * SIDE):
        north = (part // COLUMNS * SIDE + k // SIDE) * spacing
        east = (part % COLUMNS * SIDE + k % SIDE) * spacing
        yield add_offset(block.lat, block.lon, north, east)


def measured(block: Block, part: int, spacing: float, height: Callable[[float, float], float | None]) -> Part | None:
    """A part of a block by a function of latitude and longitude [deg]; None where that does not know a height [m]."""
    found = [height(lat * 1e-7, lon * 1e-7) for lat, lon in locations_of(block, part, spacing)]
    known = tuple(min(max(round(height), -32768), 32767) for height in found if height is not None)
    return known if len(known) == len(found) else None
