# SPDX-License-Identifier: BSD-3-Clause
"""Go to a target position and hold it: hover in wind."""

from __future__ import annotations

import math
from collections.abc import Mapping
from typing import Any, NamedTuple

import numpy as np
import numpy.typing as npt

from sitl.core.array_kernels import Kernel, Line, Table
from sitl.core.kernels import law

from ..judge import TRUTH
from ..options import EnvOptionError
from ..rewards import Floats, Step
from ..robots.robot import Robot
from .target_task import Outcome, TargetTask, distance_of, nearness


class Holding(NamedTuple):
    """How ``Hold`` judges."""

    radius: float
    hold: float
    """Time within the radius that is success [s]."""
    scale: float
    half: float
    """See ``Hold``; 0: none [m]."""
    effort: float
    """What a mean squared action of 1 costs a step."""
    is_sparse: bool
    seconds: float
    """Of a step [s]."""


@law
def sparse_worth(distance: float, radius: float, far: float) -> float:
    """What a step at a distance from the target pays if rewards are sparse; see ``Hold`` for radius and ``far`` [m]."""
    if distance < radius:
        return 0.0
    return -(0.5 + 0.5 * min(distance / far, 1.0)) if far > 0.0 else -1.0


@law
def sparse_worths(distances: Line, radius: float, far: float, out: Line) -> None:
    """Write ``sparse_worth`` of many distances."""
    for i in range(out.shape[0]):
        out[i] = sparse_worth(distances[i], radius, far)


@law
def goal_worths(
    achieved: Table, desired: Table, errors: Table, axes: Line, radius: float, far: float, out: Line
) -> None:
    """Write ``sparse_worth`` of many goals, as ``Hold.compute_reward`` has it, to the last bit.

    Args:
        achieved, desired: x, y, z [m] and more, shape (count, 3 or more).
        errors: of what is achieved, likewise.
        axes: what x, y, z count in distances, shape (3,).
        radius, far: see ``sparse_worth``.
        out: shape (count,).
    """
    for i in range(out.shape[0]):
        x = (achieved[i, 0] - desired[i, 0] - errors[i, 0]) * axes[0]
        y = (achieved[i, 1] - desired[i, 1] - errors[i, 1]) * axes[1]
        z = (achieved[i, 2] - desired[i, 2] - errors[i, 2]) * axes[2]
        out[i] = sparse_worth(math.sqrt(x * x + y * y + z * z), radius, far)


@law
def judge_hold(
    rule: Holding, state: Table, positions: Table, axes: Line, actions: Table, since: Line, outcome: Outcome
) -> None:
    """Judge a step of robots that hold their positions.

    Args:
        rule: see ``Holding``.
        state: x, y, z [m] and more, shape (count, n).
        positions: [m], shape (count, 3).
        axes: what x, y, z count in distances, shape (3,).
        actions: the agent's, shape (count, m).
        since: how long each has been at its position [s]: of the step before, becomes that of now, shape (count,).
        outcome: see ``Outcome``; terms of the rewards: the goal's alone if they are sparse, already there; else
            nearness and, if there is space, effort.
    """
    crashed, success, rewards, paid = outcome.crashed, outcome.success, outcome.rewards, outcome.paid
    for i in range(rewards.shape[0]):
        distance = distance_of(state, i, positions, i, axes)
        if rule.is_sparse:
            worth = paid[0, i]
        else:
            worth = rule.seconds * nearness(distance, rule.scale, rule.half)
        rewards[i] += worth
        paid[0, i] = 0.0 if crashed[i] else worth
        if not rule.is_sparse and rule.effort != 0.0:
            effort = rule.effort * mean_square(actions, i)
            rewards[i] -= effort
            paid[1, i] = 0.0 if crashed[i] else -effort
        since[i] = since[i] + rule.seconds if distance < rule.radius else 0.0
        success[i] = since[i] >= rule.hold


@law
def mean_square(rows: Table, i: int) -> float:
    """Mean of the squares in a row, in the order in which NumPy adds up to 8 numbers."""
    n = rows.shape[1]
    total = 0.0
    if n == 8:
        for k in range(2):
            a, b, c, d = rows[i, 4 * k], rows[i, 4 * k + 1], rows[i, 4 * k + 2], rows[i, 4 * k + 3]
            total += (a * a + b * b) + (c * c + d * d)
    else:
        for k in range(n):
            total += rows[i, k] * rows[i, k]
    return total / n


_judge, _worths, _goals = Kernel(judge_hold), Kernel(sparse_worths), Kernel(goal_worths)
_NONE = np.zeros((1, 1))
"""In place of actions without numbers."""


class Hold(TargetTask):
    """Go to a target position near the start and hold it.

    Reward of a step: ``step_time * max(1 - distance / scale, 0)``, or with ``half`` ``step_time / (1 + (distance /
    half)^2)``, minus ``effort * step_time`` times the mean squared action. ``info["is_success"]``: the robot has been
    within ``radius`` for the last ``hold`` seconds. Success does not end the episode.

    Args:
        offset: greatest distance of the random target from the start, horizontally along each axis and vertically [m].
        radius: distance that counts as reached [m].
        hold: time to stay there for success [s].
        scale: distance from which on the reward is 0 [m].
        half: distance at which the reward is half of that at the target [m]; None: it decreases linearly (``scale``).
        effort: weight of the squared actions.
        is_sparse: the reward is that of ``compute_reward`` instead: 0 within ``radius``, else -1.
        far: with ``is_sparse``, a step outside of ``radius`` pays -0.5 - 0.5 * min(distance / far, 1) instead of -1:
            less the farther it is [m].
        others: further arguments of ``TargetTask``.
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
        half: float | None = None,
        far: float = 0.0,
        **others: Any,
    ) -> None:
        super().__init__(**others)
        for name, value in {
            "radius": radius,
            "hold": hold,
            "scale": scale,
            "half": 1.0 if half is None else half,
        }.items():
            if not value > 0.0:
                raise EnvOptionError(f"Hold({name}={value}); it must be above 0")
        if np.shape(offset) != (2,) or not (np.isfinite(offset).all() and min(offset) >= 0.0):
            raise EnvOptionError(f"Hold(offset={offset!r}); it must be two numbers, 0 m or more: (aside, up)")
        self.offset, self.radius, self.hold, self.scale, self.effort = offset, radius, hold, scale, effort
        self.is_sparse, self.half, self.far = is_sparse, half, far
        if not far >= 0.0:
            raise EnvOptionError(f"Hold(far={far}); it must be 0 m or more")

    def prepare(self, robot: Robot) -> None:
        """See ``Task``."""
        super().prepare(robot)
        self.since = np.zeros(robot.count)
        """How long each robot has been at its position [s], shape (count,)."""
        self._none = np.zeros((robot.count, 4))
        """Errors of an estimate that counts as it is [m], shape (count, 4)."""

    def start(self, index: int, robot: Robot, rng: np.random.Generator) -> None:
        """See ``Task``."""
        wide, high = self.offset
        position = self.judged_pose()[index, :3] + rng.uniform(-1.0, 1.0, 3) * (wide, wide, high if self.flies else 0.0)
        arena = self.arena_at(index)
        self.positions[index, 0] = np.clip(position, arena.low, arena.high)
        self.at[index], self.since[index], self.success[index] = 0, 0.0, False

    def _judge(self, step: Step, rewards: Floats, terminated: npt.NDArray[np.bool_]) -> None:
        actions = step.actions if step.actions.ndim == 2 else _NONE
        if actions is _NONE:
            self.paid.pop("effort", None)
        rule = Holding(
            float(self.radius), float(self.hold - 1e-9), float(self.scale), float(self.half or 0.0),
            float(self.effort * step.seconds) if actions is not _NONE else 0.0, self.is_sparse, step.seconds,
        )  # fmt: skip
        if self.is_sparse:
            self._pay_goals()
        _judge.unchecked()(
            rule, self._table, self._spots, self.axes, actions, self.since, self._outcome(rewards, terminated)
        )  # fmt: skip

    def _pay_goals(self) -> None:
        """Write what goals pay now. Those of rewards that tell distances are as an agent observes them, in float32: so
        a library gets the same reward from them, to the last bit."""
        goals = self.achieved(), self.targets
        if self.far:
            goals = goals[0].astype(np.float32).astype(np.float64), goals[1].astype(np.float32).astype(np.float64)
        errors = self._none if self.judge_of is None or self.judge_of.by != TRUTH else self.judge_of.error()
        achieved, desired = map(np.ascontiguousarray, goals)
        _goals.unchecked()(achieved, desired, errors, self.axes, float(self.radius), float(self.far), self._paid[0])

    def paid_names(self) -> tuple[str, ...]:
        """See ``TargetTask``."""
        return ("goal",) if self.is_sparse else ("nearness", "effort") if self.effort else ("nearness",)

    def compute_reward(self, achieved: Any, desired: Any, info: Any) -> Floats:
        """0 within ``radius``, -1 elsewhere (see ``far``): what a goal-conditioned step pays, of goals [m] of shape
        (..., 3).

        Args:
            achieved: where the robot believes to be.
            desired: where it is to be.
            info: of the step, or one for each row; its "estimate_error" is taken off what is achieved where the task
                judges the truth, so that the result is the reward of the step, exactly. Without it the estimate counts.
        """
        offset = np.asarray(achieved, np.float64) - np.asarray(desired, np.float64)
        if self.judge_of is not None and self.judge_of.by == TRUTH:
            offset -= _errors(info)
        offset *= self.axes
        return self._worth(np.sqrt((offset * offset).sum(axis=-1)))

    def _worth(self, distance: Floats) -> Floats:
        given = np.ascontiguousarray(distance, np.float64).ravel()
        out = np.empty(given.shape)
        _worths.unchecked()(given, float(self.radius), float(self.far), out)
        return out.reshape(np.shape(distance))

    def memory(self, index: int) -> Any:
        """See ``Task``."""
        return *super().memory(index), float(self.since[index])

    def recall(self, index: int, memory: Any) -> None:
        """See ``Task``."""
        super().recall(index, memory)
        self.since[index] = memory[3]


def _errors(info: Any) -> Any:
    """Errors of the estimate [m] that infos tell; 0 where they tell none."""
    if isinstance(info, Mapping):
        return np.asarray(info["estimate_error"])[..., :3] if "estimate_error" in info else 0.0
    if info is None or not len(info) or not all("estimate_error" in one for one in info):
        return 0.0
    return np.array([one["estimate_error"][:3] for one in info])
