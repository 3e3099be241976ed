# SPDX-License-Identifier: BSD-3-Clause
"""Start poses of episodes: the world's, a given one, or a random one that the robot can reach."""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from typing import Any, NamedTuple

import numpy as np
import numpy.typing as npt

from sitl.core.algebra import ZERO2
from sitl.core.array_kernels import IntLine, IntTable, Kernel, Table
from sitl.core.kernels import law
from sitl.core.vectors import Vec2
from sitl.turtlebots.native import full_pose
from sitl.worlds import World, WorldError
from sitl.worlds.contact import Volume, clearance, distance, separation
from sitl.worlds.geometry import COS, EAST, HALF_LENGTH, HALF_WIDTH, NORTH, RADIUS, SIN
from sitl.worlds.shapes import to_ned

from .options import EnvOptionError
from .robots.robot import Pose, Robot

CELL = 0.1
"""Side of a grid cell in the search for reachable positions [m]."""
_MAX_CELLS = 250_000
"""Number of cells above which cells are made larger, as long as no wall fits between two of them."""
_CELL_LIMIT = 4_000_000
"""Number of cells above which a world is refused."""
_MAX_POSES = 100_000
_MARGIN = 0.1
"""Distance that a random position keeps from what would be a crash [m]."""

StartOption = str | Sequence[float] | Callable[[np.random.Generator], Sequence[float]]
"""Name of one of the world's start poses, "turned", "random", "random:N", a pose, or a function that draws one.

"turned" is the world's start position for the robot with a random heading. "random:N" is one of N random poses, always
the same ones: a vehicle with an autopilot calculates its state after take-off once for each of them."""


class Grid(NamedTuple):
    """Cells of which ``north`` grows with the row, and ``east`` falls with the column."""

    first: Vec2
    """North and east of the centre of cell (0, 0) [m]."""
    cell: float
    """Side of a cell [m]."""


@law
def mark_free(solids: Table, grid: Grid, robot: Volume, margin: float, out: IntTable) -> None:
    """Mark the cells of a grid in whose centre a robot can stand with a margin to solids.

    Args:
        solids: rows of a ``Geometry``.
        grid: of the cells.
        robot: its volume, anywhere.
        margin: distance to keep to solids [m].
        out: shape (rows, columns), 1 for free.
    """
    first, cell, rows, columns = grid.first, grid.cell, out.shape[0], out.shape[1]
    for i in range(rows):
        for j in range(columns):
            out[i, j] = 1
    for k in range(solids.shape[0]):
        length, width, c, s = solids[k, HALF_LENGTH], solids[k, HALF_WIDTH], abs(solids[k, COS]), abs(solids[k, SIN])
        near = robot.radius + margin + solids[k, RADIUS] + cell
        north, east = c * length + s * width + near, s * length + c * width + near
        low, high = (solids[k, NORTH] - north - first.x) / cell, (solids[k, NORTH] + north - first.x) / cell
        left, right = (first.y - solids[k, EAST] - east) / cell, (first.y - solids[k, EAST] + east) / cell
        for i in range(max(int(low), 0), min(int(high) + 2, rows)):
            for j in range(max(int(left), 0), min(int(right) + 2, columns)):
                there = Vec2(first.x + cell * i, first.y - cell * j)
                volume = Volume(there, robot.top, robot.bottom, robot.radius)
                if not separation(solids, k, volume).distance > margin:
                    out[i, j] = 0


@law
def flood(free: IntTable, row: int, column: int, todo: IntLine) -> None:
    """Mark the free cells that are connected to a cell, and that cell itself, with 2.

    Args:
        free: 1 where a cell is free.
        row, column: of the cell.
        todo: memory, as long as there are cells.
    """
    rows, columns, count = free.shape[0], free.shape[1], 1
    todo[0] = row * columns + column
    free[row, column] = 2
    while count > 0:
        count -= 1
        i, j = todo[count] // columns, todo[count] % columns
        for side in range(4):
            a = i + (1 if side == 0 else -1 if side == 1 else 0)
            b = j + (1 if side == 2 else -1 if side == 3 else 0)
            if 0 <= a < rows and 0 <= b < columns and free[a, b] == 1:
                free[a, b] = 2
                todo[count] = a * columns + b
                count += 1


_mark_free, _flood = Kernel(mark_free), Kernel(flood)


class ReachableCells:
    """Positions that a robot can reach from its start pose without a crash, as cells of a grid.

    Args:
        robot: robot whose start pose and volume are used.
        crash_range: a reading below it is a crash [m]; None: the robot's.
        most: above so many cells, cells are made larger.
        world: where; None: the robot's.
    """

    def __init__(
        self,
        robot: Robot,
        crash_range: float | None = None,
        most: int = _MAX_CELLS,
        world: World | None = None,
    ) -> None:
        self._world, self._volume = world or robot.world, robot.volume
        crash_range = robot.crash_range if crash_range is None else crash_range
        self.margin = _MARGIN + max(crash_range - robot.volume.radius, 0.0)
        """Free distance around the robot [m]."""
        start = self._world.start(robot.name)
        self.z = start.position[2]
        x0, y0, x1, y1 = self._world.bounds
        reach = robot.volume.radius + self.margin
        self.low = np.array([x0 - reach, y0 - reach])
        """x, y of the first cell's corner [m]."""
        extent = np.array([x1 + reach, y1 + reach]) - self.low
        largest = 1.9 * reach  # even the thinnest wall makes a band of twice the reach that no middle of a cell is in
        self.cell = max(CELL, min(math.sqrt(float(extent[0] * extent[1]) / most), largest))
        """Side of a cell [m]."""
        rows, columns = (math.ceil(length / self.cell) for length in extent.tolist())
        self.shape = rows, columns
        """Cells along x and y."""
        if rows * columns > _CELL_LIMIT:
            size = f"{extent[0]:.0f} x {extent[1]:.0f} m"
            raise EnvOptionError(
                f"random positions in world {self._world.name!r}: {size} is too large; say where instead"
            )
        first = ((np.array(start.position[:2]) - self.low) / self.cell).astype(int).tolist()
        free = self._free(rows, columns)
        is_free = bool(free[first[0], first[1]])
        _flood(free, first[0], first[1], np.empty(free.size, np.int64))
        self.cells = np.argwhere(free == 2).astype(np.min_scalar_type(max(rows, columns)))
        """Indices of the cells along x and y, shape (n, 2); the first one is included even when it is not free."""
        if len(self.cells) == 1 and not is_free:
            where = f"random positions in world {self._world.name!r}"
            raise EnvOptionError(f"{where}: {robot.name} has no room at start {start.name!r} to set out")

    def _free(self, rows: int, columns: int) -> npt.NDArray[np.int64]:
        out = np.empty((rows, columns), np.int64)
        x, y = (self.low + 0.5 * self.cell).tolist()
        north, east, down = to_ned(x, y, self.z)
        v = self._volume
        geometry = self._world.geometry
        robot = Volume(ZERO2, down - v.top, down - v.bottom, v.radius)
        _mark_free(geometry.solids, Grid(Vec2(north, east), self.cell), robot, self.margin, out)
        return out

    def is_free(self, x: float, y: float) -> bool:
        """Whether the robot can stand at x, y [m] in the world frame, with the margin."""
        north, east, down = to_ned(x, y, self.z)
        v = self._volume
        return distance(self._world.geometry, north, east, down - v.top, down - v.bottom, v.radius) > self.margin

    def draw(self, rng: np.random.Generator) -> tuple[float, float]:
        """A random reachable position: x, y [m] in the world frame."""
        while True:
            cell = self.cells[rng.integers(len(self.cells))]
            x, y = (self.low + self.cell * (cell + rng.random(2))).tolist()
            if self.is_free(x, y):
                return x, y


class Turned:
    """Draws poses at one position with a random heading.

    Args:
        position: x, y, z in the world frame [m].
    """

    def __init__(self, position: Sequence[float]) -> None:
        self.position = position

    def __call__(self, rng: np.random.Generator) -> Pose:
        """A start pose: x, y, z [m], yaw [rad] in the world frame."""
        x, y, z = self.position
        return (x, y, z, float(rng.uniform(-math.pi, math.pi)))


class Near:
    """Draws poses about one, uniformly.

    Args:
        pose: the middle: x, y [m], yaw [rad] in the world frame.
        spread: greatest difference of each.
    """

    def __init__(self, pose: Sequence[float], spread: Sequence[float]) -> None:
        self.pose, self.spread = np.array(pose, np.float64), np.array(spread, np.float64)

    def __call__(self, rng: np.random.Generator) -> tuple[float, ...]:
        """A start pose: x, y [m], yaw [rad] in the world frame."""
        x, y, yaw = (self.pose + self.spread * rng.uniform(-1.0, 1.0, 3)).tolist()
        return x, y, math.remainder(yaw, math.tau)


class OneOf:
    """Draws one of some poses with equal probability."""

    def __init__(self, poses: Sequence[Pose]) -> None:
        self.poses = poses

    def __call__(self, rng: np.random.Generator) -> Pose:
        """A start pose: x, y, z [m], yaw [rad] in the world frame."""
        return self.poses[int(rng.integers(len(self.poses)))]


class Starts:
    """Draws start poses.

    Args:
        option: see ``StartOption``.
        robot: robot that starts there.
        world: where; None: the robot's.

    Raises:
        EnvOptionError: unknown start, or an invalid pose.
    """

    def __init__(self, option: StartOption | None, robot: Robot, world: World | None = None) -> None:
        self._robot, self._world = robot, world or robot.world
        self._draw: Callable[[np.random.Generator], Any] | None = None
        self._cells: ReachableCells | None = None
        self._z = self._world.start(robot.name).position[2]
        self.fixed: Pose | None = None
        """The start pose, where there is one only."""
        if isinstance(option, str) and option == "random":
            self._cells = ReachableCells(robot, world=self._world)
        elif isinstance(option, str) and option.startswith("random:"):
            self._draw = self._few(option, ReachableCells(robot, world=self._world))
        elif isinstance(option, str) and option == "turned":
            start = self._world.start(robot.name)
            self._draw = Turned(start.position)
        elif option is None or isinstance(option, str):
            try:
                start = self._world.start(robot.name, option)
            except WorldError as error:
                raise EnvOptionError(f'start {option!r}: {error}, "turned" and "random"') from None
            self.fixed = self.pose((*start.position, start.yaw))
        elif callable(option):
            self._draw = option
        else:
            self.fixed = self.pose(option)

    def _few(self, option: str, cells: ReachableCells) -> Callable[[np.random.Generator], Any]:
        """Draws from N random poses, for the option "random:N"."""
        try:
            count = int(option.removeprefix("random:"))
        except ValueError:
            count = 0
        if not 1 <= count <= _MAX_POSES:
            raise EnvOptionError(f'start {option!r}; it must be "random:N" with N from 1 to {_MAX_POSES}')
        rng = np.random.default_rng(0)
        return OneOf([(*cells.draw(rng), self._z, float(rng.uniform(-math.pi, math.pi))) for _ in range(count)])

    def pose(self, pose: Any) -> Pose:
        """Complete a pose (x, y, yaw) or (x, y, z, yaw) to x, y, z [m], yaw [rad].

        Raises:
            EnvOptionError: invalid pose, or one inside of a solid.
        """
        try:
            found = full_pose(pose, self._z)
        except ValueError as error:
            raise EnvOptionError(f"start: {error}") from None
        self._check_clearance(found)
        return found

    def _check_clearance(self, pose: Pose) -> None:
        """Refuse a pose inside of a solid: all readings are 0 there, which is no crash, so the robot could drive
        out."""
        north, east, down = to_ned(*pose[:3])
        volume, world = self._robot.volume, self._world
        volume_there = world.geometry, north, east, down - volume.top, down - volume.bottom, 0.0
        if distance(*volume_there) < 0.0:
            solid = world.solids[clearance(*volume_there).solid]
            what = f"{type(solid).__name__.lower()} {solid.name!r}"
            x, y, z, _ = pose
            raise EnvOptionError(f"start: ({x:g}, {y:g}, {z:g}) in world {world.name!r} is inside of {what}")

    def draw(self, rng: np.random.Generator) -> Pose:
        """A start pose: x, y, z [m], yaw [rad] in the world frame."""
        if self.fixed is not None:
            return self.fixed
        if self._cells is not None:
            x, y = self._cells.draw(rng)
            return (x, y, self._z, float(rng.uniform(-math.pi, math.pi)))
        assert self._draw is not None
        return self.pose(self._draw(rng))
