# SPDX-License-Identifier: BSD-3-Clause
"""What tasks with target positions have in common: the targets of an episode, the vectors to them, the arena."""

from __future__ import annotations

import math
from abc import abstractmethod
from collections.abc import Callable
from typing import Any, NamedTuple

import numpy as np
import numpy.typing as npt

from sitl.core.array_kernels import Flags, IntColumn, IntLine, Kernel, Line, NarrowTable, Table
from sitl.core.kernels import law
from sitl.worlds import World

from ...core.elementary import sincos
from ..arena import REACH, Arena, arena_of, flies
from ..gathering import stands_for
from ..judge import TRUTH
from ..options import EnvOptionError
from ..rewards import Floats, Step
from ..robots.robot import Robot, world_of
from ..senses import arrays_stay
from ..tasks import Task, count_crashes
from ..worlds import PerWorld

BEYOND = 5.0
"""An episode ends so far outside of the arena [m]."""
ON_FLOOR = 0.12
"""A robot that flies has sunk to the floor when its base is so little above it [m]."""


@law
def distance_of(state: Table, i: int, positions: Table, row: int, axes: Line) -> float:
    """Distance of robot ``i`` from a position [m]."""
    x = axes[0] * (positions[row, 0] - state[i, 0])
    y = axes[1] * (positions[row, 1] - state[i, 1])
    z = axes[2] * (positions[row, 2] - state[i, 2])
    return math.sqrt(x * x + y * y + z * z)


@law
def nearness(distance: float, scale: float, half: float) -> float:
    """What a second at a distance [m] from a target is worth: 1 there; 0 from ``scale`` [m] on, or, not linearly, one
    half at ``half`` [m], if that is not 0: who keeps at some distance, or does nothing, gets little."""
    if half == 0.0:
        near = 1.0 - distance / scale
        return 0.0 if near < 0.0 else near
    share = distance / half
    return 1.0 / (1.0 + share * share)


@law
def write_offsets(
    pose: Table, positions: Table, at: IntLine, per_robot: int, count: int, out: Table, first: int
) -> None:
    """Write the offsets from each robot to its next targets; after the last target comes the last again.

    Args:
        pose: x, y, z [m], yaw [rad], shape (count, 4).
        positions: x, y, z [m] of all robots' positions, one robot after another, shape (count * per_robot, 3).
        at: number of each robot's present target, shape (count,).
        per_robot: positions of a robot.
        count: number of targets that are written.
        out: forward, left, up [m] of each robot's heading, one target after another, shape (robots, columns).
        first: column of the first one.
    """
    for i in range(out.shape[0]):
        s, c = sincos(pose[i, 3])
        for k in range(count):
            row = i * per_robot + min(at[i] + k, per_robot - 1)
            x, y = positions[row, 0] - pose[i, 0], positions[row, 1] - pose[i, 1]
            to = first + 3 * k
            out[i, to] = x * c + y * s
            out[i, to + 1] = y * c - x * s
            out[i, to + 2] = positions[row, 2] - pose[i, 2]


class Beginning(NamedTuple):
    """What ends an episode whatever the task is."""

    scan: NarrowTable
    """Readings [m], shape (count, readings)."""
    touched: IntColumn
    """1 for robots that touched something, shape (count,)."""
    crash_range: float
    """A reading above 0 and below it is a crash [m]."""
    contact_ends: bool
    """Whether touching is a crash."""
    floor: Line
    """Below this height a robot has sunk to the floor [m], shape (count,)."""
    floor_ends: bool
    """Whether that is a crash."""


@law
def begin_step(by: Beginning, state: Table, rewards: Line, terminated: Flags, crashed: Flags) -> None:
    """Begin to judge a step: nothing is paid yet, and robots that have crashed are marked; all of shape (count,).

    Args:
        by: see ``Beginning``.
        state: x, y, z [m] and more, shape (count, n).
        rewards: written.
        terminated, crashed: written.
    """
    count_crashes(by.scan, by.crash_range, by.touched, by.contact_ends, terminated)
    for i in range(rewards.shape[0]):
        rewards[i] = 0.0
        if by.floor_ends and state[i, 2] < by.floor[i]:
            terminated[i] = True
        crashed[i] = terminated[i]


class Outside(NamedTuple):
    """The end of the arena, and what ends cost."""

    low: Table
    high: Table
    """x, y, z of each robot's arena [m], shape (count, 3)."""
    reward: float
    ends: bool
    """Whether the end of the arena is the episode's."""
    crash_reward: float


class Outcome(NamedTuple):
    """What a task's own rule judges of a step, a row a robot."""

    crashed: Flags
    """Robots whose terms are written as 0."""
    success: Flags
    """Written."""
    rewards: Line
    """Added to."""
    terminated: Flags
    """Written where the task ends an episode."""
    paid: Table
    """Terms of the rewards by number, written, shape (terms or more, count)."""


class Ends(NamedTuple):
    """How robots have ended, a row each."""

    crashed: Flags
    outside: Flags
    """Written."""
    reached: Flags
    """Written: the task is done."""
    paid: Line
    """What leaving the arena was worth, written."""


@law
def end_step(by: Outside, state: Table, success: Flags, rewards: Line, terminated: Flags, ends: Ends) -> None:
    """End to judge a step; all of shape (count,).

    Args:
        by: see ``Outside``.
        state: x, y, z [m] and more, shape (count, n).
        success: whether each robot has done the task.
        rewards, terminated: what the task has given, and whether it has ended the episode.
        ends: see ``Ends``.
    """
    low, high = by.low, by.high
    for i in range(rewards.shape[0]):
        if ends.crashed[i]:
            rewards[i] = by.crash_reward
        x, y, z = state[i, 0], state[i, 1], state[i, 2]
        is_out = x < low[i, 0] or y < low[i, 1] or z < low[i, 2]
        is_out = is_out or x > high[i, 0] or y > high[i, 1] or z > high[i, 2]
        is_out = is_out and not terminated[i]
        ends.outside[i] = is_out
        ends.paid[i] = 0.0
        if is_out and by.ends:
            rewards[i] += by.reward
            ends.paid[i] = by.reward
            terminated[i] = True
        ends.reached[i] = success[i] and not ends.crashed[i]


write_offsets_to = Kernel(write_offsets)
_begin, _end = Kernel(begin_step), Kernel(end_step)


class Extent(NamedTuple):
    """What belongs to a world."""

    arena: Arena
    limits: Arena
    """Where an episode ends."""


class TargetTask(Task):
    """Base of tasks with target positions; subclasses draw them and judge steps.

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
        """Positions of one world that are the same in every episode [m]; the arena holds them. None: they are drawn."""

    def prepare(self, robot: Robot) -> None:
        """See ``Task``."""
        super().prepare(robot)
        count, self._robot = robot.count, robot
        self.flies = flies(robot)
        self.axes = np.array((1.0, 1.0, float(self.flies)))
        assert self.judge_of is not None
        self._ends_on_floor = self.floor_ends and self.flies and self.judge_of.by == TRUTH
        self._extents = PerWorld(self._extent)
        self._low, self._high = np.zeros((count, 3)), np.zeros((count, 3))
        self._floor = np.zeros(count)
        for index in range(count):
            self._settle(index)
        self.positions = np.zeros((count, self.per_robot, 3))
        """x, y, z of each robot's positions [m], shape (count, per_robot, 3)."""
        self.at = np.zeros(count, np.int64)
        """Number of each robot's present target, shape (count,)."""
        self.success = np.zeros(count, np.bool_)
        """Whether each robot has done the task, shape (count,)."""
        self._table: Floats = np.zeros((count, 8))
        """Poses and velocities by which the present step is judged."""
        flags: Any = np.zeros((3, count), np.bool_)
        self._ends = Ends(flags[0], flags[1], flags[2], np.zeros(count))
        self._paid_names = (*self.paid_names(), *(("out",) if self.out_ends else ()))
        self._paid = np.zeros((len(self._paid_names), count))
        """Terms of the last rewards, by name, shape (terms, count)."""
        self._link()

    def _link(self) -> None:
        """Views of arrays: a copy of the task has its own."""
        self._spots, self._per_robot = self.positions.reshape(-1, 3), self.positions.shape[1]
        self.paid: dict[str, Floats] = dict(zip(self._paid_names, self._paid))
        if self.out_ends:
            self._ends = self._ends._replace(paid=self._paid[-1])

    def __setstate__(self, state: dict[str, Any]) -> None:
        vars(self).update(state)
        if "_paid" in state:
            self._link()

    def paid_names(self) -> tuple[str, ...]:
        """Names of the terms that ``_judge`` writes into the rows of ``_paid``; valid after ``Task.prepare``."""
        return ()

    @property
    def is_of_one_world(self) -> bool:  # type: ignore[override]
        """See ``Task``."""
        return self._fixed is not None

    def enter(self, index: int, robot: Robot) -> None:
        """See ``Task``."""
        self._settle(index)

    def _settle(self, index: int) -> None:
        """Take over where the arena of a robot's world ends."""
        world = world_of(self._robot, index)
        self._low[index], self._high[index] = self._extents(world).limits
        self._floor[index] = world.floor_z + ON_FLOOR

    def _extent(self, world: World) -> Extent:
        arena = self._given or arena_of(self._robot, self._reach, world)
        fixed = self._fixed_in(world)
        if fixed is not None and self._given is None:
            arena = arena.around(fixed)
        limits = arena.grown(BEYOND)
        if not self.flies:
            (x0, y0, _), (x1, y1, _) = limits
            limits = limits._replace(low=(x0, y0, -math.inf), high=(x1, y1, math.inf))
        return Extent(arena, self._bounded(limits, world))

    def _fixed_in(self, world: World) -> Floats | None:
        """Positions that are the same in every episode in a world [m], shape (n, 3); None: they are drawn."""
        return self._fixed

    def _bounded(self, limits: Arena, world: World) -> Arena:
        """Where an episode in a world ends."""
        return limits

    def arena_at(self, index: int) -> Arena:
        """The arena of one robot's world."""
        return self._extents(world_of(self._robot, index)).arena

    @property
    def arena(self) -> Arena:
        """That of the first robot."""
        return self.arena_at(0)

    @property
    def _limits(self) -> Arena:
        """Where the first robot's episode ends."""
        return self._extents(world_of(self._robot, 0)).limits

    def _held(self, index: int) -> int:
        """How many positions one robot has."""
        return self.per_robot

    @property
    @abstractmethod
    def per_robot(self) -> int:
        """Positions of an episode."""

    @property
    def targets(self) -> Floats:
        """x, y, z of each robot's present target [m], shape (count, 3)."""
        if self._per_robot == 1:
            return self.positions[:, 0]
        out: Floats = self.positions[np.arange(len(self.at)), np.minimum(self.at, self._per_robot - 1)]
        return out

    def achieved(self) -> Floats:
        """x, y, z of each robot, where it believes to be [m], shape (count, 3)."""
        return self._robot.pose[:, :3]

    def offsets(self, count: int) -> Floats:
        """Offsets to the next ``count`` positions: forward, left, up [m] of the robot's heading, shape (robots, count,
        3)."""
        return self.offsets_from(self._from(), count)

    def _from(self) -> Floats:
        """Poses from which offsets are counted: x, y, z [m], yaw [rad] and maybe more, shape (robots, 4 or more)."""
        found: Floats = self._robot.state if arrays_stay(self._robot) else self._robot.pose  # type: ignore[attr-defined]
        return found

    def offsets_writer(self, count: int, out: Floats, first: int) -> Callable[[], object] | None:
        """A function that writes ``offsets`` into columns of a table, from the first one on, shape (robots, n). None: a
        subclass has offsets of its own."""
        if not all(stands_for(self, "_write_offsets", own) for own in ("offsets", "offsets_from", "_from")):
            return None
        return lambda: self._write_offsets(np.ascontiguousarray(self._from()), count, out, first)

    def _write_offsets(self, pose: Floats, count: int, out: Floats, first: int) -> None:
        write_offsets_to.unchecked()(pose, self._spots, self.at, self._per_robot, count, out, first)

    def offsets_from(self, pose: Floats, count: int) -> Floats:
        """The same from other poses: x, y, z [m], yaw [rad], shape (robots, 4)."""
        out = np.empty((len(self.at), 3 * count))
        self._write_offsets(np.ascontiguousarray(pose, np.float64), count, out, 0)
        return out.reshape(len(out), count, 3)

    def judge(self, step: Step, rewards: Floats, terminated: npt.NDArray[np.bool_]) -> None:
        """See ``Task``."""
        self._table = step.judge.table()
        ends: Any = self._ends
        robot, floor = step.robot, self._floor
        by = Beginning(robot.scan, robot.collided, self._range, self.contact_ends, floor, self._ends_on_floor)
        if self.terms:
            super().judge(step, rewards, terminated)
            paid = rewards.copy()
            _begin.unchecked()(by, self._table, rewards, terminated, ends.crashed)
            rewards[:] = paid
        else:
            _begin.unchecked()(by, self._table, rewards, terminated, ends.crashed)
        self._judge(step, rewards, terminated)
        success = np.ascontiguousarray(self.success, np.bool_)
        outside = Outside(self._low, self._high, float(self.out_reward), self.out_ends, float(self.crash_reward))
        _end.unchecked()(outside, self._table, success, rewards, terminated, ends)
        step.crashed, step.outside, step.reached = ends[:3]  # type: ignore[assignment]  # laws' flags are booleans

    def _outcome(self, rewards: Floats, terminated: npt.NDArray[np.bool_]) -> Outcome:
        """What ``_judge`` writes to."""
        return Outcome(self._ends.crashed, self.success, rewards, terminated, self._paid)

    @abstractmethod
    def _judge(self, step: Step, rewards: Floats, terminated: npt.NDArray[np.bool_]) -> None:
        """Add to the rewards, and mark episodes that the task ends, in place."""

    info_stays = True
    """See ``Task``."""

    def info(self, step: Step) -> dict[str, npt.NDArray[Any]]:
        """See ``Task``."""
        return {"crashed": step.crashed, "is_success": step.reached}

    def memory(self, index: int) -> Any:
        """See ``Task``."""
        return self.positions[index, : self._held(index)].copy(), int(self.at[index]), bool(self.success[index])

    def recall(self, index: int, memory: Any) -> None:
        """See ``Task``."""
        if not isinstance(memory, tuple) or len(memory) < 3 or np.shape(memory[0]) != (self._held(index), 3):
            raise EnvOptionError("snapshot cannot be restored: it is of another task")
        self.positions[index] = memory[0][-1]
        self.positions[index, : self._held(index)], self.at[index], self.success[index] = memory[:3]


def checked_far(task: Task, far: float) -> float:
    """The argument ``far`` of a task.

    Raises:
        EnvOptionError: it is not above 0 m.
    """
    if not far > 0.0:
        raise EnvOptionError(f"{type(task).__name__}(far={far}); it must be above 0 m")
    return float(far)
