# SPDX-License-Identifier: BSD-3-Clause
"""Policies as users name them: drawn at random, a function of observations, a run's folder, a file."""

from __future__ import annotations

import importlib
from collections.abc import Callable, Sequence
from copy import deepcopy
from pathlib import Path
from typing import Any

import gymnasium as gym
import numpy as np
import numpy.typing as npt

from . import learnt
from .errors import AgentError
from .policies import OneEach, Policies

RANDOM = "random"
"""Name of the policy that draws its actions."""
Named = str | Path | Callable[[Any], Any]
"""A policy: "random", "MODULE:FUNCTION", a function of observations that gives actions, the folder of a run, or the
file of a policy (.npz)."""


class _Drawn:
    """Draws actions from a space of its own."""

    def __init__(self, space: gym.Space[Any]) -> None:
        self._space = deepcopy(space)

    def begin(self, seed: int) -> None:
        self._space.seed(seed)

    def act(self, observation: Any) -> Any:
        return self._space.sample()


class _Called:
    """A function of the observations alone."""

    def __init__(self, act: Callable[[Any], Any]) -> None:
        self.act = act

    def begin(self, robots: npt.NDArray[np.int64], seeds: Sequence[int]) -> None:
        """Nothing is remembered."""


def policies_of(policy: Named, env: gym.vector.VectorEnv[Any, Any, Any]) -> Policies:
    """Policies of an environment's robots.

    Raises:
        AgentError: there is no such policy, or it is of other observations or actions.
    """
    if isinstance(policy, Path):
        found = learnt.policy_of(policy)
        found.check(env.single_observation_space, env.single_action_space)
        return found.many(env.num_envs)
    if policy == RANDOM:
        return OneEach([_Drawn(env.single_action_space) for _ in range(env.num_envs)])
    return _Called(function(policy) if isinstance(policy, str) else policy)


def function(name: str) -> Callable[[Any], Any]:
    """The function that "MODULE:FUNCTION" names.

    Raises:
        AgentError: there is none.
    """
    module, colon, attribute = name.partition(":")
    if not colon:
        raise AgentError(f"policy {name!r} is neither {RANDOM!r} nor MODULE:FUNCTION nor the folder of a run")
    try:
        found: Callable[[Any], Any] = getattr(importlib.import_module(module), attribute)
    except (ImportError, AttributeError, ValueError) as error:
        raise AgentError(f"policy {name!r} cannot be loaded: {error}") from None
    if not callable(found):
        raise AgentError(f"policy {name!r} is {found!r}; it must be a function of observations")
    return found
