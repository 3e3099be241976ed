# SPDX-License-Identifier: BSD-3-Clause
"""The environment of a run."""

from __future__ import annotations

import inspect
import math
from collections.abc import Callable, Iterable, Mapping
from typing import Any, TypeVar

import gymnasium as gym
import numpy as np

from sitl import envs

from . import algorithms
from .errors import AgentError
from .runs import cores
from .runs.config import RunConfig
from .runs.curriculum import Curriculum

_Env = TypeVar("_Env")
_OF_GYMNASIUM = {name for make in (gym.make, gym.make_vec) for name in inspect.signature(make).parameters} - {"kwargs"}
"""What Gymnasium takes for itself: how many environments, in which processes, within which wrappers."""


def make(config: RunConfig, **options: Any) -> gym.Env[Any, Any]:
    """Make the environment of a run.

    Args:
        config: configuration of the run.
        options: options that replace the run's.

    Raises:
        AgentError: no such environment, or an option that it does not take.
    """
    return _made(lambda given: gym.make(config.env, max_episode_steps=config.max_steps, **given), config, options)


def try_all(configs: Iterable[RunConfig]) -> None:
    """Check that the environments of runs, for training and for evaluation, can be made and learnt in, before any
    folder
    is made.

    Raises:
        AgentError: see ``make``, or the algorithm does not learn from such observations or actions.
    """
    tried: list[tuple[str, Mapping[str, Any], tuple[gym.Space[Any], gym.Space[Any]]]] = []
    for config in configs:
        check = algorithms.load(config.algorithm).check
        for options in (config.env_options, {**config.env_options, **config.evaluation.options}):
            spaces = next((found for *asked, found in tried if asked == [config.env, options]), None)
            if spaces is None:
                env = make(config, **options)
                spaces = (env.observation_space, env.action_space)
                env.close()
                tried.append((config.env, options, spaces))
            check(config, *spaces)
        for stage in config.curriculum:
            env = make(config, world=stage.world)
            Curriculum(config.curriculum, env)
            env.close()


def make_many(config: RunConfig, count: int, **options: Any) -> gym.vector.VectorEnv[Any, Any, Any]:
    """As ``make``, with ``count`` robots in one vector environment, on all cores that the run may use."""

    def call(given: dict[str, Any]) -> gym.vector.VectorEnv[Any, Any, Any]:
        return gym.make_vec(config.env, num_envs=count, max_episode_steps=config.max_steps, **given)

    env = _made(call, config, options)
    use_threads = getattr(getattr(env.unwrapped, "robot", None), "use_threads", None)
    if use_threads is not None and "threads" not in {**config.env_options, **options}:
        use_threads(min(cores.mine(), count))
    return env


def _made(call: Callable[[dict[str, Any]], _Env], config: RunConfig, options: Mapping[str, Any]) -> _Env:
    given = {**config.env_options, **options}
    if "max_episode_steps" in given:
        raise AgentError("max_episode_steps is no option of an environment; --max-steps limits an episode")
    if own := [name for name in given if name in _OF_GYMNASIUM]:
        raise AgentError(f"{config.env}: {own[0]} = {given[own[0]]!r} is no option of an environment")
    given = {name: tuple(value) if isinstance(value, list) else value for name, value in given.items()}
    try:
        return call(given)
    except (gym.error.Error, envs.EnvOptionError) as error:
        raise AgentError(f"{config.env}: {error}") from None
    except TypeError as error:
        if "unexpected keyword" in str(error) or "multiple values" in str(error):
            raise AgentError(f"{config.env}: {error}") from None
        raise


def seed_of(seed: int, episode: int) -> int:
    """Seed of an episode's reset. It follows from the run's seed, so that a run can be resumed at any episode."""
    return int(np.random.SeedSequence([seed, episode]).generate_state(1)[0])


def judged_by(env: gym.Env[Any, Any] | gym.vector.VectorEnv[Any, Any, Any]) -> str:
    """By what an environment judges success: "truth", "estimate", or "" for one that does not say."""
    return str(getattr(getattr(env.unwrapped, "session", None), "judged_by", ""))


def step_time(env: gym.Env[Any, Any] | gym.vector.VectorEnv[Any, Any, Any]) -> float:
    """Simulated time of a step [s]; nan for environments that do not say."""
    return float(getattr(env.unwrapped, "step_time", math.nan))
