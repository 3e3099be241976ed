# SPDX-License-Identifier: BSD-3-Clause
"""What a deep agent has learnt, as a policy that plays."""

from __future__ import annotations

from typing import Any

import gymnasium as gym
import numpy as np

from ..errors import AgentError
from .actions import Actions
from .features import Features, Frames
from .network import Network
from .settings import Settings


class DeepPolicy:
    """Takes the most likely action (PPO, SAC: the middle of the distribution), or the best (DQN).

    Args:
        model: model of stable-baselines3.
        settings: settings that it was trained with.
        features, actions: of the environment that it was trained in.
    """

    def __init__(self, model: Any, settings: Settings, features: Features, actions: Actions) -> None:
        self.model, self._features, self._actions = model, features, actions
        self._network = Network(model)
        self._frames = Frames(1, settings.frames, features.width)
        self._sectors, self._fresh = settings.sectors, True

    def check(self, observations: gym.Space[Any], actions: gym.Space[Any]) -> None:
        """See ``Policy``: as many features, and the same kind of actions. Their limits may be others."""
        width = Features(observations, self._sectors).width
        if width != self._features.width:
            raise AgentError(f"the model sees {self._features.width} features; {observations} gives {width}")
        own = self._actions.environment
        if type(actions) is not type(own) or actions.shape != own.shape or getattr(actions, "n", 0) != _count(own):
            raise AgentError(f"the model takes actions of {own}, not of {actions}")

    def begin(self, seed: int) -> None:
        """See ``Policy``."""
        self._fresh = True

    def act(self, observation: Any) -> Any:
        """See ``Policy``."""
        if isinstance(observation, dict):
            rows: Any = {name: np.asarray(value)[None] for name, value in observation.items()}
        else:
            rows = np.asarray(observation)[None]
        features = self._features(rows)
        frames = self._frames.begin(features) if self._fresh else self._frames.push(features)
        self._fresh = False
        action = self._actions.to_environment(np.asarray(self._network(frames[0]))[None])[0]
        return int(action) if isinstance(self._actions.space, gym.spaces.Discrete) else action


def _count(space: gym.Space[Any]) -> int:
    return int(getattr(space, "n", 0))
