# SPDX-License-Identifier: BSD-3-Clause
"""Observations made of parts: one box, a dict of boxes, and what goal-conditioned learning needs."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from copy import deepcopy
from itertools import pairwise
from typing import Any, cast

import gymnasium as gym
import numpy as np

from .gathering import Gathering, stands_for
from .options import EnvOptionError
from .parts import PARTS, GatheredPart, Part, Surroundings, part_of
from .robots.robot import Robot
from .sensed import Sensed
from .senses import FAR, arrays_stay, reads_scan
from .tensors import rows


class Parts:
    """One box of float32: the numbers of all parts, one after another.

    Args:
        parts: names (``PARTS``), parts, or arguments of ``Sensed`` by name (data, as recipes have it).

    Raises:
        EnvOptionError: no such part.
    """

    def __init__(self, parts: Sequence[str | Part | Mapping[str, Any]]) -> None:
        if not parts:
            raise EnvOptionError(f"observation {list(parts)!r} has no parts; there are {', '.join(PARTS)}")
        self._parts: list[Part] = [_chosen(part) for part in parts]
        self.names = tuple(
            given if isinstance(given, str) else getattr(part, "name", type(part).__name__)
            for given, part in zip(parts, self._parts)
        )
        self.remembers = tuple(part for part in self._parts if isinstance(part, Sensed))
        """Those of them that remember the last steps."""
        self.reads_scan = any(reads_scan(part) for part in self._parts)

        self._written: tuple[tuple[Part, slice], ...] = ()
        """Parts that no gathering writes, and where."""
        self._gather: Callable[[Any], None] | None = None
        """Writes the others."""

    def prepare(self, session: Surroundings) -> None:
        """Called once, when robot, action and task are there."""
        self._session = session
        for part in self._parts:
            part.prepare(session)
        self.columns = tuple(column for part in self._parts for column in part.columns)
        """Name and unit of each number."""
        self._width = len(self.columns)
        ends = np.cumsum([0, *(len(part.columns) for part in self._parts)]).tolist()
        self._spans = [slice(a, b) for a, b in pairwise(ends)]
        self.slices = dict(zip(self.names, self._spans))
        """Where the numbers of each part are."""
        self._low = np.array([bound for part in self._parts for bound in part.low], np.float32)
        self._high = np.array([bound for part in self._parts for bound in part.high], np.float32)

    def space(self, robot: Robot) -> gym.Space[Any]:
        """See ``Observation``."""
        return gym.spaces.Box(self._low, self._high, dtype=np.float32)

    def observe(self, robot: Robot) -> Any:
        """See ``Observation``."""
        out = rows(robot.count, self._width)
        (self._gather or self._planned())(out)
        for part, where in self._written:
            mine = out[:, where]
            part.write(mine)
            np.clip(mine, self._low[where], self._high[where], out=mine)
        return out

    def _planned(self) -> Callable[[Any], None]:
        """What one compiled call gathers, and what is left."""
        plan, left = Gathering(self._session), []
        gathers = arrays_stay(self._session.robot)
        for part, where in zip(self._parts, self._spans):
            if gathers and stands_for(part, "gather", "write"):
                plan.at(where.start)
                cast(GatheredPart, part).gather(plan)
            else:
                left.append((part, where))
        self._written, self._gather = tuple(left), plan.made(self._low, self._high) if gathers else _nothing
        return self._gather

    def __getstate__(self) -> dict[str, Any]:
        return {**vars(self), "_gather": None}  # the copy's arrays are others


class NamedParts(Parts):
    """The same as a dict: an array of float32 for each part, by its name."""

    def space(self, robot: Robot) -> gym.Space[Any]:
        """See ``Observation``."""
        boxes: dict[str, gym.Space[Any]] = {
            name: gym.spaces.Box(self._low[at], self._high[at], dtype=np.float32) for name, at in self.slices.items()
        }
        return gym.spaces.Dict(boxes)

    def observe(self, robot: Robot) -> Any:
        """See ``Observation``."""
        numbers = super().observe(robot)
        return {name: _narrow(numbers[:, where]) for name, where in self.slices.items()}


class GoalConditioned(Parts):
    """The same for goal-conditioned learning: a dict of "observation", "achieved_goal" (x, y, z of the robot [m]) and
    "desired_goal" (of its target), as Gymnasium-Robotics has it; ``compute_reward`` of the environment tells what they
    are worth. The task needs a target, and the parts should not tell it."""

    def prepare(self, session: Surroundings) -> None:
        """See ``Parts``."""
        super().prepare(session)
        if not hasattr(session.task, "compute_reward"):
            raise EnvOptionError(f"observation: task {session.task!r} has no goal that counts alone")
        self._task, self._robot = session.task, session.robot

    def space(self, robot: Robot) -> gym.Space[Any]:
        """See ``Observation``."""
        at = gym.spaces.Box(-FAR, FAR, (3,), np.float32)
        return gym.spaces.Dict({"observation": super().space(robot), "achieved_goal": at, "desired_goal": at})

    def observe(self, robot: Robot) -> Any:
        """See ``Observation``."""
        return {
            "observation": super().observe(robot),
            "achieved_goal": _narrow(self._task.achieved()),
            "desired_goal": _narrow(self._task.targets),
        }


def _narrow(numbers: Any) -> Any:
    """A copy as float32."""
    out = rows(*numbers.shape)
    out[:] = numbers
    return out


def _nothing(out: Any) -> None:
    """Gather nothing."""


def _chosen(part: str | Part | Mapping[str, Any]) -> Part:
    if not isinstance(part, Mapping):
        return deepcopy(part_of(part))
    try:
        return Sensed(**part)
    except TypeError as error:
        raise EnvOptionError(f"observation: {dict(part)!r}: {error}") from None
