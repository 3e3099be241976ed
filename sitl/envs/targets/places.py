# SPDX-License-Identifier: BSD-3-Clause
"""What tasks with target positions have in common: the targets of an episode, the vectors to them, the arena."""

from __future__ import annotations

import math
from abc import abstractmethod
from typing import Any

import numpy as np
import numpy.typing as npt

from sitl.core.array_kernels import IntLine, Kernel, Table
from sitl.core.kernels import law

from ...core.elementary import sincos
from ..arena import REACH, Arena, arena_of, flies
from ..judge import TRUTH
from ..options import EnvOptionError
from ..rewards import Floats, Step
from ..robots.robot import Robot
from ..tasks import Task

BEYOND = 5.0
"""An episode ends so far outside of the arena [m]."""
ON_FLOOR = 0.12
"""A robot that flies has sunk to the floor when its base is so little above it [m]."""


@law
def write_ways(pose: Table, places: Table, at: IntLine, per_robot: int, out: Table) -> None:
    """Write the ways from each robot to its next places; after the last place comes the last again.

    Args:
        pose: x, y, z [m], yaw [rad], shape (count, 4).
        places: x, y, z [m] of all robots' places, one robot after another, shape (count * per_robot, 3).
        at: number of each robot's present place, shape (count,).
        per_robot: places of a robot.
        out: forward, left, up [m] of each robot's heading, shape (count, 3 * k).
    """
    for i in range(out.shape[0]):
        s, c = sincos(pose[i, 3])
        for k in range(out.shape[1] // 3):
            row = i * per_robot + min(at[i] + k, per_robot - 1)
            x, y = places[row, 0] - pose[i, 0], places[row, 1] - pose[i, 1]
            out[i, 3 * k] = x * c + y * s
            out[i, 3 * k + 1] = y * c - x * s
            out[i, 3 * k + 2] = places[row, 2] - pose[i, 2]


_ways = Kernel(write_ways)


class PlacesTask(Task):
    """Base of tasks with target positions ("places"); subclasses draw them and judge steps.

    Distances of robots that do not fly, and whether they are in the arena, are judged in x and y: their heights are
    barometric, and drift by metres.

    Args:
        arena: box in which targets are drawn; None: a box around the world and ``reach`` about the start.
        reach: see ``arena_of`` [m].
        crash_reward: reward of a step that ends in a crash.
        out_reward: added to the reward of a step that ends more than 5 m outside of the arena.
        out_ends: whether that ends the episode; if not, it is worth nothing.
        floor_ends: whether a robot that flies and sinks to the floor has crashed, where the truth is judged: set-points
            do not lift it again.
        others: further arguments of ``Task``.
    """

    axes: Floats = np.ones(3)
    """What x, y and z count in distances: 1, or 0 for z of a robot that does not fly. Valid after ``prepare``."""

    def __init__(
        self, arena: Arena | None = None, reach: float = REACH, crash_reward: float = -10.0, out_reward: float = -10.0,
        out_ends: bool = True, floor_ends: bool = False, **others: Any,
    ) -> None:  # fmt: skip
        super().__init__(**{"rewards": (), "crash_range": 0.0, **others}, crash_reward=crash_reward)
        self._given, self._reach, self.out_reward = arena, reach, out_reward
        self.out_ends, self.floor_ends = bool(out_ends), bool(floor_ends)
        self._fixed: Floats | None = None
        """Places that are the same in every episode [m]; the arena holds them. None: they are drawn."""

    def prepare(self, robot: Robot) -> None:
        """See ``Task``."""
        super().prepare(robot)
        count = robot.count
        self.arena = self._given or arena_of(robot, self._reach)
        if self._fixed is not None and self._given is None:
            self.arena = self.arena.around(self._fixed[:, :3])
        self.flies = flies(robot)
        self.axes = np.array((1.0, 1.0, float(self.flies)))
        assert self.judge_of is not None
        self._ends_on_floor = self.floor_ends and self.flies and self.judge_of.by == TRUTH
        self._floor = robot.world.floor_z + ON_FLOOR
        self._limits = self.arena.grown(BEYOND)
        if not self.flies:
            (x0, y0, _), (x1, y1, _) = self._limits
            self._limits = self._limits._replace(low=(x0, y0, -math.inf), high=(x1, y1, math.inf))
        self.places = np.zeros((count, self.per_robot, 3))
        """x, y, z of each robot's places [m], shape (count, per_robot, 3)."""
        self.at = np.zeros(count, np.int64)
        """Number of each robot's present place, shape (count,)."""
        self.success = np.zeros(count, np.bool_)
        """Whether each robot has done the task, shape (count,)."""
        self._robot = robot

    @property
    @abstractmethod
    def per_robot(self) -> int:
        """Places of an episode."""

    @property
    def targets(self) -> Floats:
        """x, y, z of each robot's present place [m], shape (count, 3)."""
        out: Floats = self.places[np.arange(len(self.at)), np.minimum(self.at, self.per_robot - 1)]
        return out

    def achieved(self) -> Floats:
        """x, y, z of each robot, where it believes to be [m], shape (count, 3)."""
        return self._robot.pose[:, :3]

    def ways(self, count: int) -> Floats:
        """Ways to the next ``count`` places: forward, left, up [m] of the robot's heading, shape (robots, count, 3)."""
        return self.ways_from(self._robot.pose, count)

    def ways_from(self, pose: Floats, count: int) -> Floats:
        """The same from other poses: x, y, z [m], yaw [rad], shape (robots, 4)."""
        out = np.empty((len(self.at), 3 * count))
        _ways(np.ascontiguousarray(pose), self.places.reshape(-1, 3), self.at, self.per_robot, out)
        return out.reshape(len(out), count, 3)

    def judge(self, step: Step, rewards: Floats, terminated: npt.NDArray[np.bool_]) -> None:
        """See ``Task``."""
        super().judge(step, rewards, terminated)
        if self._ends_on_floor:
            terminated |= step.pose[:, 2] < self._floor
        crashed = terminated.copy()
        self._judge(step, rewards, terminated)
        rewards[crashed] = self.crash_reward
        low, high = self._limits
        outside = ((step.pose[:, :3] < low) | (step.pose[:, :3] > high)).any(axis=1) & ~terminated
        if self.out_ends:
            rewards[outside] += self.out_reward
            terminated |= outside
            step.note(out=np.where(outside, self.out_reward, 0.0))
        step.outside = outside
        step.crashed, step.reached = crashed, self.success & ~crashed

    @abstractmethod
    def _judge(self, step: Step, rewards: Floats, terminated: npt.NDArray[np.bool_]) -> None:
        """Add to the rewards, and mark episodes that the task ends, in place."""

    def info(self, step: Step) -> dict[str, npt.NDArray[Any]]:
        """See ``Task``."""
        return {**super().info(step), "is_success": step.reached.copy()}

    def memory(self, index: int) -> Any:
        """See ``Task``."""
        return self.places[index].copy(), int(self.at[index]), bool(self.success[index])

    def recall(self, index: int, memory: Any) -> None:
        """See ``Task``."""
        if not isinstance(memory, tuple) or len(memory) < 3 or np.shape(memory[0]) != self.places[index].shape:
            raise EnvOptionError("snapshot cannot be restored: it is of another task")
        self.places[index], self.at[index], self.success[index] = memory[:3]


def nearness(distance: Floats, scale: float, half: float | None) -> Floats:
    """What a second at a distance [m] from a target is worth: 1 there; 0 from ``scale`` [m] on, or, not linearly, one
    half at ``half`` [m]: who keeps at some distance, or does nothing, gets little."""
    if half is None:
        return np.maximum(1.0 - distance / scale, 0.0)
    share = distance / half
    return 1.0 / (1.0 + share * share)
