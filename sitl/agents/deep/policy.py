# SPDX-License-Identifier: BSD-3-Clause
"""What a deep agent has learnt, as a policy that plays without torch."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import gymnasium as gym
import numpy as np
import numpy.typing as npt

from ..errors import AgentError
from .actions import Actions
from .features import Features, Frames
from .network import Network
from .settings import Settings


class DeepPolicy:
    """Takes the most likely action (PPO, SAC: the middle of the distribution), or the best (DQN).

    Args:
        network: what it has learnt.
        settings: settings that it was trained with.
        features, actions: of the environment that it was trained in.
    """

    def __init__(self, network: Network, settings: Settings, features: Features, actions: Actions) -> None:
        self.network, self.settings, self.features, self.actions = network, settings, features, actions
        self._one = self.many(1)

    def check(self, observations: gym.Space[Any], actions: gym.Space[Any]) -> None:
        """See ``Policy``: as many features, and the same kind of actions. Their limits may be others."""
        width = Features(observations, self.settings.sectors).width
        if width != self.features.width:
            trained = self.features.width
            raise AgentError(f"the policy was trained on {trained} features; not {width}: {observations}")
        own = self.actions.environment
        if type(actions) is not type(own) or actions.shape != own.shape or getattr(actions, "n", 0) != _count(own):
            raise AgentError(f"the model takes actions of {own}, not of {actions}")

    def begin(self, seed: int) -> None:
        """See ``Policy``."""
        self._one.begin(np.zeros(1, np.int64), [seed])

    def act(self, observation: Any) -> Any:
        """See ``Policy``."""
        if isinstance(observation, dict):
            rows: Any = {name: np.asarray(value)[None] for name, value in observation.items()}
        else:
            rows = np.asarray(observation)[None]
        action = self._one.act(rows)[0]
        return int(action) if isinstance(self.actions.space, gym.spaces.Discrete) else action

    def many(self, count: int) -> DeepPolicies:
        """See ``Policy``."""
        frames = Frames(count, self.settings.frames, self.features.width)
        return DeepPolicies(self.network, self.features, frames, self.actions)


class DeepPolicies:
    """The same network for several robots."""

    def __init__(self, network: Network, features: Features, frames: Frames, actions: Actions) -> None:
        self._network, self.features, self._frames, self.actions = network, features, frames, actions
        self._fresh = np.zeros(len(frames.rows), np.bool_)

    def begin(self, robots: npt.NDArray[np.int64], seeds: Sequence[int]) -> None:
        """See ``Policies``."""
        self._fresh[robots] = True

    def act(self, observations: Any) -> npt.NDArray[Any]:
        """See ``Policies``."""
        features = self.features(observations)
        rows = self._frames.push(features)
        if self._fresh.any():
            rows = self._frames.begin(features, self._fresh)
            self._fresh[:] = False
        return self.actions.to_environment(self._network(rows))


def _count(space: gym.Space[Any]) -> int:
    return int(getattr(space, "n", 0))
