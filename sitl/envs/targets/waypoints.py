# SPDX-License-Identifier: BSD-3-Clause
"""Go to a waypoint, or to several in order."""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import Any, NamedTuple

import numpy as np
import numpy.typing as npt

from sitl.core.array_kernels import Flags, IntLine, Kernel, Line, Table
from sitl.core.kernels import law
from sitl.core.sums import lengths
from sitl.worlds import World

from ..options import EnvOptionError
from ..rewards import Floats, Step
from ..robots.robot import Robot, world_of
from ..starts import ReachableCells
from ..worlds import PerWorld
from .target_task import Outcome, TargetTask


class Nearing(NamedTuple):
    """How robots come to their waypoints, shape (count,)."""

    distance: Line
    """To each robot's present waypoint [m]: of the step before, becomes that of now."""
    gain: Line
    """How much nearer each robot has come [m], written."""
    passed: Flags
    """Whether each robot has passed a waypoint, written."""


@law
def pass_targets(pose: Table, positions: Table, up: float, radius: float, at: IntLine, nearing: Nearing) -> None:
    """Judge a step on the way along waypoints.

    Args:
        pose: x, y, z [m] and more, shape (count, m).
        positions: x, y, z [m], one robot after another, shape (count * n, 3).
        up: what heights count: 1, or 0 for robots that do not fly.
        radius: distance at which a waypoint is passed [m].
        at: number of each robot's present waypoint; goes on where that is passed, shape (count,).
        nearing: see ``Nearing``.
    """
    distance, gain, passed = nearing.distance, nearing.gain, nearing.passed
    per_robot = positions.shape[0] // at.shape[0]
    for i in range(at.shape[0]):
        row = i * per_robot + min(at[i], per_robot - 1)
        x, y, z = positions[row, 0] - pose[i, 0], positions[row, 1] - pose[i, 1], up * (positions[row, 2] - pose[i, 2])
        now = math.sqrt(x * x + y * y + z * z)
        gain[i] = distance[i] - now
        passed[i] = now < radius and at[i] < per_robot
        distance[i] = now
        if passed[i]:
            at[i] += 1
            if at[i] < per_robot:
                row += 1
                x, y, z = (
                    positions[row, 0] - pose[i, 0],
                    positions[row, 1] - pose[i, 1],
                    up * (positions[row, 2] - pose[i, 2]),
                )
                distance[i] = math.sqrt(x * x + y * y + z * z)


class Prices(NamedTuple):
    """What is paid."""

    progress: float
    """For each metre nearer."""
    passing: float
    """For each waypoint passed."""
    time: float
    """For a step."""


@law
def pay_targets(prices: Prices, nearer: Line, passed: Flags, at: IntLine, last: int, outcome: Outcome) -> int:
    """Pay for a step on the way along waypoints; all of shape (count,).

    Args:
        prices: see ``Prices``.
        nearer: how much nearer each robot has come [m].
        passed: whether each robot has passed a waypoint.
        at: number of each robot's present waypoint.
        last: number of waypoints: who has passed all has done the task, and the episode ends.
        outcome: see ``Outcome``; terms of the rewards: progress, places, time.

    Returns:
        How many have passed a waypoint, and have others before them.
    """
    success, rewards, paid = outcome.success, outcome.rewards, outcome.paid
    going = 0
    for i in range(rewards.shape[0]):
        gain, passing = prices.progress * nearer[i], prices.passing if passed[i] else 0.0
        rewards[i] += gain + passing + prices.time
        paid[0, i], paid[1, i], paid[2, i] = gain, passing, prices.time
        if outcome.crashed[i]:
            paid[0, i], paid[1, i], paid[2, i] = 0.0, 0.0, 0.0
        success[i] = at[i] == last
        if success[i]:
            outcome.terminated[i] = True
        elif passed[i]:
            going += 1
    return going


_pass, _pay = Kernel(pass_targets), Kernel(pay_targets)


class Waypoints(TargetTask):
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
        others: further arguments of ``TargetTask``.
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
        if self._fixed is not None and not _are_places(self._fixed):
            raise EnvOptionError(f"Waypoints(places={places!r}); it must be one (x, y, z) [m] at least, finite numbers")
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
        """See ``TargetTask``."""
        return self._count

    def prepare(self, robot: Robot) -> None:
        """See ``Task``."""
        super().prepare(robot)
        self._distance, self._gain = np.zeros(robot.count), np.zeros(robot.count)
        self._passed = np.zeros(robot.count, np.bool_)
        self._going = 0
        """How many robots have passed a waypoint in this step, and go on to another."""
        self._cells_in = PerWorld(self._cells) if self.reachable and self._fixed is None else None
        if self._cells_in is not None:
            self._cells_in(robot.world)

    def _cells(self, world: World) -> ReachableCells:
        return ReachableCells(self._robot, self.limit, world=world)

    def start(self, index: int, robot: Robot, rng: np.random.Generator) -> None:
        """See ``Task``."""
        here = self.judged_pose()[index, :3]
        self.positions[index] = self._drawn(index, here, rng) if self._fixed is None else self._fixed
        self.at[index], self.success[index] = 0, False
        self._distance[index] = lengths(self.axes * (self.positions[index, 0] - here))

    def _drawn(self, index: int, here: Floats, rng: np.random.Generator) -> Floats:
        out, arena = np.empty((self._count, 3)), self.arena_at(index)
        cells = None if self._cells_in is None else self._cells_in(world_of(self._robot, index))
        for k in range(self._count):
            for _ in range(100):
                out[k] = arena.draw(rng) if cells is None else (*cells.draw(rng), here[2])
                if np.square(out[k] - here).sum() >= self.apart * self.apart:
                    break
            here = out[k]
        return out

    def _judge(self, step: Step, rewards: Floats, terminated: npt.NDArray[np.bool_]) -> None:
        state, up = self._table, float(self.axes[2])
        _pass.unchecked()(
            state, self._spots, up, float(self.radius), self.at, Nearing(self._distance, self._gain, self._passed)
        )  # fmt: skip
        prices = Prices(float(self.progress), float(self.place_reward), float(self.each_second * step.seconds))
        self._going = _pay.unchecked()(
            prices, self._nearer(state), self._passed, self.at, self._count, self._outcome(rewards, terminated)
        )  # fmt: skip

    def paid_names(self) -> tuple[str, ...]:
        """See ``TargetTask``."""
        return "progress", "places", "time"

    def _nearer(self, pose: Floats) -> Floats:
        """How much nearer each robot has come to its waypoint [m], shape (count,)."""
        return self._gain

    info_stays = True

    def info(self, step: Step) -> dict[str, npt.NDArray[Any]]:
        """See ``Task``."""
        return {**super().info(step), "passed": self.at}

    def memory(self, index: int) -> Any:
        """See ``Task``."""
        return *super().memory(index), float(self._distance[index])

    def recall(self, index: int, memory: Any) -> None:
        """See ``Task``."""
        super().recall(index, memory)
        self._distance[index] = memory[3]


def _are_places(rows: Floats) -> bool:
    """Whether it is one row at least of x, y, z."""
    return bool(rows.ndim == 2 and rows.shape[1] == 3 and len(rows) and np.isfinite(rows).all())
