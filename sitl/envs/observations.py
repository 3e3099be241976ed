# SPDX-License-Identifier: BSD-3-Clause
"""Observations: the arrays that an agent receives, for one robot or many, a row a robot."""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import Any, NamedTuple, Protocol

import gymnasium as gym
import numpy as np

from sitl.core import elementary_arrays as arrays
from sitl.core.array_kernels import IntTable, Kernel, NarrowTable
from sitl.core.kernels import law

from .options import EnvOptionError
from .robots.robot import Robot
from .tensors import rows

FAR = 10_000.0
"""Bound of coordinates in observation spaces [m]: that of world files."""


class Observation(Protocol):
    """A kind of observation."""

    def space(self, robot: Robot) -> gym.Space[Any]:
        """Observation space of one robot."""

    def observe(self, robot: Robot) -> Any:
        """New arrays with a row a robot; a dict of arrays for a ``Dict`` space."""


class DigitPlan(NamedTuple):
    """How readings become digits."""

    every: int
    """Each so-many-th is taken."""
    when_inf: int
    """Digit of inf."""
    highest: int
    """Greatest digit."""
    digits: int
    """How many there are."""


@law
def digits_of(scans: NarrowTable, every: int, when_inf: int, highest: int, out: IntTable) -> None:
    """The paper's rule: each ``every``-th reading, rounded down; inf and nan have digits of their own.

    Readings above ``highest`` give ``highest``: a user's ``randomise`` function may have extended the lidar's range.
    """
    for i in range(out.shape[0]):
        for k in range(out.shape[1]):
            reading = float(scans[i, k * every])
            if math.isinf(reading):
                out[i, k] = when_inf
            elif math.isnan(reading):
                out[i, k] = 0
            else:
                out[i, k] = min(int(reading), highest)


_digits = Kernel(digits_of)


class Digits:
    """The paper's observation: five readings (six where the division has a remainder) in whole metres, as
    MultiDiscrete.

    Of n readings every (n // parts)-th is taken and rounded down; nan gives 0.

    Args:
        when_inf: digit for a reading of inf; None: the robot's (6 for Turtlebot, int(range) for the others).
        parts: number of parts that the scan is divided into.
    """

    def __init__(self, when_inf: int | None = None, parts: int = 5) -> None:
        if parts < 1 or (when_inf is not None and when_inf < 0):
            raise EnvOptionError(f"Digits(when_inf={when_inf}, parts={parts}): parts from 1 on, when_inf from 0 on")
        self.when_inf = when_inf
        self.parts = parts
        self._plan = DigitPlan(0, 0, 0, 0)

    def space(self, robot: Robot) -> gym.Space[Any]:
        """See ``Observation``."""
        readings = robot.scan.shape[1]
        every = max(readings // self.parts, 1)
        when_inf = robot.digit_when_inf if self.when_inf is None else self.when_inf
        taken = len(range(0, readings, every))
        highest = max(int(robot.range_max), when_inf)
        self._plan = DigitPlan(every, when_inf, highest, taken)
        return gym.spaces.MultiDiscrete(np.full(taken, highest + 1))

    @property
    def plan(self) -> DigitPlan:
        """(Stride of the readings, digit of inf, greatest digit, number of digits); valid after ``space`` was
        called."""
        return self._plan

    def observe(self, robot: Robot) -> Any:
        """See ``Observation``."""
        every, when_inf, highest, digits = self._plan
        out = rows(robot.count, digits, np.int64)
        _digits.unchecked()(robot.scan, every, when_inf, highest, out)
        return out


class Scan:
    """All readings [m], float32, from right to left, shape (readings,); the lidar's range where nothing is in range."""

    def space(self, robot: Robot) -> gym.Space[Any]:
        """See ``Observation``."""
        return gym.spaces.Box(0.0, robot.range_max, (robot.scan.shape[1],), np.float32)

    def observe(self, robot: Robot) -> Any:
        """See ``Observation``."""
        return np.minimum(robot.scan, np.float32(robot.range_max), out=rows(*robot.scan.shape))


class WithPose:
    """Adds the pose to an observation: a dict of "scan" and "pose" (x, y, z [m], yaw [rad], float32, world frame)."""

    def __init__(self, scan: Observation) -> None:
        self.scan = scan

    def space(self, robot: Robot) -> gym.Space[Any]:
        """See ``Observation``."""
        bound = np.array([FAR, FAR, FAR, math.pi], np.float32)
        pose = gym.spaces.Box(-bound, bound, dtype=np.float32)
        return gym.spaces.Dict({"scan": self.scan.space(robot), "pose": pose})

    def observe(self, robot: Robot) -> Any:
        """See ``Observation``."""
        return {"scan": self.scan.observe(robot), "pose": robot.pose.astype(np.float32)}


class WithGoal:
    """Adds the direction to the task's goal to an observation.

    A dict of "goal" (distance [m], bearing [rad], positive to the left of the robot's heading, float32) and the other
    observation's entries.
    """

    def __init__(self, other: Observation) -> None:
        self.other = other
        self._task: Any = None

    def watch(self, task: Any) -> None:
        """Use the goals of a task (its ``goals``: x, y [m], shape (count, 2))."""
        if not hasattr(task, "goals"):
            raise EnvOptionError(f'observation with a goal: task {task!r} has none, as "goal" has')
        self._task = task

    def space(self, robot: Robot) -> gym.Space[Any]:
        """See ``Observation``."""
        low, high = np.array([0.0, -math.pi], np.float32), np.array([3.0 * FAR, math.pi], np.float32)
        goal = gym.spaces.Box(low, high, dtype=np.float32)
        other = self.other.space(robot)
        return gym.spaces.Dict({**(other if isinstance(other, gym.spaces.Dict) else {"scan": other}), "goal": goal})

    def observe(self, robot: Robot) -> Any:
        """See ``Observation``."""
        pose, other = robot.pose, self.other.observe(robot)
        offset = self._task.goals - pose[:, :2]
        bearing = arrays.atan2(offset[:, 1], offset[:, 0]) - pose[:, 3]
        bearing = arrays.atan2(arrays.sin(bearing), arrays.cos(bearing))
        goal = np.stack([arrays.hypot(offset[:, 0], offset[:, 1]), bearing], axis=1).astype(np.float32)
        return {**(other if isinstance(other, dict) else {"scan": other}), "goal": goal}


OBSERVATIONS: dict[str, Callable[[], Observation]] = {
    "digits": Digits,
    "scan": Scan,
    "digits+pose": lambda: WithPose(Digits()),
    "scan+pose": lambda: WithPose(Scan()),
    "digits+goal": lambda: WithGoal(Digits()),
    "scan+goal": lambda: WithGoal(Scan()),
    "scan+pose+goal": lambda: WithGoal(WithPose(Scan())),
}
"""By name."""
