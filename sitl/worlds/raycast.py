# SPDX-License-Identifier: BSD-3-Clause
"""Ray casting in three dimensions: how far it is from a point along directions to the nearest solid or the floor.

All in NED, metres, unit vectors; directions are stored as three rows (norths, easts, downs). The laws work on the
arrays of a ``Geometry`` and can be called from other compiled code; ``scan`` and ``scan_from`` are for the shell.

Two ways give the same bits, since the least of the same numbers is the same: ``sweep`` takes every solid to all rays at
once (the processor does several rays with one instruction), ``walk`` takes a ray through the grid and tests the solids
that are listed in its cells. The first is quicker until there are very many solids.
"""

from __future__ import annotations

import numpy as np

from ..core.array_kernels import kernel
from ..core.kernels import law
from ..core.rotations import quat_rotate
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
)
from .rays import INF, TINY, crossing, to_box, to_cylinder, to_floor

MANY = 128
"""From so many solids on a scan walks through the grid: measured, see docs/worlds.md."""


@law
def to_solid(solids, k, n, e, d, vn, ve, vd):
    """Range to the solid of row ``k`` from n, e, d along vn, ve, vd."""
    c, s = solids[k, COS], solids[k, SIN]
    dn, de = n - solids[k, NORTH], e - solids[k, EAST]
    top, bottom = solids[k, TOP] - d, solids[k, BOTTOM] - d
    if solids[k, RADIUS] > 0.0:
        return to_cylinder(dn, de, solids[k, RADIUS], top, bottom, vn, ve, vd)
    x, y, vx, vy = c * dn + s * de, c * de - s * dn, c * vn + s * ve, c * ve - s * vn
    return to_box(x, y, solids[k, HALF_LENGTH], solids[k, HALF_WIDTH], top, bottom, vx, vy, vd)


@law
def walk(solids, grid, cells, n, e, d, vn, ve, vd):
    """Range along one ray to the nearest solid or the floor, through the cells of the grid that lie below the ray.

    Ends when what was met lies before the next cell. A solid is listed in every cell that comes near it, so rounding in
    the walk cannot pass one by.
    """
    nearest = to_floor(grid[FLOOR] - d, vd)
    cell, rows, columns = grid[CELL], int(grid[ROWS]), int(grid[COLUMNS])
    if rows == 0:
        return nearest
    north, east = n - grid[GRID_NORTH], e - grid[GRID_EAST]
    enter, leave = crossing(-north, cell * rows - north, vn)
    enter2, leave2 = crossing(-east, cell * columns - east, ve)
    enter = max(max(enter, enter2), 0.0)
    if enter > min(leave, leave2) or enter >= nearest:
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
            met = to_solid(solids, cells[item], n, e, d, vn, ve, vd)
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
def walk_rays(solids, grid, cells, n, e, d, directions, out):
    """Ranges along many rays from one point, by ``walk``."""
    for k in range(out.shape[0]):
        out[k] = walk(solids, grid, cells, n, e, d, directions[0, k], directions[1, k], directions[2, k])


@law
def sweep_rays(solids, grid, n, e, d, directions, out):
    """Ranges along many rays from one point, by testing every solid for all rays."""
    rays = out.shape[0]
    floor = grid[FLOOR] - d
    for k in range(rays):
        out[k] = to_floor(floor, directions[2, k])
    for j in range(solids.shape[0]):
        c, s = solids[j, COS], solids[j, SIN]
        dn, de = n - solids[j, NORTH], e - solids[j, EAST]
        top, bottom = solids[j, TOP] - d, solids[j, BOTTOM] - d
        radius = solids[j, RADIUS]
        if radius > 0.0:
            for k in range(rays):
                met = to_cylinder(dn, de, radius, top, bottom, directions[0, k], directions[1, k], directions[2, k])
                out[k] = met if met < out[k] else out[k]
        else:
            x, y = c * dn + s * de, c * de - s * dn
            length, width = solids[j, HALF_LENGTH], solids[j, HALF_WIDTH]
            for k in range(rays):
                vn, ve = directions[0, k], directions[1, k]
                met = to_box(x, y, length, width, top, bottom, c * vn + s * ve, c * ve - s * vn, directions[2, k])
                out[k] = met if met < out[k] else out[k]


@law
def scan_rays(solids, grid, cells, n, e, d, directions, out):
    """Ranges along many rays from one point, the quicker way."""
    if solids.shape[0] < MANY:
        sweep_rays(solids, grid, n, e, d, directions, out)
    else:
        walk_rays(solids, grid, cells, n, e, d, directions, out)


@law
def scan_point(solids, grid, cells, origin, directions, out):
    """Ranges along many rays from the point ``origin`` (three numbers); see ``scan``."""
    scan_rays(solids, grid, cells, origin[0], origin[1], origin[2], directions, out)


@law
def scan_bodies(solids, grid, cells, positions, attitudes, mount, rays, directions, out):
    """Ranges seen by a sensor on each of many bodies; see ``scan_from``. ``directions``: room to work, as ``rays``."""
    for i in range(positions.shape[0]):
        w, x, y, z = attitudes[i, 0], attitudes[i, 1], attitudes[i, 2], attitudes[i, 3]
        n, e, d = quat_rotate(w, x, y, z, mount[0], mount[1], mount[2])
        for k in range(rays.shape[1]):
            vn, ve, vd = quat_rotate(w, x, y, z, rays[0, k], rays[1, k], rays[2, k])
            directions[0, k], directions[1, k], directions[2, k] = vn, ve, vd
        scan_rays(
            solids, grid, cells, n + positions[i, 0], e + positions[i, 1], d + positions[i, 2], directions, out[i]
        )


_scan = kernel("void(f8[:,::1], f8[::1], i8[::1], f8[::1], f8[:,::1], f8[::1])")(scan_point)
_scan_bodies = kernel(
    "void(f8[:,::1], f8[::1], i8[::1], f8[:,::1], f8[:,::1], f8[::1], f8[:,::1], f8[:,::1], f8[:,::1])"
)(scan_bodies)
walked = kernel("void(f8[:,::1], f8[::1], i8[::1], f8, f8, f8, f8[:,::1], f8[::1])")(walk_rays)
"""``walk_rays``, compiled: for tests and measurements."""
swept = kernel("void(f8[:,::1], f8[::1], f8, f8, f8, f8[:,::1], f8[::1])")(sweep_rays)
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
    room = np.empty_like(rays)
    _scan_bodies(geometry.solids, geometry.grid, geometry.cells, positions, attitudes, mount, rays, room, out)
    return out
