# SPDX-License-Identifier: BSD-3-Clause
"""Tasks: the reward of a step, and the end of an episode."""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping, Sequence
from functools import partial
from types import MappingProxyType
from typing import Any

import numpy as np
import numpy.typing as npt

from sitl.core import elementary_arrays as arrays
from sitl.core.array_kernels import Flags, IntColumn, Kernel, NarrowTable
from sitl.core.kernels import law
from sitl.worlds import World

from .judge import ESTIMATE, Judge
from .options import EnvOptionError, unknown
from .rewards import TERMS, ByAction, EachStep, Floats, Forward, Step, Term
from .robots.robot import Robot, world_of
from .senses import reads_scan
from .starts import ReachableCells
from .worlds import PerWorld

_DRAWS = 100
"""Attempts to draw a random goal that the robot has not reached at its start."""


@law
def count_crashes(scans: NarrowTable, crash_range: float, touched: IntColumn, contact_ends: bool, out: Flags) -> int:
    """Mark the robots that have crashed in ``out``; returns their number. A reading of 0 does not count, as in the
    paper's
    code.

    Args:
        scans: lidar readings [m], shape (count, readings).
        crash_range: a reading above 0 and below it is a crash [m].
        touched: 1 for robots that touched something, shape (count,).
        contact_ends: whether touching is a crash.
        out: shape (count,), bool.
    """
    crashes = 0
    for i in range(out.shape[0]):
        crashed = contact_ends and touched[i] != 0
        for k in range(scans.shape[1]):
            if 0.0 < scans[i, k] < crash_range:
                crashed = True
        out[i] = crashed
        if crashed:
            crashes += 1
    return crashes


_crashes = Kernel(count_crashes)


class Task:
    """The sum of reward terms; a crash ends the episode.

    Args:
        rewards: reward terms: names (``rewards.TERMS``), objects of ``rewards``, or functions of a ``Step``.
        crash_range: a lidar reading below it is a crash [m]; 0: no reading is; None: the robot's value.
        crash_reward: reward of a step that ends in a crash, instead of its terms.
        contact_ends: whether touching an obstacle is a crash, too.
    """

    def __init__(
        self,
        rewards: Sequence[str | Term] = ("forward",),
        crash_range: float | None = None,
        crash_reward: float = -200.0,
        contact_ends: bool = True,
    ) -> None:
        self.terms = [_term(term) for term in rewards]
        self._names = [_name_of(term, k) for k, term in enumerate(rewards)]
        self.crash_range = crash_range
        if crash_range is not None and not 0.0 <= crash_range < math.inf:
            raise EnvOptionError(f"crash_range = {crash_range}; it must be 0 m or more")
        self.crash_reward = crash_reward
        self.contact_ends = bool(contact_ends)
        self._range = 0.0

    paid: Mapping[str, Floats] = MappingProxyType({})
    """Terms of the last step's rewards that the task itself has written, by name, 0 where it ended in a crash."""
    sees_truth = False
    """Whether it goes by where robots really are, where anybody knows, whatever the option ``judge`` says."""
    judge_of: Judge | None = None
    """Says where robots are, as the task judges them; the environment sets it before ``prepare``."""

    def prepare(self, robot: Robot) -> None:
        """Called once, before the first episode."""
        self.judge_of = self.judge_of or Judge(robot, ESTIMATE)
        self._range = float(robot.crash_range if self.crash_range is None else self.crash_range)

    @property
    def limit(self) -> float:
        """Readings below it are a crash [m]; valid after ``prepare``."""
        return self._range

    @property
    def reads_scan(self) -> bool:
        """Whether it needs lidar readings (``senses.reads_scan``): for its crash range, or a term. A subclass that
        reads them besides says True. Valid after ``prepare``."""
        return self._range > 0.0 or any(reads_scan(term) for term in self.terms)

    is_of_one_world = False
    """Whether it was given positions of one world, so that episodes can be in no other."""

    def enter(self, index: int, robot: Robot) -> None:
        """Called when one robot's next episode is in another world than its last one (``robots.robot.world_of``);
        ``start`` or ``recall`` follows."""

    def start(self, index: int, robot: Robot, rng: np.random.Generator) -> None:
        """Called at the start of an episode of one robot, when it is at its start pose."""

    def judge(self, step: Step, rewards: Floats, terminated: npt.NDArray[np.bool_]) -> None:
        """Write the rewards of a step, and which episodes have ended, into two arrays of shape (count,)."""
        robot, count = step.robot, _crashes.unchecked()
        crashes = count(robot.scan, self._range, robot.collided, self.contact_ends, terminated)
        step.crashed = terminated
        if not self.terms:
            rewards[...] = 0.0
        for k, term in enumerate(self.terms):
            paid = term(step)
            if k == 0:
                rewards[...] = paid
            else:
                rewards += paid
            step.note(**{self._names[k]: paid})
        if crashes:
            rewards[terminated] = self.crash_reward

    def judged_pose(self) -> Floats:
        """x, y, z [m], yaw [rad] of robots, as the task judges them, shape (count, 4); valid after ``prepare``."""
        assert self.judge_of is not None
        return self.judge_of.pose

    info_stays = False
    """Whether ``info`` of the same class returns the same arrays in each step, rewritten in place."""

    def info(self, step: Step) -> dict[str, npt.NDArray[Any]]:
        """Entries of ``info`` for the step: arrays with a row a robot, which are copied before the next step."""
        return {"crashed": step.crashed}

    def memory(self, index: int) -> Any:
        """The task's state of one robot's episode, for a snapshot; picklable."""
        return None

    def recall(self, index: int, memory: Any) -> None:
        """Restore what ``memory`` returned."""


class ReachGoal(Task):
    """Come within ``radius`` of a goal, which ends the episode.

    Args:
        goal: x, y in the world frame [m]; None: a random position in every episode, reachable from the world's start.
        radius: distance to the goal that counts as reached [m].
        goal_reward: reward of reaching the goal.
        progress: reward for each metre that the straight-line distance to the goal shrinks.
        rewards: further reward terms.
        others: further arguments of ``Task``.
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
        self._cells_in = PerWorld(partial(_cells, robot)) if self.goal is None else None
        if self._cells_in is not None:
            self._cells_in(robot.world)

    @property
    def is_of_one_world(self) -> bool:  # type: ignore[override]
        """See ``Task``."""
        return self.goal is not None

    def start(self, index: int, robot: Robot, rng: np.random.Generator) -> None:
        """See ``Task``."""
        position = self.judged_pose()[index, :2]
        cells = None if self._cells_in is None else self._cells_in(world_of(robot, index))
        for _ in range(_DRAWS if cells else 1):
            self.goals[index] = cells.draw(rng) if cells else self.goal
            self._distance[index] = arrays.hypot(*(position - self.goals[index]))  # as in ``judge``, to the last bit
            if self._distance[index] > self.radius:
                break

    def judge(self, step: Step, rewards: Floats, terminated: npt.NDArray[np.bool_]) -> None:
        """See ``Task``."""
        super().judge(step, rewards, terminated)
        distance = arrays.hypot(*(step.pose[:, :2] - self.goals).T)
        alive = ~terminated
        gain = self.progress * (self._distance - distance)
        rewards[alive] += gain[alive]
        self._distance = distance
        step.crashed = terminated.copy()
        step.reached = alive & (distance < self.radius)
        rewards[step.reached] += self.goal_reward
        step.note(progress=gain, goal=self.goal_reward * step.reached)
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


def _cells(robot: Robot, world: World) -> ReachableCells:
    return ReachableCells(robot, world=world)


def reward_of_goals(task: Task, achieved: Any, desired: Any, info: Any) -> Any:
    """What goals are worth, one or many: the ``compute_reward`` of a task.

    Raises:
        EnvOptionError: the task has no goal that counts alone.
    """
    rule = getattr(task, "compute_reward", None)
    if rule is None:
        raise EnvOptionError(f"compute_reward: task {task!r} has no goal that counts alone")
    return rule(achieved, desired, info)


def paper(forward: float = 5.0, turn: float = 1.0, **others: Any) -> Task:
    """The paper's task: reward ``forward`` or ``turn`` by action; -200 for a crash instead."""
    return Task([ByAction((forward, turn, turn))], **others)


TASKS: dict[str, Callable[[], Task]] = {"wander": lambda: Task([Forward()]), "paper": paper, "goal": ReachGoal}
"""Tasks by name."""


def _name_of(term: str | Term, k: int) -> str:
    """Of a reward term, in ``info``."""
    return term if isinstance(term, str) else getattr(term, "name", f"term_{k}")


def _term(term: str | Term) -> Term:
    if isinstance(term, str):
        if term not in TERMS:
            raise unknown("reward", term, TERMS)
        made: Term = TERMS[term]()
        return made
    if not callable(term):
        raise EnvOptionError(f"reward {term!r} is neither a name ({', '.join(TERMS)}) nor a function of a step")
    return term
