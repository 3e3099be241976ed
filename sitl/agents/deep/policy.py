# SPDX-License-Identifier: BSD-3-Clause
"""What a deep agent has learnt, as a policy that plays without torch.

For one robot its network takes a tenth of the time of a call of torch.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import gymnasium as gym
import numpy as np
import numpy.typing as npt

from ..errors import AgentError
from .actions import Actions
from .features import Features, Frames
from .settings import Settings

Row = npt.NDArray[np.float32]


class Network:
    """Greedy choices of a model of stable-baselines3.

    Args:
        model: DQN, PPO or SAC with plain layers.

    Raises:
        AgentError: its layers are others.
    """

    def __init__(self, model: Any) -> None:
        policy = model.policy
        if hasattr(policy, "q_net"):
            stages = [*policy.q_net.q_net]
        elif hasattr(policy, "mlp_extractor"):
            stages = [*policy.mlp_extractor.policy_net, policy.action_net]
        else:
            stages = [*policy.actor.latent_pi, policy.actor.mu]
        self._stages: list[Callable[[Row], Row]] = [_stage(stage) for stage in stages]
        if hasattr(policy, "actor"):
            self._stages.append(np.tanh)
        self._chooses = hasattr(model.action_space, "n")

    def __call__(self, row: Row) -> npt.NDArray[Any]:
        """The best action for a row of features: its number, or numbers from -1 to 1."""
        for stage in self._stages:
            row = stage(row)
        return np.argmax(row) if self._chooses else np.clip(row, -1.0, 1.0)  # type: ignore[return-value]


def _stage(stage: Any) -> Callable[[Row], Row]:
    """A torch module as a function."""
    kind = type(stage).__name__
    if kind == "Linear":
        weight, bias = stage.weight.detach().numpy().copy(), stage.bias.detach().numpy().copy()
        return lambda row: weight @ row + bias
    if kind == "Tanh":
        return np.tanh
    if kind == "ReLU":
        return lambda row: np.maximum(row, np.float32(0.0))
    raise AgentError(f"a layer {stage} cannot be played")


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
