# SPDX-License-Identifier: BSD-3-Clause
"""Ray casting in three dimensions: how far it is from a point along directions to the nearest solid or the floor.

All in NED, metres, unit vectors; directions are stored as three rows (norths, easts, downs). The laws work on the
arrays of a ``Geometry`` and can be called from other compiled code; ``scan`` and ``scan_from`` are for the shell.

Two ways give the same bits, since the least of the same numbers is the same: ``sweep`` takes every solid to all rays at
once (the processor does several rays with one instruction), ``walk`` takes a ray through the grid and tests the solids
that are listed in its cells. The first is quicker until there are very many solids.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from ..core.algebra import rotate
from ..core.array_kernels import IntLine, Kernel, Line, Table
from ..core.kernels import law
from ..core.vectors import Quat, Vec2, Vec3
from .geometry import (
    BOTTOM,
    CELL,
    COLUMNS,
    COS,
    EAST,
    FLOOR,
    GRID_EAST,
    GRID_NORTH,
    HALF_LENGTH,
    HALF_WIDTH,
    NORTH,
    PER_METRE,
    RADIUS,
    ROWS,
    SIN,
    TOP,
    Floats,
    Geometry,
    Solids,
)
from .planar import INF, TINY, Span, crossing, to_box, to_cylinder, to_floor

MANY = 128
"""From so many solids on a scan walks through the grid: measured, see docs/worlds.md."""


@law
def to_solid(rows: Table, k: int, origin: Vec3, direction: Vec3) -> float:
    """Range to the solid of row ``k``."""
    c, s = rows[k, COS], rows[k, SIN]
    dn, de = origin.x - rows[k, NORTH], origin.y - rows[k, EAST]
    heights = Span(rows[k, TOP] - origin.z, rows[k, BOTTOM] - origin.z)
    if rows[k, RADIUS] > 0.0:
        return to_cylinder(Vec2(dn, de), rows[k, RADIUS], heights, direction)
    start, half = Vec2(c * dn + s * de, c * de - s * dn), Vec2(rows[k, HALF_LENGTH], rows[k, HALF_WIDTH])
    along, across = c * direction.x + s * direction.y, c * direction.y - s * direction.x
    return to_box(start, half, heights, Vec3(along, across, direction.z))


@law
def walk(solids: Solids, origin: Vec3, direction: Vec3) -> float:
    """Range along one ray to the nearest solid or the floor, through the cells of the grid that lie below the ray.

    Ends when what was met lies before the next cell. A solid is listed in every cell that comes near it, so rounding in
    the walk cannot pass one by.
    """
    grid, cells, vn, ve = solids.grid, solids.cells, direction.x, direction.y
    nearest = to_floor(grid[FLOOR] - origin.z, direction.z)
    cell, rows, columns = grid[CELL], int(grid[ROWS]), int(grid[COLUMNS])
    if rows == 0:
        return nearest
    north, east = origin.x - grid[GRID_NORTH], origin.y - grid[GRID_EAST]
    over_rows = crossing(-north, cell * rows - north, vn)
    over_columns = crossing(-east, cell * columns - east, ve)
    enter = max(max(over_rows.enter, over_columns.enter), 0.0)
    if enter > min(over_rows.leave, over_columns.leave) or enter >= nearest:
        return nearest
    row = min(max(int((north + enter * vn) * grid[PER_METRE]), 0), rows - 1)
    column = min(max(int((east + enter * ve) * grid[PER_METRE]), 0), columns - 1)
    row_step, row_edge = (1, 1) if vn > 0.0 else (-1, 0)
    column_step, column_edge = (1, 1) if ve > 0.0 else (-1, 0)
    north_bound, east_bound = abs(vn) > TINY, abs(ve) > TINY
    row_pace = 1.0 / (vn if north_bound else 1.0)
    column_pace = 1.0 / (ve if east_bound else 1.0)
    while True:
        place = row * columns + column
        for item in range(cells[place], cells[place + 1]):
            met = to_solid(solids.rows, cells[item], origin, direction)
            nearest = met if met < nearest else nearest
        row_end = (cell * (row + row_edge) - north) * row_pace if north_bound else INF
        column_end = (cell * (column + column_edge) - east) * column_pace if east_bound else INF
        if nearest <= min(row_end, column_end):
            return nearest
        if row_end < column_end:
            row += row_step
            if row < 0 or row >= rows:
                return nearest
        else:
            column += column_step
            if column < 0 or column >= columns:
                return nearest


@law
def ray(directions: Table, k: int) -> Vec3:
    """Direction ``k``, NED, of three rows (norths, easts, downs)."""
    return Vec3(directions[0, k], directions[1, k], directions[2, k])


@law
def turn_rays(q: Quat, rays: Table, directions: Table) -> None:
    """Turn rays on a body (FRD) of attitude ``q`` into the world (NED), into ``directions``; both have shape (3, n)."""
    for k in range(rays.shape[1]):
        turned = rotate(q, ray(rays, k))
        directions[0, k], directions[1, k], directions[2, k] = turned.x, turned.y, turned.z


@law
def walk_rays(solids: Solids, origin: Vec3, directions: Table, out: Line) -> None:
    """Ranges [m] along many rays from one point, by ``walk``."""
    for k in range(out.shape[0]):
        out[k] = walk(solids, origin, ray(directions, k))


@law
def sweep_rays(solids: Solids, origin: Vec3, directions: Table, out: Line) -> None:
    """Ranges [m] along many rays from one point, by testing every solid for all rays."""
    rows, rays = solids.rows, out.shape[0]
    floor = solids.grid[FLOOR] - origin.z
    for k in range(rays):
        out[k] = to_floor(floor, directions[2, k])
    for j in range(rows.shape[0]):
        c, s = rows[j, COS], rows[j, SIN]
        dn, de = origin.x - rows[j, NORTH], origin.y - rows[j, EAST]
        heights = Span(rows[j, TOP] - origin.z, rows[j, BOTTOM] - origin.z)
        radius = rows[j, RADIUS]
        if radius > 0.0:
            for k in range(rays):
                met = to_cylinder(Vec2(dn, de), radius, heights, ray(directions, k))
                out[k] = met if met < out[k] else out[k]
        else:
            start, half = Vec2(c * dn + s * de, c * de - s * dn), Vec2(rows[j, HALF_LENGTH], rows[j, HALF_WIDTH])
            for k in range(rays):
                v = ray(directions, k)
                met = to_box(start, half, heights, Vec3(c * v.x + s * v.y, c * v.y - s * v.x, v.z))
                out[k] = met if met < out[k] else out[k]


@law
def scan_rays(solids: Solids, origin: Vec3, directions: Table, out: Line) -> None:
    """Ranges [m] along many rays from one point, the quicker way."""
    if solids.rows.shape[0] < MANY:
        sweep_rays(solids, origin, directions, out)
    else:
        walk_rays(solids, origin, directions, out)


@law
def scan_point(rows: Table, grid: Line, cells: IntLine, origin: Line, directions: Table, out: Line) -> None:
    """``scan_rays`` of the arrays of a ``Geometry`` and a point of three numbers."""
    scan_rays(Solids(rows, grid, cells), Vec3(origin[0], origin[1], origin[2]), directions, out)


class Scene(NamedTuple):
    """Bodies with a sensor each, and room to work in."""

    positions: Table
    """NED [m], shape (m, 3)."""
    attitudes: Table
    """Quaternions (w, x, y, z) from body (FRD) to NED, shape (m, 4)."""
    mount: Line
    """Place of the sensor on the body, FRD [m], shape (3,)."""
    rays: Table
    """Unit vectors on the body, FRD, shape (3, n)."""
    directions: Table
    """Room, as ``rays``."""


@law
def scan_bodies(solids: Solids, scene: Scene, out: Table) -> None:
    """Ranges [m] seen by a sensor on each of many bodies; see ``scan_from``."""
    positions, attitudes, mount = scene.positions, scene.attitudes, scene.mount
    for i in range(positions.shape[0]):
        q = Quat(attitudes[i, 0], attitudes[i, 1], attitudes[i, 2], attitudes[i, 3])
        at = rotate(q, Vec3(mount[0], mount[1], mount[2]))
        turn_rays(q, scene.rays, scene.directions)
        origin = at + Vec3(positions[i, 0], positions[i, 1], positions[i, 2])
        scan_rays(solids, origin, scene.directions, out[i])


_scan = Kernel(scan_point)
_scan_bodies = Kernel(scan_bodies)
walked = Kernel(walk_rays)
"""``walk_rays``, compiled: for tests and measurements."""
swept = Kernel(sweep_rays)
"""``sweep_rays``, compiled: for tests and measurements."""


def scan(geometry: Geometry, origin: Floats, directions: Floats, out: Floats) -> Floats:
    """Ranges [m] from one point along many directions, into ``out``, which is returned.

    Args:
        geometry: of a world.
        origin: north, east, down [m], shape (3,).
        directions: unit vectors in NED, shape (3, n).
        out: shape (n,). The arrays are contiguous float64.
    """
    _scan(geometry.solids, geometry.grid, geometry.cells, origin, directions, out)
    return out


def scan_from(
    geometry: Geometry, positions: Floats, attitudes: Floats, mount: Floats, rays: Floats, out: Floats
) -> Floats:
    """Ranges [m] seen by a sensor on each of many bodies, in one call, into ``out``, which is returned.

    Args:
        geometry: of a world.
        positions: of the bodies, NED [m], shape (m, 3).
        attitudes: quaternions (w, x, y, z) from body (FRD) to NED, shape (m, 4).
        mount: place of the sensor on the body, FRD [m], shape (3,).
        rays: unit vectors on the body, FRD, shape (3, n), as from ``planar.rays``.
        out: shape (m, n). The arrays are contiguous float64.
    """
    _scan_bodies(geometry.arrays, Scene(positions, attitudes, mount, rays, np.empty_like(rays)), out)
    return out
