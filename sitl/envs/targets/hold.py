# SPDX-License-Identifier: BSD-3-Clause
"""Go to a target position and hold it: hover in wind."""

from __future__ import annotations

from typing import Any

import numpy as np
import numpy.typing as npt

from ..options import EnvOptionError
from ..rewards import Floats, Step
from ..robots.robot import Robot
from .places import PlacesTask


class Hold(PlacesTask):
    """Go to a target position near the start and hold it.

    Reward of a step: ``step_time * max(1 - distance / scale, 0)``, minus ``effort * step_time`` times the mean squared
    action. ``info["is_success"]``: the robot has been within ``radius`` for the last ``hold`` seconds. Success does not
    end the episode.

    Args:
        offset: greatest distance of the random target from the start, horizontally along each axis and vertically [m].
        radius: distance that counts as reached [m].
        hold: time to stay there for success [s].
        scale: distance from which on the reward is 0 [m].
        effort: weight of the squared actions.
        is_sparse: the reward is that of ``compute_reward`` instead: 0 within ``radius``, else -1.
        others: further arguments of ``PlacesTask``.
    """

    per_robot = 1

    def __init__(
        self,
        offset: tuple[float, float] = (3.0, 1.0),
        radius: float = 0.5,
        hold: float = 5.0,
        scale: float = 4.0,
        effort: float = 0.05,
        is_sparse: bool = False,
        **others: Any,
    ) -> None:
        super().__init__(**others)
        for name, value in {"radius": radius, "hold": hold, "scale": scale}.items():
            if not value > 0.0:
                raise EnvOptionError(f"Hold({name}={value}); it must be above 0")
        self.offset, self.radius, self.hold, self.scale, self.effort = offset, radius, hold, scale, effort
        self.is_sparse = is_sparse

    def prepare(self, robot: Robot) -> None:
        """See ``Task``."""
        super().prepare(robot)
        self.since = np.zeros(robot.count)
        """How long each robot has been at its place [s], shape (count,)."""

    def start(self, index: int, robot: Robot, rng: np.random.Generator) -> None:
        """See ``Task``."""
        wide, high = self.offset
        place = robot.pose[index, :3] + rng.uniform(-1.0, 1.0, 3) * (wide, wide, high if self.flies else 0.0)
        self.places[index, 0] = np.clip(place, self.arena.low, self.arena.high)
        self.at[index], self.since[index], self.success[index] = 0, 0.0, False

    def _judge(self, step: Step, rewards: Floats, terminated: npt.NDArray[np.bool_]) -> None:
        way = self.axes * (self.places[:, 0] - step.pose[:, :3])
        distance = np.sqrt((way * way).sum(axis=1))
        if self.is_sparse:
            paid = self.compute_reward(self.achieved(), self.targets, None)
            rewards += paid
            step.note(goal=paid)
        else:
            self._pay(step, rewards, distance)
        self.since = np.where(distance < self.radius, self.since + step.seconds, 0.0)
        self.success = self.since >= self.hold - 1e-9

    def _pay(self, step: Step, rewards: Floats, distance: Floats) -> None:
        near = step.seconds * np.maximum(1.0 - distance / self.scale, 0.0)
        rewards += near
        step.note(nearness=near)
        if self.effort and step.actions.ndim == 2:
            effort = self.effort * step.seconds * (step.actions * step.actions).mean(axis=1)
            rewards -= effort
            step.note(effort=-effort)

    def compute_reward(self, achieved: Any, desired: Any, info: Any) -> Floats:
        """0 within ``radius``, -1 elsewhere: what a goal-conditioned step pays, of goals [m] of shape (..., 3)."""
        way = self.axes * (np.asarray(achieved, np.float64) - np.asarray(desired, np.float64))
        out: Floats = np.where(np.sqrt((way * way).sum(axis=-1)) < self.radius, 0.0, -1.0)
        return out

    def memory(self, index: int) -> Any:
        """See ``Task``."""
        return *super().memory(index), float(self.since[index])

    def recall(self, index: int, memory: Any) -> None:
        """See ``Task``."""
        super().recall(index, memory)
        self.since[index] = memory[3]
