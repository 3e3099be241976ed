# SPDX-License-Identifier: BSD-3-Clause
"""Algorithms by name: what trains a run, what plays its model, what its settings can be."""

from __future__ import annotations

import importlib
from collections.abc import Mapping
from typing import Any, Protocol

import gymnasium as gym

from .errors import AgentError
from .policies import Policies
from .runs.config import RunConfig
from .runs.folder import RunFolder
from .runs.watch import Watch


class Policy(Protocol):
    """A learnt policy."""

    def check(self, observations: gym.Space[Any], actions: gym.Space[Any]) -> None:
        """Raises AgentError when it cannot play in an environment of these spaces."""

    def begin(self, seed: int) -> None:
        """Start an episode; the same seed gives the same choices."""

    def act(self, observation: Any) -> Any:
        """The action for an observation."""

    def many(self, count: int) -> Policies:
        """The same for ``count`` robots; each acts as a policy of its own would."""


class Algorithm(Protocol):
    """The functions of a module that implements an algorithm."""

    LENGTH: Mapping[str, int]
    """Default length of a run: {"episodes": ...} or {"steps": ...}."""

    LIBRARIES: tuple[str, ...]
    """Libraries whose versions results depend on, besides those of every run."""

    def settings(self, algorithm: str, given: Mapping[str, Any]) -> dict[str, Any]:
        """All settings, the given ones and defaults, checked. Raises AgentError."""

    def check(self, config: RunConfig, observations: gym.Space[Any], actions: gym.Space[Any]) -> None:
        """Raises AgentError when a run cannot learn in an environment of these spaces."""

    def train(self, folder: RunFolder, watch: Watch) -> None:
        """Train until the run is done or ``watch.stop``; from the model in the folder when there is one."""

    def policy(self, folder: RunFolder) -> Policy:
        """The policy that the run has learnt. Raises AgentError."""


ALGORITHMS = {
    "qlearn": "sitl.agents.tabular.training",
    "sarsa": "sitl.agents.tabular.training",
    "dqn": "sitl.agents.deep.training",
    "ppo": "sitl.agents.deep.training",
    "sac": "sitl.agents.deep.training",
}
"""Name -> module."""
TABULAR = ("qlearn", "sarsa")


def load(algorithm: str) -> Algorithm:
    """The module of an algorithm.

    Raises:
        AgentError: no such algorithm.
    """
    if algorithm not in ALGORITHMS:
        raise AgentError(f"algorithm {algorithm!r} is not known; it is one of {', '.join(ALGORITHMS)}")
    module: Any = importlib.import_module(ALGORITHMS[algorithm])
    return module  # type: ignore[no-any-return]


def policy_of(folder: RunFolder) -> Policy:
    """The policy that a run has learnt.

    Raises:
        AgentError: it has no model yet.
    """
    return load(folder.config.algorithm).policy(folder)
