# SPDX-License-Identifier: BSD-3-Clause
"""Pictures of a world by a pinhole camera: depth, and colour, of the same solids that rays and contacts meet.

A pixel is one ray through its middle, so there is no blur and no anti-aliasing, and the same position gives the same
bits. A solid is tested only for the pixels of the rectangle that its corners span in the picture.
"""

from __future__ import annotations

import math
from collections.abc import Iterator
from copy import copy
from typing import NamedTuple

import numpy as np
import numpy.typing as npt

from ..core.algebra import conjugate, rotate
from ..core.array_kernels import ByteLine, IntLine, Kernel, Line, NarrowLine, Table
from ..core.elementary import cos, sin
from ..core.kernels import inlined, law
from ..core.vectors import Quat, Vec2, Vec3
from .geometry import (
    BOTTOM,
    COS,
    EAST,
    FLOOR,
    HALF_LENGTH,
    HALF_WIDTH,
    NORTH,
    RADIUS,
    SIN,
    SOLID_COLUMNS,
    TOP,
    Floats,
    Solids,
)
from .planar import to_box, to_cylinder, to_floor
from .raycast import face, ray, turn_rays
from .shapes import Marking, to_heading, to_ned
from .tables import COLOURS
from .world import World

NEAR = 0.01
"""What has a corner nearer than this in front of the camera is tested for all pixels [m]."""
GROUND, SKY = -1, -2
"""What a ray meets that meets no solid."""
AMBIENT = 0.45
"""Share of the light that comes from everywhere; the rest comes from the sun."""
SUN = Vec3(-0.48, 0.36, -0.80)
"""Where it stands, a unit vector NED: south-east, high."""
ZENITH, HORIZON = (0.45, 0.62, 0.88), (0.80, 0.86, 0.92)
"""Colours of the sky."""
TILE, TILE_CONTRAST = 1.0, 0.12
"""The floor is chequered: side of a square [m], and how much darker every other one is."""
# Columns of a marking's row.
MARK_NORTH, MARK_EAST, MARK_COS, MARK_SIN, MARK_LENGTH, MARK_WIDTH, MARK_RADIUS, MARK_RED = range(8)
MARK_COLUMNS = 10


class Camera(NamedTuple):
    """A pinhole camera; its picture is ``height`` rows of ``width`` pixels, from the top left."""

    width: int
    height: int
    slope: float
    """Of the ray through the middle of the right edge: the tangent of half the horizontal field of view."""
    reach: float
    """Depths beyond it read as it [m]."""


class Workspace(NamedTuple):
    """Memory to work in, for n pixels."""

    rays: Table
    """(1, u, v): forward, right, down on the camera, shape (3, n): a range along such a ray is a depth."""
    directions: Table
    """The same NED, shape (3, n)."""
    depths: Line
    """[m], shape (n,)."""
    met: IntLine
    """Number of the solid, ``GROUND`` or ``SKY``, shape (n,)."""


class Paint(NamedTuple):
    """Colours of a world: shares of red, green and blue."""

    solids: Table
    """Shape (solids, 3)."""
    markings: Table
    """Position and shape (NED [m]) and colour, shape (markings, MARK_COLUMNS)."""


class Window(NamedTuple):
    """Pixels from ``left`` and ``top`` to before ``right`` and ``bottom``."""

    left: int
    right: int
    top: int
    bottom: int


@inlined
def pixel(at: float, slope: float, count: int) -> int:
    """Number of the pixel at a tangent, clipped to -1 .. ``count``."""
    return int(min(max((at / slope + 1.0) * 0.5 * count, -1.0), count + 1.0))


@law
def window_of(rows: Table, j: int, eye: Vec3, q: Quat, camera: Camera) -> Window:
    """The pixels in which the solid of row ``j`` may be: those between its corners; none when it is behind the camera
    or out of reach."""
    level = conjugate(q)
    c, s = rows[j, COS], rows[j, SIN]
    length, width = rows[j, HALF_LENGTH] + rows[j, RADIUS], rows[j, HALF_WIDTH] + rows[j, RADIUS]
    nearest, farthest = math.inf, -math.inf
    left, right, top, bottom = math.inf, -math.inf, math.inf, -math.inf
    for corner in range(8):
        along = length if corner & 1 else -length
        across = width if corner & 2 else -width
        down = rows[j, BOTTOM] if corner & 4 else rows[j, TOP]
        north, east = rows[j, NORTH] + c * along - s * across, rows[j, EAST] + s * along + c * across
        seen = rotate(level, Vec3(north - eye.x, east - eye.y, down - eye.z))
        nearest, farthest = min(nearest, seen.x), max(farthest, seen.x)
        if seen.x > NEAR:
            u, v = seen.y / seen.x, seen.z / seen.x
            left, right, top, bottom = min(left, u), max(right, u), min(top, v), max(bottom, v)
    if farthest < NEAR or nearest > camera.reach:
        return Window(0, 0, 0, 0)
    if nearest <= NEAR:
        return Window(0, camera.width, 0, camera.height)
    slope, upright = camera.slope, camera.slope * camera.height / camera.width
    return Window(
        max(pixel(left, slope, camera.width) - 1, 0),
        min(pixel(right, slope, camera.width) + 2, camera.width),
        max(pixel(top, upright, camera.height) - 1, 0),
        min(pixel(bottom, upright, camera.height) + 2, camera.height),
    )


@law
def see(solids: Solids, eye: Vec3, q: Quat, camera: Camera, workspace: Workspace) -> None:
    """Cast the rays of a camera at ``eye`` (NED [m]) of attitude ``q`` (camera, forward right down, to NED): fills
    ``workspace.depths`` (inf: nothing) and ``workspace.met``."""
    turn_rays(q, workspace.rays, workspace.directions)
    norths, easts, downs = workspace.directions[0], workspace.directions[1], workspace.directions[2]
    depths, met, rows = workspace.depths, workspace.met, solids.rows
    floor = solids.grid[FLOOR] - eye.z
    for k in range(depths.shape[0]):
        depths[k] = to_floor(floor, downs[k])
        met[k] = SKY if depths[k] == math.inf else GROUND
    for j in range(rows.shape[0]):
        window = window_of(rows, j, eye, q, camera)
        if window.right <= window.left or window.bottom <= window.top:
            continue
        f = face(rows, j, eye)
        offset = Vec2(eye.x - rows[j, NORTH], eye.y - rows[j, EAST])
        for line in range(window.top, window.bottom):
            for k in range(line * camera.width + window.left, line * camera.width + window.right):
                n, e = norths[k], easts[k]
                if f.radius > 0.0:
                    depth = to_cylinder(offset, f.radius, f.heights, Vec3(n, e, downs[k]))
                else:
                    turned = Vec3(f.cos * n + f.sin * e, f.cos * e - f.sin * n, downs[k])
                    depth = to_box(f.start, f.half, f.heights, turned)
                if depth < depths[k]:
                    depths[k], met[k] = depth, j


@law
def normal_at(rows: Table, j: int, at: Vec3) -> Vec3:
    """Outward normal (NED) of the solid of row ``j`` where a ray has met it [m]."""
    c, s = rows[j, COS], rows[j, SIN]
    dn, de = at.x - rows[j, NORTH], at.y - rows[j, EAST]
    along, across = c * dn + s * de, c * de - s * dn
    middle, half = 0.5 * (rows[j, TOP] + rows[j, BOTTOM]), 0.5 * (rows[j, BOTTOM] - rows[j, TOP])
    upright = abs(at.z - middle) - half
    if rows[j, RADIUS] > 0.0:
        out = math.sqrt(dn * dn + de * de)
        if upright > out - rows[j, RADIUS]:
            return Vec3(0.0, 0.0, 1.0 if at.z > middle else -1.0)
        return Vec3(dn / max(out, NEAR), de / max(out, NEAR), 0.0)
    ahead, aside = abs(along) - rows[j, HALF_LENGTH], abs(across) - rows[j, HALF_WIDTH]
    if upright > ahead and upright > aside:
        return Vec3(0.0, 0.0, 1.0 if at.z > middle else -1.0)
    side = 1.0 if (along if ahead > aside else across) > 0.0 else -1.0
    return Vec3(side * c, side * s, 0.0) if ahead > aside else Vec3(-side * s, side * c, 0.0)


@law
def on_marking(marks: Table, j: int, at: Vec3) -> bool:
    """Whether a position of the floor is on the marking of row ``j``."""
    dn, de = at.x - marks[j, MARK_NORTH], at.y - marks[j, MARK_EAST]
    if marks[j, MARK_RADIUS] > 0.0:
        return dn * dn + de * de <= marks[j, MARK_RADIUS] * marks[j, MARK_RADIUS]
    c, s = marks[j, MARK_COS], marks[j, MARK_SIN]
    return abs(c * dn + s * de) <= marks[j, MARK_LENGTH] and abs(c * de - s * dn) <= marks[j, MARK_WIDTH]


@law
def floor_colour(marks: Table, at: Vec3) -> Vec3:
    """Of a position of the floor: the last marking there, else chequered grey."""
    square = math.floor(at.x / TILE) + math.floor(at.y / TILE)
    grey = 0.62 - (TILE_CONTRAST if square % 2 != 0 else 0.0)
    found = Vec3(grey, grey, grey)
    for j in range(marks.shape[0]):
        if on_marking(marks, j, at):
            found = Vec3(marks[j, MARK_RED], marks[j, MARK_RED + 1], marks[j, MARK_RED + 2])
    return found


@law
def colour_of(solids: Solids, paint: Paint, eye: Vec3, direction: Vec3, depth: float, met: int) -> Vec3:
    """What a ray sees: shares of red, green and blue."""
    if met == SKY:
        up = max(-direction.z, 0.0) / math.sqrt(
            direction.x * direction.x + direction.y * direction.y + direction.z * direction.z
        )
        return Vec3(
            HORIZON[0] + up * (ZENITH[0] - HORIZON[0]),
            HORIZON[1] + up * (ZENITH[1] - HORIZON[1]),
            HORIZON[2] + up * (ZENITH[2] - HORIZON[2]),
        )
    at = Vec3(eye.x + depth * direction.x, eye.y + depth * direction.y, eye.z + depth * direction.z)
    if met == GROUND:
        light = AMBIENT - (1.0 - AMBIENT) * SUN.z
        return light * floor_colour(paint.markings, at)
    normal = normal_at(solids.rows, met, at)
    towards = normal.x * SUN.x + normal.y * SUN.y + normal.z * SUN.z
    light = AMBIENT + (1.0 - AMBIENT) * max(towards, 0.0)
    return light * Vec3(paint.solids[met, 0], paint.solids[met, 1], paint.solids[met, 2])


@law
def eye_of(poses: Table, i: int) -> Vec3:
    """Position of camera ``i``."""
    return Vec3(poses[i, 0], poses[i, 1], poses[i, 2])


@law
def attitude_of(poses: Table, i: int) -> Quat:
    """Attitude of camera ``i``."""
    return Quat(poses[i, 3], poses[i, 4], poses[i, 5], poses[i, 6])


@law
def write_depths(solids: Solids, poses: Table, camera: Camera, workspace: Workspace, out: NarrowLine) -> None:
    """Depths [m] of many cameras, one picture after another.

    Args:
        solids: of the world.
        poses: of the cameras, NED [m], and attitudes (w, x, y, z), shape (m, 7).
        camera: of all.
        room: to work in.
        out: shape (m * height * width,).
    """
    n = workspace.depths.shape[0]
    for i in range(poses.shape[0]):
        see(solids, eye_of(poses, i), attitude_of(poses, i), camera, workspace)
        for k in range(n):
            out[i * n + k] = min(workspace.depths[k], camera.reach)


@law
def write_colours(
    solids: Solids, paint: Paint, poses: Table, camera: Camera, workspace: Workspace, out: ByteLine
) -> None:
    """Colours of many cameras, 0 to 255, one picture after another; arguments as of ``write_depths``, ``out`` of shape
    (m * height * width * 3,): red, green, blue."""
    n = workspace.depths.shape[0]
    for i in range(poses.shape[0]):
        eye = eye_of(poses, i)
        see(solids, eye, attitude_of(poses, i), camera, workspace)
        for k in range(n):
            seen = colour_of(solids, paint, eye, ray(workspace.directions, k), workspace.depths[k], workspace.met[k])
            first = 3 * (i * n + k)
            out[first] = int(255.0 * min(seen.x, 1.0) + 0.5)
            out[first + 1] = int(255.0 * min(seen.y, 1.0) + 0.5)
            out[first + 2] = int(255.0 * min(seen.z, 1.0) + 0.5)


_depths = Kernel(write_depths)
_colours = Kernel(write_colours)
DISC = 5
"""Numbers of an upright disc that moves about: north, east of its axis, radius, down coordinates of its top and of its
bottom [m]."""
DISC_COLOUR = "orange"


class Photographer:
    """Cameras of one kind in a world.

    Args:
        world: what is seen.
        camera: of all.

    Methods take ``discs``: what each camera sees besides, as other vehicles, shape (m, n, ``DISC``); None: nothing.
    """

    def __init__(self, world: World, camera: Camera) -> None:
        self.camera = camera
        self._solids, self._paint = world.geometry.arrays, paint_of(world)
        width, height = camera.width, camera.height
        across = camera.slope * (2.0 * (np.arange(width) + 0.5) / width - 1.0)
        below = camera.slope * (2.0 * (np.arange(height) + 0.5) - height) / width
        v, u = np.meshgrid(below, across, indexing="ij")
        rays = np.ascontiguousarray(np.stack([np.ones(u.size), u.ravel(), v.ravel()]))
        self._workspace = Workspace(rays, np.empty_like(rays), np.zeros(u.size), np.zeros(u.size, np.int64))

    def in_world(self, world: World) -> Photographer:
        """The same cameras in another world. They share memory to work in: one takes pictures after the other."""
        made = copy(self)
        made._solids, made._paint = world.geometry.arrays, paint_of(world)
        return made

    def depths(self, poses: Floats, discs: Floats | None = None) -> npt.NDArray[np.float32]:
        """Depths along the camera's axis [m], shape (m, height, width), of cameras at ``poses`` (``write_depths``)."""
        out = np.empty((len(poses), self.camera.height, self.camera.width), np.float32)
        for some, solids, _ in self._looks(len(poses), discs):
            _depths(solids, poses[some], self.camera, self._workspace, out[some].reshape(-1))
        return out

    def colours(self, poses: Floats, discs: Floats | None = None) -> npt.NDArray[np.uint8]:
        """Red, green, blue, shape (m, height, width, 3)."""
        out = np.empty((len(poses), self.camera.height, self.camera.width, 3), np.uint8)
        for some, solids, paint in self._looks(len(poses), discs):
            _colours(solids, paint, poses[some], self.camera, self._workspace, out[some].reshape(-1))
        return out

    def _looks(self, count: int, discs: Floats | None) -> Iterator[tuple[slice, Solids, Paint]]:
        """Which cameras see which solids."""
        if discs is None or discs.shape[1] == 0:
            yield slice(count), self._solids, self._paint
            return
        colour = np.tile(COLOURS[DISC_COLOUR], (discs.shape[1], 1))
        fixed, coloured = np.asarray(self._solids.rows), np.asarray(self._paint.solids)
        paint = self._paint._replace(solids=np.concatenate((coloured, colour)))
        for i in range(count):
            rows = np.zeros((discs.shape[1], SOLID_COLUMNS))
            rows[:, (NORTH, EAST, RADIUS, TOP, BOTTOM)] = discs[i]
            rows[:, COS] = 1.0
            solids = self._solids._replace(rows=np.concatenate((fixed, rows)))
            yield slice(i, i + 1), solids, paint


def paint_of(world: World) -> Paint:
    """The colours of a world."""
    solids = np.array([COLOURS[solid.colour] for solid in world.solids], np.float64).reshape(-1, 3)
    return Paint(solids, np.array([_mark(m) for m in world.markings], np.float64).reshape(-1, MARK_COLUMNS))


def _mark(marking: Marking) -> tuple[float, ...]:
    north, east, _ = to_ned(*marking.centre, 0.0)
    heading = to_heading(marking.yaw)
    length, width = (0.5 * side for side in marking.size)
    return north, east, cos(heading), sin(heading), length, width, marking.radius, *COLOURS[marking.colour]
