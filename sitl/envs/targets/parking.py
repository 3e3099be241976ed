# SPDX-License-Identifier: BSD-3-Clause
"""Park in a bay, in its heading."""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import Any

import numpy as np
import numpy.typing as npt

from ..options import EnvOptionError
from ..rewards import Floats, Step
from ..robots.robot import Robot
from .places import PlacesTask

_NEAR = 4.0
"""Within about so far of the bay the heading counts [m]."""


class Park(PlacesTask):
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
        others: further arguments of ``PlacesTask``.
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
        if bays is not None and not (self._bays.ndim == 2 and self._bays.shape[1] == 3 and len(self._bays)):
            raise EnvOptionError(f"Park(bays={bays!r}); it must be (x, y, yaw) [m, rad], one at least")
        for name, value in {"radius": radius, "angle": angle, "speed": speed}.items():
            if not value > 0.0:
                raise EnvOptionError(f"Park({name}={value}); it must be above 0")
        self.radius, self.angle, self.speed = radius, angle, speed
        self.progress, self.turn_progress = progress, turn_progress
        self.each_second, self.success_reward = each_second, success_reward

    def prepare(self, robot: Robot) -> None:
        """See ``Task``."""
        if not len(self._bays):
            marked = [m for m in robot.world.markings if m.name.startswith("bay ")]
            if not marked:
                raise EnvOptionError(f'Park: world {robot.world.name!r} has no markings "bay 1", "bay 2", ...')
            self._bays = np.array([(*m.centre, m.yaw) for m in marked])
        super().prepare(robot)
        self.headings = np.zeros(robot.count)
        """Of each robot's bay [rad], shape (count,)."""
        self._left = np.zeros(robot.count)
        """What each robot's way is still worth."""
        self._distance = np.zeros(robot.count)
        """From each robot to its bay [m]."""

    def start(self, index: int, robot: Robot, rng: np.random.Generator) -> None:
        """See ``Task``."""
        x, y, yaw = self._bays[int(rng.integers(len(self._bays)))].tolist()
        self.places[index, 0] = x, y, self.judged_pose()[index, 2]
        self.headings[index], self.at[index], self.success[index] = yaw, 0, False
        distance, _, left = self._worth(self.judged_pose())
        self._distance[index], self._left[index] = distance[index], left[index]

    def turns(self) -> Floats:
        """How far each robot has to turn to the bay's heading, counter-clockwise, within -pi .. pi [rad]."""
        return self._turns_from(self._robot.pose)

    def _turns_from(self, pose: Floats) -> Floats:
        turn = self.headings - pose[:, 3]
        out: Floats = (turn + math.pi) % math.tau - math.pi
        return out

    def _worth(self, pose: Floats) -> tuple[Floats, Floats, Floats]:
        """Distance [m], error of the heading [rad], and what is left to be paid for both."""
        way = self.places[:, 0, :2] - pose[:, :2]
        distance = np.sqrt((way * way).sum(axis=1))
        error = np.abs(self._turns_from(pose))
        counts = 1.0 / (1.0 + np.square(distance / _NEAR))
        return distance, error, self.progress * distance + self.turn_progress * error * counts

    def _judge(self, step: Step, rewards: Floats, terminated: npt.NDArray[np.bool_]) -> None:
        distance, error, left = self._worth(step.pose)
        paid, time, gain = self._left - left, self.each_second * step.seconds, self._distance - distance
        rewards += paid + time
        self._left, self._distance = left, distance
        stands = np.abs(step.velocity[:, 0]) < self.speed
        self.success = (distance < self.radius) & (error < self.angle) & stands
        rewards[self.success] += self.success_reward
        progress, parked = self.progress * gain, self.success_reward * self.success
        step.note(progress=progress, turn=paid - progress, time=time, parked=parked)
        terminated |= self.success

    def memory(self, index: int) -> Any:
        """See ``Task``."""
        mine = float(self.headings[index]), float(self._left[index]), float(self._distance[index])
        return *super().memory(index), *mine

    def recall(self, index: int, memory: Any) -> None:
        """See ``Task``."""
        super().recall(index, memory)
        self.headings[index], self._left[index], self._distance[index] = memory[3:6]
