# SPDX-License-Identifier: BSD-3-Clause
"""Ray casting in three dimensions: how far it is from a point along directions to the nearest solid or the floor.

All in NED, metres, unit vectors; directions are stored as three rows (norths, easts, downs). The laws work on the
arrays of a ``Geometry`` and can be called from other compiled code; ``scan`` and ``scan_from`` are for the shell.

Two ways give the same bits, since the least of the same numbers is the same whoever else is tested: ``sweep`` takes
every solid to groups of rays at once (the processor does several rays with one instruction) and leaves out what a group
cannot meet: solids out of reach, above, below or beside it. ``walk`` takes a ray through the grid and tests the solids
that are listed in its cells. The first is quicker until there are very many solids.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from ..core.algebra import rotate
from ..core.array_kernels import IntLine, Kernel, Line, Table
from ..core.kernels import inlined, law
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
from .planar import INF, TINY, Span, crossing, first_of, over_rectangle, to_box, to_cylinder, to_floor

MANY = 128
"""From so many solids on a scan walks through the grid: measured, see docs/worlds.md."""
GROUP = 32
"""Rays that are swept at once: fewer see fewer solids, more are quicker to test. Scans of up to two groups are not
parted."""
_MARGIN = 0.001
"""[m]"""
_ROUNDING = 1e-9
"""How far a ray of unit length may be on the wrong side of a plane."""


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
        square = row * columns + column
        for item in range(cells[square], cells[square + 1]):
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


class Sight(NamedTuple):
    """What rays from a point can meet within their reach, with a margin for rounding and for directions that are not
    quite units."""

    reach: float
    """Seen from above [m]."""
    top: float
    """Down coordinate of the highest point [m]."""
    bottom: float
    """Down coordinate of the lowest point [m]."""
    is_fan: bool
    """There are several groups, and seen from above the rays of each are all to the right of its first one and to the
    left of its last one, or all the other way round."""


@law
def sight_of(origin: Vec3, directions: Table, reach: float) -> Sight:
    """What rays can meet within their reach [m]."""
    rise, fall, outside = 0.0, 0.0, 0.0
    norths, easts, downs = directions[0], directions[1], directions[2]
    rays = directions.shape[1]
    for k in range(rays):
        down = downs[k]
        rise = down if down < rise else rise
        fall = down if down > fall else fall
    is_fan = rays > 2 * GROUP
    for first in range(0, rays if is_fan else 0, GROUP):
        end = min(first + GROUP, rays)
        side = sides(Vec2(norths[first], easts[first]), Vec2(norths[end - 1], easts[end - 1]))
        for k in range(first, end):
            left = norths[k] * side.left.x + easts[k] * side.left.y
            right = norths[k] * side.right.x + easts[k] * side.right.y
            inside = left if left < right else right
            outside = inside if inside < outside else outside
    far = 1.001 * reach + _MARGIN
    top = origin.z - _MARGIN + (rise * far if rise < 0.0 else 0.0)
    bottom = origin.z + _MARGIN + (fall * far if fall > 0.0 else 0.0)
    return Sight(far, top, bottom, is_fan and outside > -_ROUNDING)


class Sides(NamedTuple):
    """Normals (north, east), no longer than units, of the two upright planes between which a group of rays is: towards
    the rays."""

    left: Vec2
    right: Vec2


@inlined
def sides(first: Vec2, last: Vec2) -> Sides:
    """The sides of a group of rays from the directions of the first and the last one (north, east)."""
    turn = 1.0 if first.x * last.y > first.y * last.x else -1.0  # from the first to the last: 1 to the right
    return Sides(Vec2(-turn * first.y, turn * first.x), Vec2(turn * last.y, -turn * last.x))


class Face(NamedTuple):
    """A solid as a ray's origin sees it."""

    cos: float
    """Of its heading."""
    sin: float
    start: Vec2
    """The origin, from the solid's middle along its own axes [m]."""
    half: Vec2
    """Half lengths along those [m]."""
    radius: float
    """Rounding [m]."""
    heights: Span
    """Top and bottom, down from the origin [m]."""


@inlined
def face(rows: Table, j: int, origin: Vec3) -> Face:
    """The solid of row ``j``."""
    c, s = rows[j, COS], rows[j, SIN]
    dn, de = origin.x - rows[j, NORTH], origin.y - rows[j, EAST]
    start, half = Vec2(c * dn + s * de, c * de - s * dn), Vec2(rows[j, HALF_LENGTH], rows[j, HALF_WIDTH])
    heights = Span(rows[j, TOP] - origin.z, rows[j, BOTTOM] - origin.z)
    return Face(c, s, start, half, rows[j, RADIUS], heights)


@inlined
def is_behind(f: Face, normal: Vec2) -> bool:
    """Whether a solid is all on the other side of an upright plane through the origin; ``normal``: north, east."""
    x, y = f.cos * normal.x + f.sin * normal.y, f.cos * normal.y - f.sin * normal.x
    return f.half.x * abs(x) + f.half.y * abs(y) + f.radius + _MARGIN < x * f.start.x + y * f.start.y


class Group(NamedTuple):
    """Rays that lie side by side; shapes (rays,)."""

    norths: Line
    """Their directions, unit vectors NED."""
    easts: Line
    downs: Line
    ranges: Line
    """How far it is along them to what they meet [m]."""


@inlined
def sweep_group(f: Face, offset: Vec2, is_wall: bool, group: Group) -> None:
    """Test one solid for all rays of a group.

    Args:
        f: the solid.
        offset: the origin, from the solid's middle (north, east) [m].
        is_wall: all rays stay between its top and bottom within their reach: a division less for each.
        group: the rays.
    """
    norths, easts, downs, ranges = group.norths, group.easts, group.downs, group.ranges
    if f.radius > 0.0:
        for k in range(len(ranges)):
            met = to_cylinder(offset, f.radius, f.heights, Vec3(norths[k], easts[k], downs[k]))
            ranges[k] = met if met < ranges[k] else ranges[k]
    elif is_wall:
        c, s = f.cos, f.sin
        for k in range(len(ranges)):
            vn, ve = norths[k], easts[k]
            over = over_rectangle(f.start, f.half, Vec3(c * vn + s * ve, c * ve - s * vn, downs[k]))
            met = first_of(over, Span(0.0, INF))
            ranges[k] = met if met < ranges[k] else ranges[k]
    else:
        c, s = f.cos, f.sin
        for k in range(len(ranges)):
            vn, ve = norths[k], easts[k]
            met = to_box(f.start, f.half, f.heights, Vec3(c * vn + s * ve, c * ve - s * vn, downs[k]))
            ranges[k] = met if met < ranges[k] else ranges[k]


@law
def sweep_rays(solids: Solids, origin: Vec3, directions: Table, reach: float, out: Line) -> None:
    """Ranges [m] along many rays from one point, by testing every solid in reach for all groups of rays that may meet
    it."""
    rows, rays = solids.rows, out.shape[0]
    norths, easts, downs = directions[0], directions[1], directions[2]
    floor = solids.grid[FLOOR] - origin.z
    for k in range(rays):
        out[k] = to_floor(floor, downs[k])
    sight = sight_of(origin, directions, reach)
    whole = Group(norths, easts, downs, out)
    for j in range(rows.shape[0]):
        f = face(rows, j, origin)
        if rows[j, TOP] > sight.bottom or rows[j, BOTTOM] < sight.top:
            continue
        far = sight.reach + f.radius
        if abs(f.start.x) - f.half.x > far or abs(f.start.y) - f.half.y > far:
            continue
        offset = Vec2(origin.x - rows[j, NORTH], origin.y - rows[j, EAST])
        is_wall = rows[j, TOP] < sight.top and rows[j, BOTTOM] > sight.bottom
        if not sight.is_fan:
            sweep_group(f, offset, is_wall, whole)
            continue
        for first in range(0, rays, GROUP):
            end = min(first + GROUP, rays)
            side = sides(Vec2(norths[first], easts[first]), Vec2(norths[end - 1], easts[end - 1]))
            if not is_behind(f, side.left) and not is_behind(f, side.right):
                group = Group(norths[first:end], easts[first:end], downs[first:end], out[first:end])
                sweep_group(f, offset, is_wall, group)


@law
def scan_rays(solids: Solids, origin: Vec3, directions: Table, reach: float, out: Line) -> None:
    """Ranges [m] along many rays from one point, the quicker way; what is beyond ``reach`` [m] may read as inf."""
    if solids.rows.shape[0] < MANY:
        sweep_rays(solids, origin, directions, reach, out)
    else:
        walk_rays(solids, origin, directions, out)


@law
def scan_point(rows: Table, grid: Line, cells: IntLine, origin: Line, directions: Table, out: Line) -> None:
    """``scan_rays`` of the arrays of a ``Geometry`` and a point of three numbers."""
    scan_rays(Solids(rows, grid, cells), Vec3(origin[0], origin[1], origin[2]), directions, INF, out)


class Scene(NamedTuple):
    """Bodies with a sensor each, and memory to work in."""

    positions: Table
    """NED [m], shape (m, 3)."""
    attitudes: Table
    """Quaternions (w, x, y, z) from body (FRD) to NED, shape (m, 4)."""
    mount: Line
    """Position of the sensor on the body, FRD [m], shape (3,)."""
    rays: Table
    """Unit vectors on the body, FRD, shape (3, n)."""
    directions: Table
    """Memory, as ``rays``."""


@law
def scan_bodies(solids: Solids, scene: Scene, out: Table) -> None:
    """Ranges [m] seen by a sensor on each of many bodies; see ``scan_from``."""
    positions, attitudes, mount = scene.positions, scene.attitudes, scene.mount
    for i in range(positions.shape[0]):
        q = Quat(attitudes[i, 0], attitudes[i, 1], attitudes[i, 2], attitudes[i, 3])
        at = rotate(q, Vec3(mount[0], mount[1], mount[2]))
        turn_rays(q, scene.rays, scene.directions)
        origin = at + Vec3(positions[i, 0], positions[i, 1], positions[i, 2])
        scan_rays(solids, origin, scene.directions, INF, out[i])


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
        mount: position of the sensor on the body, FRD [m], shape (3,).
        rays: unit vectors on the body, FRD, shape (3, n), as from ``planar.rays``.
        out: shape (m, n). The arrays are contiguous float64.
    """
    _scan_bodies(geometry.arrays, Scene(positions, attitudes, mount, rays, np.empty_like(rays)), out)
    return out
