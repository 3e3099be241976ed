# SPDX-License-Identifier: BSD-3-Clause
"""Park in a bay, in its heading."""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import Any, NamedTuple

import numpy as np
import numpy.typing as npt

from sitl.core.array_kernels import Kernel, Line, Table
from sitl.core.kernels import law
from sitl.worlds import World

from ..options import EnvOptionError
from ..rewards import Floats, Step
from ..robots.robot import Robot, world_of
from ..worlds import PerWorld
from .target_task import Outcome, TargetTask

_NEAR = 4.0
"""Within about so far of the bay the heading counts [m]."""


class Parking(NamedTuple):
    """How ``Park`` judges."""

    radius: float
    angle: float
    speed: float
    progress: float
    turn_progress: float
    time: float
    """What a step costs."""
    success_reward: float


@law
def worth_of(
    rule: Parking, x: float, y: float, yaw: float, to_x: float, to_y: float, to_yaw: float
) -> tuple[float, float, float]:
    """Distance from a bay [m], error of the heading [rad], and what is left to be paid for both."""
    east, north = to_x - x, to_y - y
    distance = math.sqrt(east * east + north * north)
    error = abs((to_yaw - yaw + math.pi) % math.tau - math.pi)
    share = distance / _NEAR
    counts = 1.0 / (1.0 + share * share)
    return distance, error, rule.progress * distance + rule.turn_progress * error * counts


@law
def judge_park(
    rule: Parking, state: Table, positions: Table, headings: Line, left: Line, away: Line, outcome: Outcome
) -> None:
    """Judge a step of robots that park.

    Args:
        rule: see ``Parking``.
        state: x, y, z [m], yaw [rad], forward speed [m/s] and more, shape (count, n).
        positions: of the bays [m], shape (count, 3).
        headings: of the bays [rad], shape (count,).
        left: what each robot's path is still worth: before the step, becomes that of now, shape (count,).
        away: how far each robot is from its bay [m], likewise, shape (count,).
        outcome: see ``Outcome``; terms of the rewards: progress, turn, time, parked.
    """
    success, rewards, paid = outcome.success, outcome.rewards, outcome.paid
    for i in range(rewards.shape[0]):
        distance, error, worth = worth_of(
            rule, state[i, 0], state[i, 1], state[i, 3], positions[i, 0], positions[i, 1], headings[i]
        )
        both, progress = left[i] - worth, rule.progress * (away[i] - distance)
        rewards[i] += both + rule.time
        left[i], away[i] = worth, distance
        success[i] = distance < rule.radius and error < rule.angle and abs(state[i, 4]) < rule.speed
        parked = rule.success_reward if success[i] else 0.0
        rewards[i] += parked
        paid[0, i], paid[1, i], paid[2, i], paid[3, i] = progress, both - progress, rule.time, parked
        if outcome.crashed[i]:
            paid[0, i], paid[1, i], paid[2, i], paid[3, i] = 0.0, 0.0, 0.0, 0.0
        if success[i]:
            outcome.terminated[i] = True


_park = Kernel(judge_park)


class Park(TargetTask):
    """Drive into a bay, drawn at random for each episode, and stop there in the bay's heading.

    Success ends the episode: the robot is within ``radius`` of the bay's centre, its heading error is below ``angle``
    and it is slower than ``speed``. Reward of a step: ``progress`` times the decrease of the distance [m], plus
    ``turn_progress`` times the decrease of the heading error [rad] weighted by 1 / (1 + (distance / 4 m)^2), plus
    ``each_second`` times the step's seconds; with success ``success_reward`` is added.

    Args:
        bays: (x, y, yaw) of each bay [m, rad]; None: the world's markings "bay 1", "bay 2", ...
        radius: greatest distance from the bay's centre [m].
        angle: greatest heading error [rad].
        speed: speed below which the robot counts as stopped [m/s].
        progress: reward for each metre nearer.
        turn_progress: reward for each radian of heading error less.
        each_second: reward per second.
        success_reward: reward for parking.
        others: further arguments of ``TargetTask``.
    """

    per_robot = 1

    def __init__(
        self,
        bays: Sequence[Sequence[float]] | None = None,
        radius: float = 0.4,
        angle: float = 0.15,
        speed: float = 0.2,
        progress: float = 1.0,
        turn_progress: float = 2.0,
        each_second: float = -0.2,
        success_reward: float = 20.0,
        **others: Any,
    ) -> None:
        super().__init__(**others)
        self._bays = np.zeros((0, 3)) if bays is None else np.array(bays, np.float64)
        is_table = self._bays.ndim == 2 and self._bays.shape[1] == 3 and np.isfinite(self._bays).all()
        if bays is not None and not (is_table and len(self._bays)):
            raise EnvOptionError(f"Park(bays={bays!r}); it must be (x, y, yaw) [m, rad], one at least, finite numbers")
        for name, value in {"radius": radius, "angle": angle, "speed": speed}.items():
            if not value > 0.0:
                raise EnvOptionError(f"Park({name}={value}); it must be above 0")
        self.radius, self.angle, self.speed = radius, angle, speed
        self.progress, self.turn_progress = progress, turn_progress
        self.each_second, self.success_reward = each_second, success_reward

    def prepare(self, robot: Robot) -> None:
        """See ``Task``."""
        super().prepare(robot)
        self._bays_in = PerWorld(self._marked)
        self._bays_in(robot.world)
        self.headings = np.zeros(robot.count)
        """Of each robot's bay [rad], shape (count,)."""
        self._left = np.zeros(robot.count)
        """What each robot's path is still worth."""
        self._distance = np.zeros(robot.count)
        """From each robot to its bay [m]."""

    @property
    def is_of_one_world(self) -> bool:  # type: ignore[override]
        """See ``Task``."""
        return len(self._bays) > 0

    def enter(self, index: int, robot: Robot) -> None:
        """See ``Task``."""
        super().enter(index, robot)
        self._bays_in(world_of(robot, index))

    def _marked(self, world: World) -> Floats:
        """Bays of a world: x, y [m], yaw [rad], shape (n, 3)."""
        if len(self._bays):
            return self._bays
        marked = [m for m in world.markings if m.name.startswith("bay ")]
        if not marked:
            raise EnvOptionError(f'Park: world {world.name!r} has no markings "bay 1", "bay 2", ...')
        return np.array([(*m.centre, m.yaw) for m in marked])

    def start(self, index: int, robot: Robot, rng: np.random.Generator) -> None:
        """See ``Task``."""
        bays = self._bays_in(world_of(robot, index))
        x, y, yaw = bays[int(rng.integers(len(bays)))].tolist()
        self.positions[index, 0] = x, y, self.judged_pose()[index, 2]
        self.headings[index], self.at[index], self.success[index] = yaw, 0, False
        assert self.judge_of is not None
        here, there, _, heading, *_ = self.judge_of.table()[index].tolist()
        self._distance[index], _, self._left[index] = worth_of(self._rule(0.0), here, there, heading, x, y, yaw)

    def turns(self) -> Floats:
        """How far each robot has to turn to the bay's heading, counter-clockwise, within -pi .. pi [rad]."""
        turn = self.headings - self._robot.pose[:, 3]
        out: Floats = (turn + math.pi) % math.tau - math.pi
        return out

    def _judge(self, step: Step, rewards: Floats, terminated: npt.NDArray[np.bool_]) -> None:
        _park.unchecked()(
            self._rule(step.seconds), self._table, self._spots, self.headings, self._left, self._distance,
            self._outcome(rewards, terminated),
        )  # fmt: skip

    def _rule(self, seconds: float) -> Parking:
        return Parking(
            float(self.radius), float(self.angle), float(self.speed), float(self.progress), float(self.turn_progress),
            float(self.each_second * seconds), float(self.success_reward),
        )  # fmt: skip

    def paid_names(self) -> tuple[str, ...]:
        """See ``TargetTask``."""
        return "progress", "turn", "time", "parked"

    def memory(self, index: int) -> Any:
        """See ``Task``."""
        mine = float(self.headings[index]), float(self._left[index]), float(self._distance[index])
        return *super().memory(index), *mine

    def recall(self, index: int, memory: Any) -> None:
        """See ``Task``."""
        super().recall(index, memory)
        self.headings[index], self._left[index], self._distance[index] = memory[3:6]
