# SPDX-License-Identifier: BSD-3-Clause
"""The robots of a vector environment one by one, with what an environment of such a robot alone has."""

from __future__ import annotations

from collections.abc import Callable
from functools import partial
from typing import Any

import gymnasium as gym
import numpy as np
import numpy.typing as npt
from gymnasium.envs.registration import EnvSpec
from gymnasium.vector import VectorEnv

from sitl.worlds import World

from .robots.robot import Robot, world_of
from .session import Snapshot
from .tasks import Task, reward_of_goals
from .worlds import WorldOption

_ROWS = ("pose", "velocity", "scan", "collided", "time", "worlds", "floors")
_BY_INDEX = ("link", "simulation", "view", "snapshot", "photograph")
_OF_ALL = ("apply", "advance", "advance_late", "look", "reset", "restore", "set_property", "close", "enter")


class OfSubEnvironments(VectorEnv[Any, Any, Any]):
    """What a vector environment offers of each robot: random numbers, methods and attributes.

    ``NavigateVector`` is one, and has what only all robots together can do.
    """

    generators: list[np.random.Generator | None]
    """Of each robot's episodes; None before its first reset."""
    seeds: list[int | None]
    """Their seeds; -1: not known."""
    _envs: list[SubEnvironment] | None = None

    @property
    def robot(self) -> Robot:
        """The robots, with a row for each."""
        raise NotImplementedError

    @property
    def task(self) -> Task:
        """The task of all robots."""
        raise NotImplementedError

    @property
    def step_time(self) -> float:
        """Simulated time of a step [s]."""
        raise NotImplementedError

    def set_worlds(self, world: WorldOption) -> None:
        """Draw the worlds of later episodes from others."""
        raise NotImplementedError

    def observe(self) -> Any:
        """The observations of all robots now."""
        raise NotImplementedError

    def snapshot_of(self, index: int) -> Snapshot:
        """All that ``restore_one`` needs to put one robot back."""
        raise NotImplementedError

    def restore_one(self, index: int, snapshot: Snapshot) -> None:
        """Put one robot back to a snapshot."""
        raise NotImplementedError

    def picture(self, index: int) -> npt.NDArray[np.uint8] | None:
        """An image of one robot, shape (height, width, 3), uint8; None without a render mode."""
        raise NotImplementedError

    def generator(self, index: int) -> np.random.Generator:
        """Random generator of one robot's episodes.

        Raises:
            ResetNeeded: before the first reset.
        """
        generator = self.generators[index]
        if generator is None:
            raise gym.error.ResetNeeded("before the first reset(): call reset() first")
        return generator

    @property
    def envs(self) -> list[SubEnvironment]:
        """Each robot as an environment of its own, for ``call``, ``get_attr`` and ``set_attr``."""
        if self._envs is None:
            self._envs = [SubEnvironment(self, index) for index in range(self.num_envs)]
        return self._envs

    def call(self, name: str, *args: Any, **kwargs: Any) -> tuple[Any, ...]:
        """See ``gymnasium.vector.SyncVectorEnv.call``; ``name`` is a method or an attribute of ``SubEnvironment``."""
        found = (env.get_wrapper_attr(name) for env in self.envs)
        return tuple(value(*args, **kwargs) if callable(value) else value for value in found)

    def get_attr(self, name: str) -> tuple[Any, ...]:
        """See ``gymnasium.vector.SyncVectorEnv.get_attr``."""
        return self.call(name)

    def set_attr(self, name: str, values: Any) -> None:
        """See ``gymnasium.vector.SyncVectorEnv.set_attr``: a list or tuple has a value for each robot.

        Raises:
            ValueError: not as many values as robots.
        """
        if not isinstance(values, list | tuple):
            values = [values] * self.num_envs
        if len(values) != self.num_envs:
            raise ValueError(f"{name}: {len(values)} values for num_envs = {self.num_envs}")
        for env, value in zip(self.envs, values, strict=True):
            env.set_wrapper_attr(name, value)

    @property  # type: ignore[misc]
    def np_random(self) -> tuple[np.random.Generator, ...]:  # type: ignore[override]
        """The robots' random generators."""
        return self.get_attr("np_random")

    @property
    def np_random_seed(self) -> tuple[int, ...]:  # type: ignore[override]
        """Their seeds."""
        return self.get_attr("np_random_seed")


class RobotRow:
    """One of many robots, to be looked at as a ``Robot`` of one: arrays have one row, and its index is 0.

    Args:
        robots: all of them.
        index: which.
    """

    count = 1

    def __init__(self, robots: Robot, index: int) -> None:
        self._robots, self._index = robots, index

    def __getattr__(self, name: str) -> Any:
        if name.startswith("_") or name in _OF_ALL:
            raise AttributeError(f"{name}: a robot of a vector environment moves with all others")
        if name == "world":
            return world_of(self._robots, self._index)
        value = getattr(self._robots, name)
        if name in _ROWS:
            return value[self._index : self._index + 1]
        return partial(_by_index, value, self._index) if name in _BY_INDEX else value


def _by_index(method: Callable[..., Any], index: int, zero: int = 0, *more: Any) -> Any:
    if zero != 0:
        raise IndexError(f"there is no robot {zero!r}: it is one, and its index is 0")
    return method(index, *more)


class SubEnvironment(gym.Env[Any, Any]):
    """One robot of a ``NavigateVector``: what its ``call``, ``get_attr`` and ``set_attr`` find, as in a ``Navigate``.

    The task is that of all robots: its arrays have a row for each.

    Args:
        vector: the vector environment.
        index: which robot.
    """

    def __init__(self, vector: OfSubEnvironments, index: int) -> None:
        self._vector, self._index = vector, index
        self.metadata = {"render_modes": vector.metadata["render_modes"], "render_fps": vector.metadata["render_fps"]}
        self.render_mode = vector.render_mode
        self.observation_space, self.action_space = vector.single_observation_space, vector.single_action_space
        self.robot: Any = RobotRow(vector.robot, index)
        """The robot: ``pose``, ``velocity``, ``scan``, ... with one row."""

    @property
    def spec(self) -> EnvSpec | None:  # type: ignore[override]
        """The vector environment's."""
        return self._vector.spec

    @property
    def world(self) -> World:
        """The world of this robot's present episode."""
        return world_of(self._vector.robot, self._index)

    def set_worlds(self, world: WorldOption) -> None:
        """Draw the worlds of later episodes from others, for all robots: see ``Navigate.set_worlds``."""
        self._vector.set_worlds(world)

    @property
    def task(self) -> Task:
        """The task of all robots."""
        return self._vector.task

    @property
    def step_time(self) -> float:
        """Simulated time of a step [s]."""
        return self._vector.step_time

    @property
    def np_random(self) -> np.random.Generator:
        """The random generator of this robot's episodes."""
        if self._vector.generators[self._index] is None:
            self._vector.generators[self._index], self._vector.seeds[self._index] = gym.utils.seeding.np_random()
        return self._vector.generator(self._index)

    @np_random.setter
    def np_random(self, value: np.random.Generator) -> None:
        self._vector.generators[self._index], self._vector.seeds[self._index] = value, -1

    @property
    def np_random_seed(self) -> int:
        """Its seed; -1 if it is not known."""
        self.np_random  # noqa: B018 (made where there is none)
        seed = self._vector.seeds[self._index]
        return -1 if seed is None else seed

    def reset(self, *, seed: int | None = None, options: dict[str, Any] | None = None) -> tuple[Any, dict[str, Any]]:
        """Reset this robot; the others go on. See ``Navigate.reset``."""
        vector, mine = self._vector, np.arange(self._vector.num_envs) == self._index
        seeds = [seed if me else None for me in mine.tolist()]
        given = {**(options or {}), "reset_mask": mine}  # of lists of seeds Gymnasium's annotation says nothing
        observations, infos = vector.reset(seed=seeds, options=given)  # type: ignore[arg-type]
        return row_of(observations, self._index), {
            name: value[self._index] for name, value in infos.items() if not name.startswith("_")
        }

    def step(self, action: Any) -> Any:
        """Refused: robots of a vector environment move together."""
        raise gym.error.Error("a robot of a vector environment moves with all others: use the vector's step()")

    def compute_reward(self, achieved_goal: Any, desired_goal: Any, info: Any) -> Any:
        """See ``Navigate.compute_reward``."""
        return reward_of_goals(self.task, achieved_goal, desired_goal, info)

    def snapshot(self) -> Snapshot:
        """See ``NavigateVector.snapshot_of``."""
        return self._vector.snapshot_of(self._index)

    def restore(self, snapshot: Snapshot) -> Any:
        """See ``NavigateVector.restore_one``; returns the observation."""
        self._vector.restore_one(self._index, snapshot)
        return row_of(self._vector.observe(), self._index)

    def render(self) -> npt.NDArray[np.uint8] | None:  # type: ignore[override]
        """An image of this robot, shape (height, width, 3), uint8; None without a render mode."""
        return self._vector.picture(self._index)


def row_of(observations: Any, index: int) -> Any:
    """The observation of one robot; ``observations`` have a row for each."""
    if isinstance(observations, dict):
        return {name: value[index] for name, value in observations.items()}
    return observations[index]
