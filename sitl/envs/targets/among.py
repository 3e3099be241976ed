# SPDX-License-Identifier: BSD-3-Clause
"""Go to waypoints among obstacles."""

from __future__ import annotations

from typing import Any

import numpy as np
import numpy.typing as npt

from sitl.worlds import World

from ..arena import Arena
from ..options import EnvOptionError
from ..rewards import Floats, Step
from ..robots.robot import Robot
from ..shortest_paths import ShortestPaths
from .waypoints import Waypoints


class Among(Waypoints):
    """Pass one or more waypoints among obstacles, in order. Passing the last one is success and ends the episode.

    Waypoints are reachable, and at the height of the start. The reward is that of ``Waypoints``, but distance is the
    length of the shortest obstacle-free path in the horizontal plane, not the straight line: a dead end earns nothing.

    Args:
        count: number of random waypoints in an episode.
        apart: least straight distance from one waypoint to the next [m].
        ceiling: top of the arena for robots that fly, above the floor, so that they cannot fly over the walls [m].
            None: the arena's.
        others: further arguments of ``Waypoints``.
    """

    def __init__(self, count: int = 1, apart: float = 8.0, ceiling: float | None = None, **others: Any) -> None:
        super().__init__(count, **{"reachable": True, **others}, apart=apart)
        if ceiling is not None and not ceiling > 0.0:
            raise EnvOptionError(f"Among(ceiling={ceiling}); it must be above 0 m")
        self.ceiling = ceiling

    def prepare(self, robot: Robot) -> None:
        """See ``Task``."""
        super().prepare(robot)
        self._paths = ShortestPaths(robot, self.limit)
        self._left = np.zeros(robot.count)
        """How long each robot's free path to its position is [m]."""

    def _bounded(self, limits: Arena, world: World) -> Arena:
        if self.ceiling is None or not self.flies:
            return limits
        x, y, _ = limits.high
        return limits._replace(high=(x, y, world.floor_z + self.ceiling))

    def start(self, index: int, robot: Robot, rng: np.random.Generator) -> None:
        """See ``Task``."""
        super().start(index, robot, rng)
        self._aim(index)

    def _aim(self, index: int) -> None:
        x, y, _ = self.positions[index, min(self.at[index], self.per_robot - 1)].tolist()
        self._paths.aim(index, x, y)
        self._left[index] = self._paths.lengths(self.judged_pose())[index]

    def plan_routes(self) -> None:
        """``routes`` is going to be called; before the first episode."""
        self._paths.plan_routes()

    def routes(self, ahead: float, out: Floats, first: int = 0) -> None:
        """Write where the routes of all robots to their targets lead next, from where their autopilots believe them to
        be: short obstacle-free paths that keep away from obstacles where there is space
        (``shortest_paths.follow_paths``).

        Args:
            ahead: how far along the path [m].
            out: forward, left of the robot's heading, and the length of the shortest path [m], shape (count,
                columns).
            first: column of the first one.
        """
        self._paths.follow(self._from(), ahead, out, first)

    def _nearer(self, pose: Floats) -> Floats:
        left = self._paths.lengths(pose)
        np.subtract(self._left, left, self._gain)
        self._left[:] = left
        return self._gain

    def _judge(self, step: Step, rewards: Floats, terminated: npt.NDArray[np.bool_]) -> None:
        super()._judge(step, rewards, terminated)
        for index in np.flatnonzero(self._passed & ~self.success).tolist() if self._going else ():
            self._aim(index)

    def recall(self, index: int, memory: Any) -> None:
        """See ``Task``."""
        super().recall(index, memory)
        self._aim(index)
        self._left[index] = memory[4]

    def memory(self, index: int) -> Any:
        """See ``Task``."""
        return *super().memory(index), float(self._left[index])
