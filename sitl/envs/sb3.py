# SPDX-License-Identifier: BSD-3-Clause
"""Many robots as stable-baselines3 has vector environments. Needs the extra ``rl``."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from typing import Any

import gymnasium as gym
import numpy as np
from gymnasium.vector import AutoresetMode, VectorEnv

from sitl.errors import MissingExtra

from .options import EnvOptionError
from .sub_environment import SubEnvironment

try:
    from stable_baselines3.common.vec_env import VecEnv
except ImportError as error:
    raise MissingExtra(f"sitl.envs.sb3 needs stable-baselines3 ({error}): pip install 'gym-sitl[rl]'") from None


class Sb3VecEnv(VecEnv):
    """A ``VecEnv`` of many robots that one call advances.

    It gives what stable-baselines3's ``DummyVecEnv`` gives of as many single environments.

    Args:
        env: id of one of this package's environments; or its ``gymnasium.make_vec(..., autoreset_mode="SameStep")``,
            also within Gymnasium's vector wrappers.
        num_envs: number of robots, for an id.
        options: of ``gymnasium.make_vec``, for an id.

    Raises:
        EnvOptionError: an option that cannot be used, or a vector environment with another autoreset mode.
    """

    def __init__(self, env: str | VectorEnv[Any, Any, Any], num_envs: int = 1, **options: Any) -> None:
        made: Any = env
        if isinstance(env, str):
            made = gym.make_vec(env, num_envs=num_envs, autoreset_mode=AutoresetMode.SAME_STEP, **options)
        mode = made.metadata.get("autoreset_mode")
        if mode is not AutoresetMode.SAME_STEP:
            raise EnvOptionError(f'autoreset_mode = {mode}; stable-baselines3 takes environments with "SameStep" only')
        self.env = made
        self._actions: Any = None
        super().__init__(made.num_envs, made.single_observation_space, made.single_action_space)

    def reset(self) -> Any:
        """See ``VecEnv``; the seeds and options of ``seed`` and ``set_options`` count for this reset."""
        observations, infos = self.env.reset(seed=self._seeds, options=self._reset_options_of_all())
        self._reset_seeds()
        self._reset_options()
        self.reset_infos = _rows(infos, self.num_envs)
        return observations

    def _reset_options_of_all(self) -> dict[str, Any] | None:
        """The options of all robots; those that differ must be start poses."""
        first = self._options[0]
        if all(options is first or options == first for options in self._options):
            return first or None
        return {"pose": [options.get("pose") for options in self._options]}

    def step_async(self, actions: Any) -> None:
        """See ``VecEnv``."""
        self._actions = actions

    def step_wait(self) -> Any:
        """See ``VecEnv``."""
        observations, rewards, terminated, truncated, infos = self.env.step(self._actions)
        last, last_info = infos.pop("final_obs", None), infos.pop("final_info", None)
        infos.pop("_final_obs", None), infos.pop("_final_info", None)
        ended, rows = terminated | truncated, _rows(infos, self.num_envs)
        for row, limit in zip(rows, (truncated & ~terminated).tolist(), strict=True):
            row["TimeLimit.truncated"] = limit
        if last is not None:
            last_rows = _rows(last_info, self.num_envs)
            for index in np.flatnonzero(ended).tolist():
                rows[index] |= {**last_rows[index], "terminal_observation": last[index]}
                self.reset_infos[index] = {}
        return observations, rewards.astype(np.float32), ended, rows

    def close(self) -> None:
        """See ``VecEnv``."""
        self.env.close()

    def _envs(self, indices: int | Iterable[int] | None) -> list[SubEnvironment]:
        envs = self.env.unwrapped.envs
        return [envs[index] for index in self._get_indices(indices)]

    def get_attr(self, attr_name: str, indices: int | Iterable[int] | None = None) -> list[Any]:
        """See ``VecEnv``: attributes of ``sitl.envs.sub_environment.SubEnvironment``."""
        return [env.get_wrapper_attr(attr_name) for env in self._envs(indices)]

    def set_attr(self, attr_name: str, value: Any, indices: int | Iterable[int] | None = None) -> None:
        """See ``VecEnv``."""
        for env in self._envs(indices):
            setattr(env, attr_name, value)

    def env_method(
        self, method_name: str, *args: Any, indices: int | Iterable[int] | None = None, **kwargs: Any
    ) -> list[Any]:
        """See ``VecEnv``: methods of ``sitl.envs.sub_environment.SubEnvironment``."""
        return [env.get_wrapper_attr(method_name)(*args, **kwargs) for env in self._envs(indices)]

    def env_is_wrapped(self, wrapper_class: type[Any], indices: int | Iterable[int] | None = None) -> list[bool]:
        """See ``VecEnv``: whether the vector environment is."""
        env, found = self.env, False
        while env is not env.unwrapped:
            found, env = found or isinstance(env, wrapper_class), env.env
        return [found] * len(list(self._get_indices(indices)))

    def get_images(self) -> Sequence[Any]:
        """See ``VecEnv``."""
        return self.env_method("render")


_ALL = np.ones(1, np.bool_)
"""Of entries without a mask."""


def _rows(infos: dict[str, Any], count: int) -> list[dict[str, Any]]:
    """Infos in Gymnasium's vector form as one dict for each robot."""
    names = [name for name in infos if not (name.startswith("_") and name[1:] in infos)]
    if all(isinstance(infos[name], np.ndarray) and infos.get("_" + name, _ALL).all() for name in names):
        columns = [_each(infos[name]) for name in names]
        return [dict(zip(names, row)) for row in zip(*columns)] if columns else [{} for _ in range(count)]
    rows: list[dict[str, Any]] = [{} for _ in range(count)]
    for name in names:
        values = infos[name]
        each = _rows(values, count) if isinstance(values, dict) else _each(values)
        mask = infos.get("_" + name)
        for index, has in enumerate([True] * count if mask is None else mask.tolist()):
            if has:
                rows[index][name] = each[index]
    return rows


def _each(values: Any) -> Sequence[Any]:
    """An array's value for each robot: Python's numbers, or rows."""
    found: Sequence[Any] = values.tolist() if values.ndim == 1 else list(values)
    return found
