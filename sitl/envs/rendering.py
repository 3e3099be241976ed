# SPDX-License-Identifier: BSD-3-Clause
"""The view from above: world, robot, its trail and what its lidar reads. Needs pygame; no screen for "rgb_array"."""

from __future__ import annotations

import math
import os
import sys
from collections.abc import Sequence
from typing import Any

import numpy as np
import numpy.typing as npt
from gymnasium.error import DependencyNotInstalled

from sitl.worlds import Marking, Solid

from .robots.robot import Robot, world_of
from .targets.gates import Gates
from .targets.target_task import TargetTask
from .tasks import ReachGoal, Task

RENDER_MODES = ["rgb_array", "human", "window"]
SIZE = 640
"""Longer side of an image [pixels]."""
PHOTOGRAPH = (640, 480)
"""Width and height of an image by a physics engine's renderer [pixels]."""
_BORDER = 0.5
"""Margin around the world [m]."""
_ROUND_GATES = 2.5
"""Space round the middle of a gate, for the turns of who passes it [m]."""
_PAPER, _WALL, _LOW_WALL = (250, 250, 247), (62, 68, 76), (190, 194, 198)
_RAY, _TRAIL, _BODY, _CRASHED, _NOSE = (222, 168, 90), (70, 130, 180), (40, 90, 160), (200, 50, 40), (255, 255, 255)
_GOAL = (60, 150, 80)
_SCREENS = ("DISPLAY", "WAYLAND_DISPLAY", "SDL_VIDEODRIVER")
"""Variables that say where windows are shown, or by which of SDL's drivers."""


def _pygame() -> Any:
    try:
        import pygame
    except ImportError:
        raise DependencyNotInstalled("rendering needs pygame: pip install 'gym-sitl[viz]'") from None
    return pygame


def _check_screen() -> None:
    """Refuse to open a window that nobody can see, unless the user names SDL's driver.

    Raises:
        DependencyNotInstalled: there is no screen.
    """
    if sys.platform.startswith("linux") and not any(os.environ.get(name) for name in _SCREENS):
        raise DependencyNotInstalled(
            'render_mode "window" finds no screen (neither DISPLAY nor WAYLAND_DISPLAY is set); "rgb_array" needs none'
        )


def tile(pictures: Sequence[npt.NDArray[np.uint8]]) -> npt.NDArray[np.uint8]:
    """Pictures of one size in a grid, row by row, about as many rows as columns; what is left over is black.

    Args:
        pictures: each of shape (height, width, 3).

    Returns:
        shape (rows * height, columns * width, 3).
    """
    columns = math.ceil(math.sqrt(len(pictures)))
    rows = math.ceil(len(pictures) / columns)
    height, width = pictures[0].shape[:2]
    out = np.zeros((rows * height, columns * width, 3), np.uint8)
    for k, picture in enumerate(pictures):
        y, x = height * (k // columns), width * (k % columns)
        out[y : y + height, x : x + width] = picture
    return out


class Renderer:
    """Draws one robot of a ``Robot`` in its world.

    Args:
        robot: robot whose world, pose and readings are drawn.
        task: task whose goal is drawn, if it has one.
        index: index of the robot.
    """

    def __init__(self, robot: Robot, task: Task, index: int = 0) -> None:
        self._robot, self._task, self._index = robot, task, index
        self._world = world_of(robot, index)
        extent = self._fit()
        self._scale = SIZE / max(extent)
        self._shape = tuple(max(math.ceil(length * self._scale), 64) for length in extent)
        self.trail: list[tuple[float, float]] = []
        """Position of the robot after each step [pixels]."""
        self._plan: Any = None
        self._with_trail: Any = None
        """The plan with the trail drawn so far."""
        self._drawn = 0
        self._canvas: Any = None
        self._window: Any = None

    def _fit(self) -> tuple[float, float]:
        """Note where the world begins; its lengths along x and y, with a border [m]."""
        task = self._task
        x0, y0, x1, y1 = self._world.bounds
        if isinstance(task, TargetTask):
            low, high = task.arena_at(self._index)
            x0, y0, x1, y1 = min(x0, low[0]), min(y0, low[1]), max(x1, high[0]), max(y1, high[1])
        for gate in task.gates_at(self._index) if isinstance(task, Gates) else ():
            x0, y0 = min(x0, gate.x - _ROUND_GATES), min(y0, gate.y - _ROUND_GATES)
            x1, y1 = max(x1, gate.x + _ROUND_GATES), max(y1, gate.y + _ROUND_GATES)
        self._low = (x0 - _BORDER, y0 - _BORDER)
        return x1 - x0 + 2.0 * _BORDER, y1 - y0 + 2.0 * _BORDER

    def _enter(self) -> None:
        """Draw the world that the robot is in now, in pictures of the same size."""
        world = world_of(self._robot, self._index)
        if world is not self._world:
            self._world, self._plan = world, None
            self._scale = min(size / length for size, length in zip(self._shape, self._fit(), strict=True))

    def _point(self, x: float, y: float) -> tuple[float, float]:
        """World x, y [m] to image coordinates [pixels]: x to the right, y up."""
        return (x - self._low[0]) * self._scale, self._shape[1] - (y - self._low[1]) * self._scale

    def start(self) -> None:
        """Start an episode with an empty trail."""
        self._enter()
        self.trail = []
        self._with_trail = None
        self.note()

    def note(self) -> None:
        """Add the robot's position to the trail."""
        x, y = self._robot.pose[self._index, :2].tolist()
        self.trail.append(self._point(x, y))

    def _draw_plan(self, pygame: Any) -> Any:
        plan = pygame.Surface(self._shape)
        plan.fill(_PAPER)
        world = self._world
        for marking in world.markings:
            self._draw_marking(pygame, plan, marking)
        at = world.plan_height
        for solid in sorted(world.solids, key=lambda s: s.low <= at <= s.high):
            self._draw_solid(pygame, plan, solid, _WALL if solid.low <= at <= solid.high else _LOW_WALL)
        return plan

    def _draw_marking(self, pygame: Any, plan: Any, marking: Marking) -> None:
        points = [self._point(*p) for p in marking.footprint().tolist()]
        pygame.draw.polygon(plan, pygame.Color(marking.colour).lerp(_PAPER, 0.7), points)
        pygame.draw.aalines(plan, pygame.Color(marking.colour), True, points)

    def _draw_solid(self, pygame: Any, plan: Any, solid: Solid, colour: tuple[int, int, int]) -> None:
        points = [self._point(*p) for p in solid.footprint().tolist()]
        pygame.draw.polygon(plan, colour, points)
        pygame.draw.aalines(plan, colour, True, points)

    def _draw(self) -> Any:
        pygame = _pygame()
        if self._plan is None:
            self._plan = self._draw_plan(pygame)
            self._canvas = pygame.Surface(self._shape)
        if self._with_trail is None:
            self._with_trail, self._drawn = self._plan.copy(), 1
        if len(self.trail) > self._drawn:
            pygame.draw.lines(self._with_trail, _TRAIL, False, self.trail[self._drawn - 1 :], 2)
            self._drawn = len(self.trail)
        canvas, robot = self._canvas, self._robot
        canvas.blit(self._with_trail, (0, 0))
        if isinstance(self._task, ReachGoal):
            self._draw_target(pygame, *self._task.goals[self._index].tolist())
        elif isinstance(self._task, Gates):
            self._draw_gates(pygame, self._task)
        elif isinstance(self._task, TargetTask):
            present = min(int(self._task.at[self._index]), self._task.per_robot - 1)
            for x, y, _ in self._task.positions[self._index, present:].tolist():
                self._draw_target(pygame, x, y)
        x, y, _, yaw = robot.pose[self._index].tolist()
        middle = self._point(x, y)
        for angle, reading in zip(robot.angles.tolist(), robot.scan[self._index].tolist()):
            if reading <= robot.range_max:  # one that meets nothing would only hide the rest
                end = self._point(x + reading * math.cos(yaw + angle), y + reading * math.sin(yaw + angle))
                pygame.draw.aaline(canvas, _RAY, middle, end)
        radius = max(robot.volume.radius * self._scale, 4.0)
        crashed = bool(robot.collided[self._index])
        pygame.draw.circle(canvas, _CRASHED if crashed else _BODY, middle, radius)
        nose = (middle[0] + radius * math.cos(yaw), middle[1] - radius * math.sin(yaw))
        pygame.draw.line(canvas, _NOSE, middle, nose, max(int(0.25 * radius), 1))
        return canvas

    def _draw_target(self, pygame: Any, x: float, y: float) -> None:
        radius = getattr(self._task, "radius", 0.0)
        pygame.draw.circle(self._canvas, _GOAL, self._point(x, y), max(radius * self._scale, 3.0), 2)

    def _draw_gates(self, pygame: Any, task: Gates) -> None:
        """Their lines; that of the next one is thick."""
        gates = task.gates_at(self._index)
        present = int(task.at[self._index]) % len(gates)
        for k, gate in enumerate(gates):
            across = 0.5 * gate.width * np.array([-math.sin(gate.yaw), math.cos(gate.yaw)])
            ends = [self._point(*(np.array([gate.x, gate.y]) + sign * across).tolist()) for sign in (-1.0, 1.0)]
            pygame.draw.line(self._canvas, _GOAL, *ends, 5 if k == present else 2)

    def picture(self) -> npt.NDArray[np.uint8]:
        """An image, shape (height, width, 3), uint8: by the physics engine's renderer if it has one, else from
        above."""
        photograph = getattr(self._robot, "photograph", None)
        taken = None if photograph is None else photograph(self._index, *PHOTOGRAPH)
        if taken is not None:
            return np.asarray(taken, np.uint8)
        pixels = _pygame().image.tobytes(self._draw(), "RGB")
        return np.frombuffer(pixels, np.uint8).reshape(self._shape[1], self._shape[0], 3).copy()

    def show(self) -> None:
        """Draw into the window, without waiting; opens it first. Closing the window does not stop the environment."""
        pygame = _pygame()
        if self._window is None:
            _check_screen()
            try:
                pygame.display.init()
                self._window = pygame.display.set_mode(self._shape)
            except pygame.error as error:
                raise DependencyNotInstalled(
                    f'render_mode "window" finds no screen ({error}); "rgb_array" needs none'
                ) from None
            pygame.display.set_caption(f"{self._robot.name} in {self._world.name}")
        self._window.blit(self._draw(), (0, 0))
        pygame.event.pump()
        pygame.display.flip()

    def close(self) -> None:
        """Close the window."""
        if self._window is not None:
            pygame = _pygame()
            pygame.display.quit()
            self._window = None

    def __getstate__(self) -> dict[str, Any]:
        return {**vars(self), "_plan": None, "_with_trail": None, "_canvas": None, "_window": None}
