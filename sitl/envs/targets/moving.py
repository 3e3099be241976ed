# SPDX-License-Identifier: BSD-3-Clause
"""Be where a target is that moves: along a trajectory, or as it likes."""

from __future__ import annotations

import math
from abc import abstractmethod
from collections.abc import Callable, Sequence
from typing import Any, NamedTuple

import numpy as np
import numpy.typing as npt

from ..options import EnvOptionError, unknown
from ..rewards import Floats, Step
from ..robots.robot import Robot
from .places import PlacesTask

AHEAD_S = 0.5
"""Time from one of the places that "path" tells to the next [s]."""


class MovingTask(PlacesTask):
    """Base of tasks whose target moves. Each step pays ``step_time * (1 - distance / scale)``, at least 0.

    ``info["is_success"]``: the root mean square of the distances so far, after the first ``settle`` seconds, is below
    ``radius``; ``info["error"]`` is that figure [m], 0 until then.

    Args:
        radius: see above [m].
        settle: time to get there [s].
        scale: distance beyond which nothing is paid [m].
        lost: distance beyond which the episode ends [m].
        others: further arguments of ``PlacesTask``.
    """

    per_robot = 1

    def __init__(
        self, radius: float = 0.7, settle: float = 5.0, scale: float = 4.0, lost: float = 10.0, **others: Any
    ) -> None:
        super().__init__(**others)
        for name, value in {"radius": radius, "scale": scale, "lost": lost}.items():
            if not value > 0.0:
                raise EnvOptionError(f"{type(self).__name__}({name}={value}); it must be above 0 m")
        self.radius, self.settle, self.scale, self.lost = radius, settle, scale, lost

    def prepare(self, robot: Robot) -> None:
        """See ``Task``."""
        super().prepare(robot)
        self.sums = np.zeros((robot.count, 2))
        """Sum of the squared distances [m^2], and their number, shape (count, 2)."""
        self.centre = np.zeros((robot.count, 3))
        """Where each target begins: the robot's start, x, y, z [m], shape (count, 3)."""

    def start(self, index: int, robot: Robot, rng: np.random.Generator) -> None:
        """See ``Task``."""
        self.centre[index] = robot.pose[index, :3]
        self.at[index], self.sums[index], self.success[index] = 0, 0.0, False
        self._draw(index, rng)
        self.places[index, 0] = self.along(np.zeros((self._robot.count, 1)))[index, 0]

    def _draw(self, index: int, rng: np.random.Generator) -> None:
        """Draw what is random in one robot's episode."""

    @abstractmethod
    def along(self, time: Floats) -> Floats:
        """Where each robot's target is: x, y, z [m], shape (count, k, 3), at times of its episode [s], shape (count,
        k)."""

    @property
    def targets(self) -> Floats:
        """See ``PlacesTask``."""
        out: Floats = self.places[:, 0]
        return out

    def ways(self, count: int) -> Floats:
        """See ``PlacesTask``: where the target is now, and after each further 0.5 s."""
        return self.ways_from(self._robot.pose, count)

    def ways_from(self, pose: Floats, count: int) -> Floats:
        """The same from other poses: x, y, z [m], yaw [rad], shape (robots, 4)."""
        way = self.along(self._robot.time[:, None] + AHEAD_S * np.arange(count)) - pose[:, None, :3]
        c, s = np.cos(pose[:, 3])[:, None], np.sin(pose[:, 3])[:, None]
        return np.stack([way[..., 0] * c + way[..., 1] * s, way[..., 1] * c - way[..., 0] * s, way[..., 2]], axis=2)

    def _judge(self, step: Step, rewards: Floats, terminated: npt.NDArray[np.bool_]) -> None:
        time = step.robot.time
        self.places[:, 0] = self.along(time[:, None])[:, 0]
        way = self.places[:, 0] - step.pose[:, :3]
        squared = (way * way).sum(axis=1)
        distance = np.sqrt(squared)
        near = step.seconds * np.maximum(1.0 - distance / self.scale, 0.0)
        rewards += near
        step.note(nearness=near)
        counts = time >= self.settle
        self.sums[counts] += np.stack([squared, np.ones(len(squared))], axis=1)[counts]
        self.success = counts & (self._errors() < self.radius)
        terminated |= distance > self.lost

    def _errors(self) -> Floats:
        out: Floats = np.sqrt(self.sums[:, 0] / np.maximum(self.sums[:, 1], 1.0))
        return out

    def info(self, step: Step) -> dict[str, npt.NDArray[Any]]:
        """See ``Task``."""
        return {**super().info(step), "error": self._errors()}

    def memory(self, index: int) -> Any:
        """See ``Task``."""
        return *super().memory(index), self.sums[index].copy(), self.centre[index].copy()

    def recall(self, index: int, memory: Any) -> None:
        """See ``Task``."""
        super().recall(index, memory)
        self.sums[index], self.centre[index] = memory[3:5]


class Curve(NamedTuple):
    """A closed curve of size 1 about its beginning."""

    points: Callable[[Floats], tuple[Floats, Floats, Floats]]
    """Forward, left, up, each of the shape of the phases [rad]."""
    length: float
    """Of one round, horizontally."""


def _eight(phase: Floats) -> tuple[Floats, Floats, Floats]:
    return np.sin(phase), np.sin(phase) * np.cos(phase), np.zeros_like(phase)


def _circle(phase: Floats) -> tuple[Floats, Floats, Floats]:
    return np.sin(phase), 1.0 - np.cos(phase), np.zeros_like(phase)


def _helix(phase: Floats) -> tuple[Floats, Floats, Floats]:
    return np.sin(phase), 1.0 - np.cos(phase), 0.5 * (1.0 - np.cos(phase / 3.0))


CURVES = {"eight": Curve(_eight, 6.097), "circle": Curve(_circle, math.tau), "helix": Curve(_helix, math.tau)}
"""A figure of eight (the lemniscate of Gerono), a circle, a helix that climbs for three rounds and comes down in as
many."""


class Trajectory(MovingTask):
    """Follow a point that moves along a curve, which begins where the robot does, ahead of it.

    Args:
        curve: name (``CURVES``).
        size: half of the figure's extent ahead, the circle's radius [m].
        speed: mean speed along it [m/s]; or (least, greatest), drawn for each episode.
        others: further arguments of ``MovingTask``.
    """

    def __init__(
        self, curve: str = "eight", size: float = 5.0, speed: float | Sequence[float] = 2.0, **others: Any
    ) -> None:
        super().__init__(**others)
        if curve not in CURVES:
            raise unknown("Trajectory: curve", curve, CURVES)
        low, high = (speed, speed) if isinstance(speed, int | float) else speed
        if not (size > 0.0 and 0.0 < low <= high):
            raise EnvOptionError(f"Trajectory(size={size}, speed={speed!r}); they must be above 0")
        self.curve, self.size, self.speed = curve, size, (float(low), float(high))

    def prepare(self, robot: Robot) -> None:
        """See ``Task``."""
        super().prepare(robot)
        self._drawn = np.zeros((robot.count, 2))
        """Rate of the phase [rad/s] and direction [rad] of each robot's curve."""

    def start(self, index: int, robot: Robot, rng: np.random.Generator) -> None:
        """See ``Task``."""
        self._drawn[index, 1] = robot.pose[index, 3]
        super().start(index, robot, rng)

    def _draw(self, index: int, rng: np.random.Generator) -> None:
        speed = rng.uniform(*self.speed)
        self._drawn[index, 0] = math.tau * speed / (self.size * CURVES[self.curve].length)

    def along(self, time: Floats) -> Floats:
        """See ``MovingTask``."""
        rate, yaw = self._drawn[:, :1], self._drawn[:, 1:]
        ahead, left, up = CURVES[self.curve].points(rate * time)
        c, s = np.cos(yaw), np.sin(yaw)
        up = up if self.flies else 0.0 * up
        return self.centre[:, None] + self.size * np.stack([ahead * c - left * s, ahead * s + left * c, up], axis=2)

    def memory(self, index: int) -> Any:
        """See ``Task``."""
        return *super().memory(index), self._drawn[index].copy()

    def recall(self, index: int, memory: Any) -> None:
        """See ``Task``."""
        super().recall(index, memory)
        self._drawn[index] = memory[5]


class Follow(MovingTask):
    """Stay with a target that wanders about: its position is a sum of slow waves, others in each episode.

    Args:
        size: how far it goes from where it begins, horizontally [m].
        speed: its greatest speed [m/s].
        height: how far it goes up and down; 0 for a robot that does not fly [m].
        others: further arguments of ``MovingTask``.
    """

    waves = 3

    def __init__(self, size: float = 6.0, speed: float = 2.0, height: float = 1.0, **others: Any) -> None:
        super().__init__(**others)
        if not (size > 0.0 and speed > 0.0 and height >= 0.0):
            raise EnvOptionError(f"Follow(size={size}, speed={speed}, height={height}); size and speed must be above 0")
        self.size, self.speed, self.height = size, speed, height

    def prepare(self, robot: Robot) -> None:
        """See ``Task``."""
        super().prepare(robot)
        self._waves = np.zeros((robot.count, 3, self.waves, 3))
        """Amplitude [m], rate [rad/s] and phase [rad] of each robot's waves along x, y, z."""

    def _draw(self, index: int, rng: np.random.Generator) -> None:
        shares = rng.dirichlet(np.ones(self.waves), 3)
        reach = np.array([0.5 * self.size, 0.5 * self.size, 0.5 * self.height if self.flies else 0.0])
        amplitudes = shares * reach[:, None]
        rates = rng.uniform(0.3, 1.0, (3, self.waves))
        fastest = math.sqrt(float(((amplitudes * rates).sum(axis=1)[:2] ** 2).sum()))
        rates *= self.speed / fastest
        self._waves[index] = np.stack([amplitudes, rates, rng.uniform(0.0, math.tau, (3, self.waves))], axis=2)

    def along(self, time: Floats) -> Floats:
        """See ``MovingTask``."""
        amplitude, rate, phase = np.moveaxis(self._waves, 3, 0)
        now = np.sin(rate[:, None] * time[:, :, None, None] + phase[:, None]) - np.sin(phase)[:, None]
        out: Floats = self.centre[:, None] + (amplitude[:, None] * now).sum(axis=3)
        return out

    def memory(self, index: int) -> Any:
        """See ``Task``."""
        return *super().memory(index), self._waves[index].copy()

    def recall(self, index: int, memory: Any) -> None:
        """See ``Task``."""
        super().recall(index, memory)
        self._waves[index] = memory[5]
