# SPDX-License-Identifier: BSD-3-Clause
"""Reward terms: functions of a step that return one reward a robot. A task adds them up.

Any function of a ``Step`` is a term: ``lambda step: -0.1 * abs(step.velocity[:, 3])``. Arrays have a row a robot.
A term with an attribute ``reads_scan`` that is False says that it reads no lidar (``senses.reads_scan``).
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import Any

import numpy as np
import numpy.typing as npt

from .judge import ESTIMATE, Judge
from .options import EnvOptionError
from .robots.robot import Robot

Floats = npt.NDArray[np.float64]


class Step:
    """Data of a step for reward terms. Arrays have a row a robot."""

    def __init__(self, robot: Robot, seconds: float, judge: Judge | None = None) -> None:
        self.robot = robot
        self.judge = judge or Judge(robot, ESTIMATE)
        """By what ``pose`` and ``velocity`` go."""
        self.seconds = seconds
        """Simulated time of a step [s]."""
        self.actions: npt.NDArray[Any] = np.zeros(robot.count)
        """The agent's actions, as ``Action.check`` returns them."""
        self.commands: Floats = np.zeros((robot.count, 0))
        """Set-points of the actions, in the set-point's units, shape (count, setpoint.width)."""
        self.crashed: npt.NDArray[np.bool_] = np.zeros(robot.count, np.bool_)
        self.reached: npt.NDArray[np.bool_] = np.zeros(robot.count, np.bool_)
        """Whether the goal was reached (False for tasks without a goal), shape (count,)."""
        self.outside: npt.NDArray[np.bool_] = np.zeros(robot.count, np.bool_)
        """Whether the robot left the arena (False for tasks without one), shape (count,)."""
        self.terms: dict[str, Any] | None = None
        """What the reward is made of, by name, each a number or shape (count,); None: nobody asks."""

    def note(self, **terms: Any) -> None:
        """Tell terms of the reward; they are not added to it by this."""
        if self.terms is not None:
            self.terms.update(terms)

    @property
    def scan(self) -> npt.NDArray[np.float32]:
        """Readings [m], shape (count, readings)."""
        return self.robot.scan

    @property
    def pose(self) -> Floats:
        """x, y, z [m], yaw [rad], in the frame of world files, as they are judged, shape (count, 4)."""
        return self.judge.pose

    @property
    def velocity(self) -> Floats:
        """Forward, left, up [m/s], turn rate [rad/s], as they are judged, shape (count, 4)."""
        return self.judge.velocity


Term = Callable[[Step], Floats]
"""A function of a step: rewards, shape (count,)."""


class ByAction:
    """A fixed reward for each discrete action: the paper's reward."""

    name = "by_action"
    reads_scan = False

    def __init__(self, rewards: Sequence[float]) -> None:
        self.rewards = np.array(rewards, np.float64)

    def __call__(self, step: Step) -> Floats:
        """See ``Term``."""
        return self.rewards.take(step.actions, mode="clip")


class Forward:
    """Forward speed at the end of the step times its duration [m], times ``per_metre``."""

    name = "forward"
    reads_scan = False

    def __init__(self, per_metre: float = 25.0) -> None:
        self.per_metre = per_metre

    def __call__(self, step: Step) -> Floats:
        """See ``Term``."""
        return self.per_metre * step.seconds * step.velocity[:, 0]


class Turning:
    """Magnitude of the turn rate at the end of the step [rad/s] times ``per_rad``: a penalty when that is negative."""

    name = "turning"
    reads_scan = False

    def __init__(self, per_rad: float = -1.0) -> None:
        self.per_rad = per_rad

    def __call__(self, step: Step) -> Floats:
        """See ``Term``."""
        return self.per_rad * np.abs(step.velocity[:, 3])


class EachStep:
    """A constant reward for each step."""

    name = "each_step"
    reads_scan = False

    def __init__(self, reward: float = -1.0) -> None:
        self.reward = reward

    def __call__(self, step: Step) -> Floats:
        """See ``Term``."""
        return np.full(step.robot.count, self.reward)


class Nearness:
    """A penalty that grows linearly from 0 at a nearest reading of ``distance`` [m] to ``most`` at a reading of 0."""

    name = "nearness"

    def __init__(self, distance: float = 0.5, most: float = -1.0) -> None:
        if not distance > 0.0:
            raise EnvOptionError(f"Nearness(distance={distance}); it must be above 0 m")
        self.distance, self.most = distance, most

    def __call__(self, step: Step) -> Floats:
        """See ``Term``."""
        nearest = step.scan.min(axis=1).astype(np.float64)
        return self.most * np.maximum(1.0 - nearest / self.distance, 0.0)


TERMS: dict[str, Callable[[], Term]] = {
    "forward": Forward,
    "turning": Turning,
    "each_step": EachStep,
    "nearness": Nearness,
}
"""Terms by name, with default arguments."""
