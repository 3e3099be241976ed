# SPDX-License-Identifier: BSD-3-Clause
"""Go to a waypoint, or to several in order."""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import Any

import numpy as np
import numpy.typing as npt

from sitl.core.array_kernels import Flags, IntLine, Kernel, Line, Table
from sitl.core.kernels import law
from sitl.core.sums import lengths

from ..options import EnvOptionError
from ..rewards import Floats, Step
from ..robots.robot import Robot
from ..starts import ReachableCells
from .places import PlacesTask


@law
def pass_places(
    pose: Table, places: Table, radius: float, at: IntLine, distance: Line, gain: Line, passed: Flags
) -> None:
    """Judge a step on the way along places.

    Args:
        pose: x, y, z [m], yaw [rad], shape (count, 4).
        places: x, y, z [m], one robot after another, shape (count * n, 3).
        radius: distance at which a place is passed [m].
        at: number of each robot's present place; goes on where that is passed, shape (count,).
        distance: to each robot's present place [m]: of the step before, becomes that of now, shape (count,).
        gain: how much nearer each robot has come [m], written, shape (count,).
        passed: whether each robot has passed a place, written, shape (count,).
    """
    per_robot = places.shape[0] // at.shape[0]
    for i in range(at.shape[0]):
        row = i * per_robot + min(at[i], per_robot - 1)
        x, y, z = places[row, 0] - pose[i, 0], places[row, 1] - pose[i, 1], places[row, 2] - pose[i, 2]
        now = math.sqrt(x * x + y * y + z * z)
        gain[i] = distance[i] - now
        passed[i] = now < radius and at[i] < per_robot
        distance[i] = now
        if passed[i]:
            at[i] += 1
            if at[i] < per_robot:
                row += 1
                x, y, z = places[row, 0] - pose[i, 0], places[row, 1] - pose[i, 1], places[row, 2] - pose[i, 2]
                distance[i] = math.sqrt(x * x + y * y + z * z)


_pass = Kernel(pass_places)


class Waypoints(PlacesTask):
    """Pass one or more waypoints in order. Passing the last one is success and ends the episode.

    Reward of a step: ``progress`` times the decrease of the distance to the current waypoint [m], plus ``each_second``
    times the step's seconds, plus ``place_reward`` when the waypoint is passed.

    Args:
        count: number of random waypoints in an episode.
        reachable: draw them where the robot can get to among the obstacles, at the height of its start.
        places: fixed waypoints instead of random ones: (x, y, z) in the world's frame [m].
        apart: least distance from one waypoint to the next [m].
        radius: distance at which a waypoint is passed [m].
        progress: reward for each metre nearer.
        place_reward: reward for each waypoint passed.
        each_second: reward per second.
        others: further arguments of ``PlacesTask``.
    """

    def __init__(
        self,
        count: int = 1,
        places: Sequence[tuple[float, float, float]] | None = None,
        reachable: bool = False,
        apart: float = 4.0,
        radius: float = 1.0,
        progress: float = 1.0,
        place_reward: float = 10.0,
        each_second: float = -0.5,
        **others: Any,
    ) -> None:
        super().__init__(**others)
        self._fixed = None if places is None else np.array(places, np.float64)
        if self._fixed is not None and (self._fixed.ndim != 2 or self._fixed.shape[1] != 3 or not len(self._fixed)):
            raise EnvOptionError(f"Waypoints(places={places!r}); it must be one (x, y, z) [m] at least")
        self._count = count if self._fixed is None else len(self._fixed)
        if not 1 <= self._count <= 1000:
            raise EnvOptionError(f"Waypoints(count={count}); it must be 1 .. 1000")
        if not (radius > 0.0 and apart >= 0.0):
            raise EnvOptionError(f"Waypoints(radius={radius}, apart={apart}); they must be above 0 m")
        self.apart, self.radius, self.progress = apart, radius, progress
        self.reachable = reachable
        self.place_reward, self.each_second = place_reward, each_second

    @property
    def per_robot(self) -> int:
        """See ``PlacesTask``."""
        return self._count

    def prepare(self, robot: Robot) -> None:
        """See ``Task``."""
        super().prepare(robot)
        self._distance, self._gain = np.zeros(robot.count), np.zeros(robot.count)
        self._passed = np.zeros(robot.count, np.bool_)
        self._cells = ReachableCells(robot, self.limit) if self.reachable and self._fixed is None else None

    def start(self, index: int, robot: Robot, rng: np.random.Generator) -> None:
        """See ``Task``."""
        here = self.judged_pose()[index, :3]
        self.places[index] = self._drawn(here, rng) if self._fixed is None else self._fixed
        self.at[index], self.success[index] = 0, False
        self._distance[index] = lengths(self.axes * (self.places[index, 0] - here))

    def _drawn(self, here: Floats, rng: np.random.Generator) -> Floats:
        out = np.empty((self._count, 3))
        for k in range(self._count):
            for _ in range(100):
                out[k] = self.arena.draw(rng) if self._cells is None else (*self._cells.draw(rng), here[2])
                if np.square(out[k] - here).sum() >= self.apart * self.apart:
                    break
            here = out[k]
        return out

    def _judge(self, step: Step, rewards: Floats, terminated: npt.NDArray[np.bool_]) -> None:
        pose = np.ascontiguousarray(step.pose)
        places, judged = self.places.reshape(-1, 3), pose
        if not self.flies:
            places, judged = self.axes * places, np.append(self.axes, 1.0) * pose  # without heights
        _pass(judged, places, self.radius, self.at, self._distance, self._gain, self._passed)
        gain, places_paid = self.progress * self._nearer(pose), self.place_reward * self._passed
        time = self.each_second * step.seconds
        rewards += gain + places_paid + time
        step.note(progress=gain, places=places_paid, time=time)
        self.success = self.at == self._count
        terminated |= self.success

    def _nearer(self, pose: Floats) -> Floats:
        """How much nearer each robot has come to its place [m], shape (count,)."""
        return self._gain

    def info(self, step: Step) -> dict[str, npt.NDArray[Any]]:
        """See ``Task``."""
        return {**super().info(step), "passed": self.at.copy()}

    def memory(self, index: int) -> Any:
        """See ``Task``."""
        return *super().memory(index), float(self._distance[index])

    def recall(self, index: int, memory: Any) -> None:
        """See ``Task``."""
        super().recall(index, memory)
        self._distance[index] = memory[3]
