# SPDX-License-Identifier: BSD-3-Clause
"""Follow a moving target: along a trajectory, or at random."""

from __future__ import annotations

import math
from abc import abstractmethod
from collections.abc import Callable, Sequence
from typing import Any, NamedTuple

import numpy as np
import numpy.typing as npt

from sitl.core import elementary_arrays as arrays

from ..noise import dirichlet
from ..options import EnvOptionError, unknown
from ..rewards import Floats, Step
from ..robots.robot import Robot
from .places import PlacesTask, nearness

AHEAD_S = 0.5
"""Time from one of the places that "path" tells to the next [s]."""


class MovingTask(PlacesTask):
    """Base of tasks with a moving target. Reward of a step: ``step_time * max(1 - distance / scale, 0)``, or with
    ``half`` ``step_time / (1 + (distance / half)^2)``.

    ``info["error"]`` is the root mean square distance to the target since the first ``settle`` seconds [m], 0 before.
    ``info["is_success"]``: it is below ``radius``. "path" is the vector to the target now, in 0.5 s and in 1 s.

    Args:
        radius: greatest root mean square distance of a success [m].
        settle: time at the start that does not count [s].
        scale: distance from which on the reward is 0 [m].
        lost: distance beyond which the episode ends [m].
        lost_reward: added to the reward then.
        half: distance at which the reward is half of that at the target [m]; None: it decreases linearly (``scale``).
        others: further arguments of ``PlacesTask``.
    """

    per_robot = 1

    def __init__(
        self, radius: float = 0.7, settle: float = 5.0, scale: float = 4.0, lost: float = 10.0,
        lost_reward: float = 0.0, half: float | None = None, **others: Any,
    ) -> None:  # fmt: skip
        super().__init__(**others)
        given = {"radius": radius, "scale": scale, "lost": lost, "half": 1.0 if half is None else half}
        for name, value in given.items():
            if not value > 0.0:
                raise EnvOptionError(f"{type(self).__name__}({name}={value}); it must be above 0 m")
        self.radius, self.settle, self.scale, self.lost = radius, settle, scale, lost
        self.lost_reward, self.half = lost_reward, half

    def prepare(self, robot: Robot) -> None:
        """See ``Task``."""
        super().prepare(robot)
        self.sums = np.zeros((robot.count, 2))
        """Sum of the squared distances [m^2], and their number, shape (count, 2)."""
        self.centre = np.zeros((robot.count, 3))
        """Where each target begins: the robot's start, x, y, z [m], shape (count, 3)."""

    def start(self, index: int, robot: Robot, rng: np.random.Generator) -> None:
        """See ``Task``."""
        self.centre[index] = self.judged_pose()[index, :3]
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
        c, s = arrays.cos(pose[:, 3])[:, None], arrays.sin(pose[:, 3])[:, None]
        return np.stack([way[..., 0] * c + way[..., 1] * s, way[..., 1] * c - way[..., 0] * s, way[..., 2]], axis=2)

    def _judge(self, step: Step, rewards: Floats, terminated: npt.NDArray[np.bool_]) -> None:
        time = step.robot.time
        self.places[:, 0] = self.along(time[:, None])[:, 0]
        way = self.axes * (self.places[:, 0] - step.pose[:, :3])
        squared = (way * way).sum(axis=1)
        distance = np.sqrt(squared)
        near = step.seconds * nearness(distance, self.scale, self.half)
        rewards += near
        step.note(nearness=near)
        self.success = self._note_errors(time, squared) & (self._errors() < self.radius)
        self._end_lost(step, distance > self.lost, rewards, terminated)

    def _end_lost(
        self, step: Step, lost: npt.NDArray[np.bool_], rewards: Floats, terminated: npt.NDArray[np.bool_]
    ) -> None:
        """End the episodes of robots that have lost the target."""
        if self.lost_reward:
            paid = np.where(lost & ~terminated, self.lost_reward, 0.0)
            rewards += paid
            step.note(lost=paid)
        terminated |= lost

    def _note_errors(self, time: Floats, squared: Floats) -> npt.NDArray[np.bool_]:
        """Note squared distances [m^2] for the error; tells for which robots they count."""
        counts = time >= self.settle
        self.sums[counts] += np.stack([squared, np.ones(len(squared))], axis=1)[counts]
        return counts

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
    return arrays.sin(phase), arrays.sin(phase) * arrays.cos(phase), np.zeros_like(phase)


def _circle(phase: Floats) -> tuple[Floats, Floats, Floats]:
    return arrays.sin(phase), 1.0 - arrays.cos(phase), np.zeros_like(phase)


def _helix(phase: Floats) -> tuple[Floats, Floats, Floats]:
    return arrays.sin(phase), 1.0 - arrays.cos(phase), 0.5 * (1.0 - arrays.cos(phase / 3.0))


CURVES = {"eight": Curve(_eight, 6.097), "circle": Curve(_circle, math.tau), "helix": Curve(_helix, math.tau)}
"""A figure of eight (the lemniscate of Gerono), a circle, a helix that climbs for three rounds and comes down in as
many."""


class Trajectory(MovingTask):
    """Follow a point along a closed curve that begins at the robot's start.

    Args:
        curve: "eight", "circle" or "helix".
        size: half of the length of the figure of eight, or radius of the circle and helix [m].
        speed: mean speed along the curve [m/s], or a range (low, high) to draw from in each episode.
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
        self._drawn[index, 1] = self.judged_pose()[index, 3]
        super().start(index, robot, rng)

    def _draw(self, index: int, rng: np.random.Generator) -> None:
        speed = rng.uniform(*self.speed)
        self._drawn[index, 0] = math.tau * speed / (self.size * CURVES[self.curve].length)

    def along(self, time: Floats) -> Floats:
        """See ``MovingTask``."""
        rate, yaw = self._drawn[:, :1], self._drawn[:, 1:]
        ahead, left, up = CURVES[self.curve].points(rate * time)
        c, s = arrays.cos(yaw), arrays.sin(yaw)
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
    """Follow a target that moves at random: its position is a sum of sines, drawn anew in each episode.

    Args:
        size: greatest distance of the target from its start along each horizontal axis [m].
        speed: greatest speed of the target [m/s].
        height: greatest vertical distance of the target from its start; 0 for a robot that does not fly [m].
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
        shares = dirichlet(rng, 3, self.waves)
        reach = np.array([0.5 * self.size, 0.5 * self.size, 0.5 * self.height if self.flies else 0.0])
        amplitudes = shares * reach[:, None]
        rates = rng.uniform(0.3, 1.0, (3, self.waves))
        fastest = math.sqrt(float(np.square((amplitudes * rates).sum(axis=1)[:2]).sum()))
        rates *= self.speed / fastest
        self._waves[index] = np.stack([amplitudes, rates, rng.uniform(0.0, math.tau, (3, self.waves))], axis=2)

    def along(self, time: Floats) -> Floats:
        """See ``MovingTask``."""
        amplitude, rate, phase = np.moveaxis(self._waves, 3, 0)
        now = arrays.sin(rate[:, None] * time[:, :, None, None] + phase[:, None]) - arrays.sin(phase)[:, None]
        out: Floats = self.centre[:, None] + (amplitude[:, None] * now).sum(axis=3)
        return out

    def memory(self, index: int) -> Any:
        """See ``Task``."""
        return *super().memory(index), self._waves[index].copy()

    def recall(self, index: int, memory: Any) -> None:
        """See ``Task``."""
        super().recall(index, memory)
        self._waves[index] = memory[5]
