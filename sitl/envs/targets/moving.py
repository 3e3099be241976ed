# SPDX-License-Identifier: BSD-3-Clause
"""Follow a moving target: along a trajectory, or at random."""

from __future__ import annotations

import math
from abc import abstractmethod
from collections.abc import Callable, Sequence
from functools import partial
from typing import Any, NamedTuple

import numpy as np
import numpy.typing as npt

from sitl.core.array_kernels import Kernel, Line, Table
from sitl.core.elementary import cos, sin, sincos
from sitl.core.kernels import law

from ..gathering import stands_for
from ..noise import dirichlet
from ..options import EnvOptionError, unknown
from ..rewards import Floats, Step
from ..robots.robot import Robot
from .target_task import Outcome, TargetTask, nearness, write_offsets_to

AHEAD_S = 0.5
"""Time from one of the positions that "path" tells to the next [s]."""


class Following(NamedTuple):
    """How ``MovingTask`` judges."""

    radius: float
    settle: float
    """Time at the start that does not count [s]."""
    scale: float
    half: float
    """See ``MovingTask``; 0: none [m]."""
    lost: float
    lost_reward: float
    seconds: float
    """Of a step [s]."""


class Noted(NamedTuple):
    """Errors of robots so far."""

    sums: Table
    """See ``MovingTask.sums``."""
    errors: Line
    """Root mean square distances to the targets, written [m], shape (count,)."""


@law
def spread_times(time: Line, apart: float, out: Table) -> None:
    """Write times of robots, shape (count,), and so many seconds later each, shape (count, k)."""
    for i in range(out.shape[0]):
        for k in range(out.shape[1]):
            out[i, k] = time[i] + apart * k


@law
def note_error(sums: Table, i: int, squared: float, counts: bool) -> float:
    """Note the squared distance [m^2] of robot ``i`` if it counts; returns the root mean square [m]."""
    if counts:
        sums[i, 0] += squared
        sums[i, 1] += 1.0
    return math.sqrt(sums[i, 0] / max(sums[i, 1], 1.0))


@law
def judge_follow(
    rule: Following, state: Table, positions: Table, axes: Line, time: Line, noted: Noted, outcome: Outcome
) -> None:
    """Judge a step of robots that follow targets.

    Args:
        rule: see ``Following``.
        state: x, y, z [m] and more, shape (count, n).
        positions: of the targets [m], shape (count, 3).
        axes: what x, y, z count in distances, shape (3,).
        time: of each robot's episode [s], shape (count,).
        noted: see ``Noted``; the step is added.
        outcome: see ``Outcome``; terms of the rewards: nearness and, if there is a price, the loss of the target.
    """
    crashed, success, rewards, paid, errors = (
        outcome.crashed, outcome.success, outcome.rewards, outcome.paid, noted.errors
    )  # fmt: skip
    for i in range(rewards.shape[0]):
        x = axes[0] * (positions[i, 0] - state[i, 0])
        y = axes[1] * (positions[i, 1] - state[i, 1])
        z = axes[2] * (positions[i, 2] - state[i, 2])
        squared = x * x + y * y + z * z
        distance = math.sqrt(squared)
        near = rule.seconds * nearness(distance, rule.scale, rule.half)
        rewards[i] += near
        paid[0, i] = 0.0 if crashed[i] else near
        counts = time[i] >= rule.settle
        errors[i] = note_error(noted.sums, i, squared, counts)
        success[i] = counts and errors[i] < rule.radius
        end_lost(i, distance > rule.lost, rule.lost_reward, outcome, 1)


@law
def end_lost(i: int, lost: bool, reward: float, outcome: Outcome, row: int) -> None:
    """End the episode of robot ``i`` if it has lost its target; what that costs is written to a row of ``paid``."""
    if reward != 0.0:
        cost = reward if lost and not outcome.terminated[i] else 0.0
        outcome.rewards[i] += cost
        outcome.paid[row, i] = 0.0 if outcome.crashed[i] else cost
    if lost:
        outcome.terminated[i] = True


_spread, _follow = Kernel(spread_times), Kernel(judge_follow)


class MovingTask(TargetTask):
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
        others: further arguments of ``TargetTask``.
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
        self.errors = np.zeros(robot.count)
        """Root mean square distance of each robot from its target [m], shape (count,)."""
        self._first = np.zeros(robot.count, np.int64)
        self._ahead: dict[int, tuple[Floats, Floats]] = {}
        """By number of positions: times [s], shape (count, positions), and positions [m], shape (count * positions,
        3)."""
        self.sums = np.zeros((robot.count, 2))
        """Sum of the squared distances [m^2], and their number, shape (count, 2)."""
        self.centre = np.zeros((robot.count, 3))
        """Where each target begins: the robot's start, x, y, z [m], shape (count, 3)."""

    def start(self, index: int, robot: Robot, rng: np.random.Generator) -> None:
        """See ``Task``."""
        self.centre[index] = self.judged_pose()[index, :3]
        self.at[index], self.sums[index], self.success[index] = 0, 0.0, False
        self._draw(index, rng)
        self.positions[index, 0] = self.along(np.zeros((self._robot.count, 1)))[index, 0]

    def _draw(self, index: int, rng: np.random.Generator) -> None:
        """Draw what is random in one robot's episode."""

    @property
    def _writer(self) -> Callable[[Floats, Floats], None]:
        fast = stands_for(self, "_write_along", "along")
        return self._write_along if fast else partial(MovingTask._write_along, self)

    @abstractmethod
    def along(self, time: Floats) -> Floats:
        """Where each robot's target is: x, y, z [m], shape (count, k, 3), at times of its episode [s], shape (count,
        k)."""

    def offsets_from(self, pose: Floats, count: int) -> Floats:
        """See ``TargetTask``: to where the target is now, and after each further 0.5 s."""
        out = np.empty((len(pose), 3 * count))
        self._write_offsets(np.ascontiguousarray(pose, np.float64), count, out, 0)
        return out.reshape(len(out), count, 3)

    def _write_offsets(self, pose: Floats, count: int, out: Floats, first: int) -> None:
        ahead = self._ahead.get(count)
        if ahead is None:
            rows = len(self.at)
            ahead = self._ahead[count] = np.empty((rows, count)), np.empty((rows * count, 3))
        times, positions = ahead
        _spread.unchecked()(np.ascontiguousarray(self._robot.time), AHEAD_S, times)
        self._writer(times, positions)
        write_offsets_to.unchecked()(pose, positions, self._first, count, count, out, first)

    def _along(self, time: Floats) -> Floats:
        """``along`` by ``_write_along``."""
        times = np.ascontiguousarray(time, np.float64)
        out = np.empty((times.size, 3))
        self._write_along(times, out)
        return out.reshape(*times.shape, 3)

    def _write_along(self, times: Floats, out: Floats) -> None:
        """Write ``along`` at times, shape (count, k), into ``out``, shape (count * k, 3)."""
        out[:] = self.along(times).reshape(out.shape)

    def _move(self, time: Floats) -> None:
        """Put each target where it is at a time of its episode [s], shape (count,)."""
        self._writer(time.reshape(-1, 1), self._spots)

    def _judge(self, step: Step, rewards: Floats, terminated: npt.NDArray[np.bool_]) -> None:
        time = np.ascontiguousarray(step.robot.time)
        self._move(time)
        rule = Following(
            float(self.radius), float(self.settle), float(self.scale), float(self.half or 0.0), float(self.lost),
            float(self.lost_reward), step.seconds,
        )  # fmt: skip
        _follow.unchecked()(
            rule, self._table, self._spots, self.axes, time, Noted(self.sums, self.errors),
            self._outcome(rewards, terminated),
        )  # fmt: skip

    def paid_names(self) -> tuple[str, ...]:
        """See ``TargetTask``."""
        return ("nearness", "lost") if self.lost_reward else ("nearness",)

    info_stays = True

    def info(self, step: Step) -> dict[str, npt.NDArray[Any]]:
        """See ``Task``."""
        return {**super().info(step), "error": self.errors}

    def memory(self, index: int) -> Any:
        """See ``Task``."""
        return *super().memory(index), self.sums[index].copy(), self.centre[index].copy()

    def recall(self, index: int, memory: Any) -> None:
        """See ``Task``."""
        super().recall(index, memory)
        self.sums[index], self.centre[index] = memory[3:5]


EIGHT, CIRCLE, HELIX = range(3)


class Curve(NamedTuple):
    """A closed curve of size 1 about its beginning."""

    number: int
    length: float
    """Of one round, horizontally."""


@law
def write_curves(curve: int, size: float, up: float, drawn: Table, centre: Table, times: Table, out: Table) -> None:
    """Write points on curves.

    Args:
        curve: ``EIGHT``, ``CIRCLE`` or ``HELIX``.
        size: of the curve [m].
        up: what heights count: 1, or 0 for robots that do not fly.
        drawn: rate of the phase [rad/s] and direction [rad] of each robot's curve, shape (count, 2).
        centre: where each begins [m], shape (count, 3).
        times: [s], shape (count, k).
        out: [m], shape (count * k, 3).
    """
    for i in range(times.shape[0]):
        s, c = sincos(drawn[i, 1])
        for k in range(times.shape[1]):
            phase, row = drawn[i, 0] * times[i, k], i * times.shape[1] + k
            ahead, cosine = sincos(phase)
            left = ahead * cosine if curve == EIGHT else 1.0 - cosine
            height = 0.5 * (1.0 - cos(phase / 3.0)) if curve == HELIX else 0.0
            out[row, 0] = centre[i, 0] + size * (ahead * c - left * s)
            out[row, 1] = centre[i, 1] + size * (ahead * s + left * c)
            out[row, 2] = centre[i, 2] + size * (up * height)


@law
def write_waves(waves: Table, centre: Table, times: Table, out: Table) -> None:
    """Write points that move as sums of sines.

    Args:
        waves: amplitude [m], rate [rad/s] and phase [rad] of each robot's waves along x, y, z, one after another, shape
            (count, 9 * n).
        centre: where each begins [m], shape (count, 3).
        times: [s], shape (count, k).
        out: [m], shape (count * k, 3).
    """
    n = waves.shape[1] // 9
    for i in range(times.shape[0]):
        for k in range(times.shape[1]):
            for axis in range(3):
                total = 0.0
                for wave in range(n):
                    at = 3 * (axis * n + wave)
                    amplitude, rate, phase = waves[i, at], waves[i, at + 1], waves[i, at + 2]
                    total += amplitude * (sin(rate * times[i, k] + phase) - sin(phase))
                out[i * times.shape[1] + k, axis] = centre[i, axis] + total


_curves, _waves = Kernel(write_curves), Kernel(write_waves)
CURVES = {"eight": Curve(EIGHT, 6.097), "circle": Curve(CIRCLE, math.tau), "helix": Curve(HELIX, math.tau)}
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
        drawn = np.ravel(np.asarray(speed, np.float64))
        if not (size > 0.0 and len(drawn) in (1, 2) and 0.0 < drawn[0] <= drawn[-1] < math.inf):
            raise EnvOptionError(
                f"Trajectory(size={size}, speed={speed!r}); they must be above 0, the speed a number or (low, high)"
            )
        self.curve, self.size, self.speed = curve, size, (float(drawn[0]), float(drawn[-1]))

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
        return self._along(time)

    def _write_along(self, times: Floats, out: Floats) -> None:
        curve, up = CURVES[self.curve].number, float(self.axes[2])
        _curves.unchecked()(curve, float(self.size), up, self._drawn, self.centre, times, out)

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
        return self._along(time)

    def _write_along(self, times: Floats, out: Floats) -> None:
        _waves.unchecked()(self._waves.reshape(len(self._waves), -1), self.centre, times, out)

    def memory(self, index: int) -> Any:
        """See ``Task``."""
        return *super().memory(index), self._waves[index].copy()

    def recall(self, index: int, memory: Any) -> None:
        """See ``Task``."""
        super().recall(index, memory)
        self._waves[index] = memory[5]
