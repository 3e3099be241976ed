# SPDX-License-Identifier: BSD-3-Clause
"""What a deep agent has learnt, as a policy that plays without torch.

For one robot its network takes a tenth of the time of a call of torch.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import Any

import gymnasium as gym
import numpy as np
import numpy.typing as npt

from ..errors import AgentError
from .actions import Actions
from .features import Features, Frames, Rows
from .settings import Settings


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
        self._stages: list[Callable[[Rows], Rows]] = [_stage(stage) for stage in stages]
        if hasattr(policy, "actor"):
            self._stages.append(np.tanh)
        self._chooses = hasattr(model.action_space, "n")

    def __call__(self, rows: Rows) -> npt.NDArray[Any]:
        """The best actions for rows of features: their numbers, or numbers from -1 to 1. How many rows there are
        changes nothing in one."""
        for stage in self._stages:
            rows = stage(rows)
        return np.argmax(rows, axis=1) if self._chooses else np.clip(rows, -1.0, 1.0)


def _stage(stage: Any) -> Callable[[Rows], Rows]:
    """A torch module as a function."""
    kind = type(stage).__name__
    if kind == "Linear":
        weight, bias = stage.weight.detach().numpy().copy(), stage.bias.detach().numpy().copy()
        return lambda rows: (weight @ rows[:, :, None])[:, :, 0] + bias  # row by row
    if kind == "Tanh":
        return np.tanh
    if kind == "ReLU":
        return lambda rows: np.maximum(rows, np.float32(0.0))
    raise AgentError(f"a layer {stage} cannot be played")


class DeepPolicy:
    """Takes the most likely action (PPO, SAC: the middle of the distribution), or the best (DQN).

    Args:
        model: model of stable-baselines3.
        settings: settings that it was trained with.
        features, actions: of the environment that it was trained in.
    """

    def __init__(self, model: Any, settings: Settings, features: Features, actions: Actions) -> None:
        self.model, self._settings, self._features, self._actions = model, settings, features, actions
        self._network = Network(model)
        self._one = self.many(1)

    def check(self, observations: gym.Space[Any], actions: gym.Space[Any]) -> None:
        """See ``Policy``: as many features, and the same kind of actions. Their limits may be others."""
        width = Features(observations, self._settings.sectors).width
        if width != self._features.width:
            raise AgentError(f"the model sees {self._features.width} features; {observations} gives {width}")
        own = self._actions.environment
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
        return int(action) if isinstance(self._actions.space, gym.spaces.Discrete) else action

    def many(self, count: int) -> DeepPolicies:
        """See ``Policy``."""
        frames = Frames(count, self._settings.frames, self._features.width)
        return DeepPolicies(self._network, self._features, frames, self._actions)


class DeepPolicies:
    """The same network for several robots."""

    def __init__(self, network: Network, features: Features, frames: Frames, actions: Actions) -> None:
        self._network, self._features, self._frames, self._actions = network, features, frames, actions
        self._fresh = np.zeros(len(frames.rows), np.bool_)

    def begin(self, robots: npt.NDArray[np.int64], seeds: Sequence[int]) -> None:
        """See ``Policies``."""
        self._fresh[robots] = True

    def act(self, observations: Any) -> npt.NDArray[Any]:
        """See ``Policies``."""
        features = self._features(observations)
        rows = self._frames.push(features)
        if self._fresh.any():
            rows = self._frames.begin(features, self._fresh)
            self._fresh[:] = False
        return self._actions.to_environment(self._network(rows))


def _count(space: gym.Space[Any]) -> int:
    return int(getattr(space, "n", 0))
