# SPDX-License-Identifier: BSD-3-Clause
"""Tasks: when an episode ends, and what a step is worth."""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from typing import Any

import numpy as np
import numpy.typing as npt

from sitl.core.array_kernels import kernel
from sitl.core.kernels import law

from .options import EnvOptionError, unknown
from .rewards import TERMS, ByAction, EachStep, Floats, Forward, Step, Term
from .robots.robot import Robot
from .starts import ReachableCells

_DRAWS = 100
"""Of a random goal, until it is not one that the robot has reached where it starts."""


@law
def count_crashes(scans, crash_range, touched, contact_ends, out):
    """Which robots have crashed, into ``out``; returns how many. A reading of 0 is none, as in the original."""
    crashes = 0
    for i in range(out.shape[0]):
        crashed = contact_ends != 0 and touched[i] != 0
        for k in range(scans.shape[1]):
            if 0.0 < scans[i, k] < crash_range:
                crashed = True
        out[i] = crashed
        if crashed:
            crashes += 1
    return crashes


_crashes = kernel("i8(f4[:,::1], f8, i8[:], i8, b1[::1])")(count_crashes)


class Task:
    """Rewards, added up, until a crash ends the episode.

    Args:
        rewards: terms: names (``rewards.TERMS``), objects of ``rewards`` or functions of your own.
        crash_range: a reading below it is a crash [m]; 0: readings are none; None: the robot's.
        crash_reward: of the step that ends in a crash, instead of its terms.
        contact_ends: whether touching something is a crash, too.
    """

    def __init__(
        self,
        rewards: Sequence[str | Term] = ("forward",),
        crash_range: float | None = None,
        crash_reward: float = -200.0,
        contact_ends: bool = True,
    ) -> None:
        self.terms = [_term(term) for term in rewards]
        self.crash_range = crash_range
        if crash_range is not None and not 0.0 <= crash_range < math.inf:
            raise EnvOptionError(f"crash_range = {crash_range}; it must be 0 m or more")
        self.crash_reward = crash_reward
        self.contact_ends = contact_ends
        self._range = 0.0

    def prepare(self, robot: Robot) -> None:
        """Called once, before the first episode."""
        self._range = robot.crash_range if self.crash_range is None else self.crash_range

    @property
    def limit(self) -> float:
        """A reading below it is a crash [m], once the task is prepared."""
        return self._range

    def start(self, index: int, robot: Robot, rng: np.random.Generator) -> None:
        """An episode of one robot begins; it stands at its start pose."""

    def judge(self, step: Step, rewards: Floats, terminated: npt.NDArray[np.bool_]) -> None:
        """Rewards of a step, and who has ended, into the two arrays, shape (count,)."""
        crashes = _crashes(step.scan, self._range, step.robot.collided, self.contact_ends, terminated)
        step.crashed = terminated
        first = True
        for term in self.terms:
            if first:
                rewards[:] = term(step)
                first = False
            else:
                rewards += term(step)
        if first:
            rewards[:] = 0.0
        if crashes:
            rewards[terminated] = self.crash_reward

    def info(self, step: Step) -> dict[str, npt.NDArray[Any]]:
        """What ``info`` tells of the step, a row a robot."""
        return {"crashed": step.crashed.copy()}

    def memory(self, index: int) -> Any:
        """What the task remembers of the episode of one robot; can be pickled."""
        return None

    def recall(self, index: int, memory: Any) -> None:
        """Put it back."""


class ReachGoal(Task):
    """Come within ``radius`` of a goal, which ends the episode.

    Args:
        goal: x, y [m]; None: another random place in every episode that the robot can get to from the world's start.
        radius: [m].
        goal_reward: of reaching it.
        progress: reward for each metre nearer to the goal, as the crow flies.
        rewards: more terms.
        others: as ``Task``.
    """

    def __init__(
        self,
        goal: tuple[float, float] | None = None,
        radius: float = 0.5,
        goal_reward: float = 200.0,
        progress: float = 25.0,
        rewards: Sequence[str | Term] = (EachStep(-0.1),),
        **others: Any,
    ) -> None:
        super().__init__(rewards, **others)
        if goal is not None and (len(goal) != 2 or not np.all(np.isfinite(goal))):
            raise EnvOptionError(f"goal = {goal!r}; it must be (x, y): two finite numbers [m]")
        if not radius > 0.0:
            raise EnvOptionError(f"radius = {radius}; it must be above 0 m")
        self.goal, self.radius, self.goal_reward, self.progress = goal, radius, goal_reward, progress

    def prepare(self, robot: Robot) -> None:
        """See ``Task``."""
        super().prepare(robot)
        self.goals = np.zeros((robot.count, 2))
        """x, y of each robot's goal [m]."""
        self._distance = np.zeros(robot.count)
        self._cells = ReachableCells(robot) if self.goal is None else None

    def start(self, index: int, robot: Robot, rng: np.random.Generator) -> None:
        """See ``Task``."""
        place = robot.pose[index, :2]
        for _ in range(_DRAWS if self._cells else 1):
            self.goals[index] = self._cells.draw(rng) if self._cells else self.goal
            self._distance[index] = np.hypot(*(place - self.goals[index]))  # as in ``judge``, to the last bit
            if self._distance[index] > self.radius:
                break

    def judge(self, step: Step, rewards: Floats, terminated: npt.NDArray[np.bool_]) -> None:
        """See ``Task``."""
        super().judge(step, rewards, terminated)
        distance = np.hypot(*(step.pose[:, :2] - self.goals).T)
        alive = ~terminated
        rewards[alive] += self.progress * (self._distance - distance)[alive]
        self._distance = distance
        step.crashed = terminated.copy()
        step.reached = alive & (distance < self.radius)
        rewards[step.reached] += self.goal_reward
        terminated |= step.reached

    def info(self, step: Step) -> dict[str, npt.NDArray[Any]]:
        """See ``Task``."""
        return {**super().info(step), "reached": step.reached.copy(), "goal": self.goals.copy()}

    def memory(self, index: int) -> Any:
        """See ``Task``."""
        return self.goals[index].copy(), float(self._distance[index])

    def recall(self, index: int, memory: Any) -> None:
        """See ``Task``."""
        if memory is None:
            raise EnvOptionError("snapshot cannot be restored: it is of a task without a goal")
        self.goals[index], self._distance[index] = memory


def paper(forward: float = 5.0, turn: float = 1.0, **others: Any) -> Task:
    """The paper's: so much for forward, so much for either turn, -200 for a crash instead of it."""
    return Task([ByAction((forward, turn, turn))], **others)


TASKS: dict[str, Callable[[], Task]] = {"wander": lambda: Task([Forward()]), "paper": paper, "goal": ReachGoal}
"""By name."""


def _term(term: str | Term) -> Term:
    if isinstance(term, str):
        if term not in TERMS:
            raise unknown("reward", term, TERMS)
        made: Term = TERMS[term]()
        return made
    if not callable(term):
        raise EnvOptionError(f"reward {term!r} is neither a name ({', '.join(TERMS)}) nor a function of a step")
    return term
