# SPDX-License-Identifier: BSD-3-Clause
"""A vector environment of this package as stable-baselines3 has them."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import gymnasium as gym
import numpy as np

from .library import stable_baselines3

stable_baselines3()

from stable_baselines3.common.vec_env import VecEnv  # noqa: E402 (after the message about the missing extra)

from .actions import Actions  # noqa: E402
from .features import Features, Frames, goals_of  # noqa: E402
from .tally import Tally  # noqa: E402


class Robots(VecEnv):
    """Many robots that learn together: features in frames, scaled rewards, actions of -1 to 1.

    stable-baselines3 wants a robot whose episode has ended to be reset within the step that ended it; our vector
    environments reset it in the next one. So it is reset here, with the same draws as there.

    Args:
        env: ``gymnasium.make_vec`` of one of this package's environments.
        features: conversion of its observations.
        frames: number of observations that the network sees together.
        actions: conversion of its actions.
        reward_scale: factor of rewards.
        tally: receives every step.
        seeds: seeds of the first episodes, one a robot.
        by_goal: observations are dicts of features, as replay with other goals needs them.
    """

    def __init__(
        self,
        env: gym.vector.VectorEnv[Any, Any, Any],
        features: Features,
        frames: int,
        actions: Actions,
        reward_scale: float,
        tally: Tally,
        seeds: Sequence[int],
        by_goal: bool = False,
    ) -> None:
        self._env, self._features, self._conversion, self._tally = env, features, actions, tally
        self._frames = Frames(env.num_envs, frames, features.width)
        self._scale, self._first = reward_scale, list(seeds)
        self._actions: Any = None
        self._by_goal = by_goal
        space: gym.Space[Any] = gym.spaces.Box(-np.inf, np.inf, (frames * features.width,), np.float32)
        if by_goal:
            parts = features.by_name(np.zeros((1, features.width), np.float32)).items()
            space = gym.spaces.Dict(
                {name: gym.spaces.Box(-np.inf, np.inf, row.shape[1:], np.float32) for name, row in parts}
            )
        super().__init__(env.num_envs, space, actions.space)

    def reset(self) -> Any:
        """See ``VecEnv``."""
        observations, _ = self._env.reset(seed=self._first)  # type: ignore[arg-type]
        return self._seen(self._frames.begin(self._features(observations)).copy())

    def _seen(self, rows: Any) -> Any:
        return self._features.by_name(rows) if self._by_goal else rows

    def step_async(self, actions: Any) -> None:
        """See ``VecEnv``."""
        self._actions = actions

    def step_wait(self) -> Any:
        """See ``VecEnv``."""
        actions = self._conversion.to_environment(np.asarray(self._actions))
        observations, rewards, terminated, truncated, _ = self._env.step(actions)
        rows = self._frames.push(self._features(observations))
        ended = terminated | truncated
        infos: list[dict[str, Any]] = [{} for _ in range(self.num_envs)]
        finished = self._tally.count(rewards, terminated, ended)
        if finished:
            robots = np.flatnonzero(ended)
            for index, (reward, steps) in zip(robots.tolist(), finished, strict=True):
                last = rows[index : index + 1].copy()
                infos[index] = {
                    "terminal_observation": {name: row[0] for name, row in self._seen(last).items()}
                    if self._by_goal
                    else last[0],
                    "TimeLimit.truncated": bool(truncated[index] and not terminated[index]),
                    "episode": {"r": reward, "l": steps, "t": 0.0},
                }
            observations, _ = self._env.reset(options={"reset_mask": ended})
            rows = self._frames.begin(self._features(observations), robots)
        return self._seen(rows.copy()), (rewards * self._scale).astype(np.float32), ended, infos

    def memory(self) -> dict[str, Any]:
        """Everything that ``recall`` needs to go on bit for bit; can be pickled."""
        snapshots = self._env.unwrapped.snapshot()  # type: ignore[attr-defined]
        return {"robots": snapshots, "frames": self._frames.rows, "tally": self._tally.memory()}

    def recall(self, memory: dict[str, Any]) -> None:
        """Restore the state that ``memory`` returned."""
        self._env.unwrapped.restore(memory["robots"])  # type: ignore[attr-defined]
        self._frames.rows[...] = memory["frames"]
        self._tally.recall(memory["tally"])

    def close(self) -> None:
        """See ``VecEnv``."""
        self._env.close()

    def get_attr(self, attr_name: str, indices: Any = None) -> list[Any]:
        """See ``VecEnv``: the vector environment's, the same for each robot."""
        return [getattr(self._env, attr_name)] * len(list(self._get_indices(indices)))

    def set_attr(self, attr_name: str, value: Any, indices: Any = None) -> None:
        """See ``VecEnv``: refused."""
        raise NotImplementedError("all robots are one environment: nothing can be set for some")

    def env_method(self, method_name: str, *method_args: Any, indices: Any = None, **kwargs: Any) -> list[Any]:
        """See ``VecEnv``: what goals are worth ("compute_reward", of their features); all else is refused."""
        if method_name != "compute_reward":
            raise NotImplementedError("all robots are one environment: no method can be called for some")
        achieved, desired = (goals_of(goals) for goals in method_args[:2])
        task = self._env.unwrapped.session.task  # type: ignore[attr-defined]
        return [self._scale * task.compute_reward(achieved, desired, None)]

    def env_is_wrapped(self, wrapper_class: Any, indices: Any = None) -> list[bool]:
        """See ``VecEnv``."""
        return [False] * len(list(self._get_indices(indices)))
