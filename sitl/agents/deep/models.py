# SPDX-License-Identifier: BSD-3-Clause
"""Settings as the arguments of stable-baselines3's algorithms."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import gymnasium as gym

from .library import algorithm_class, stable_baselines3
from .settings import Dqn, OffPolicy, Ppo, Sac, Settings, learns_by_goal


def make(algorithm: str, settings: Settings, robots: Any, seed: int) -> Any:
    """A model that has learnt nothing yet.

    Args:
        algorithm: "dqn", "ppo" or "sac".
        settings: settings of that algorithm.
        robots: robots that it will learn with.
        seed: seed of its weights and choices.
    """
    hidden = [settings.width] * settings.layers
    common: dict[str, Any] = {
        "learning_rate": _falling(settings.learning_rate, settings.learning_rate_end),
        "gamma": settings.gamma,
        "batch_size": settings.batch,
        "seed": seed,
        "device": "cpu",
    }
    own: dict[str, Any] = {}
    arch: Any = hidden
    if isinstance(settings, Ppo):
        arch = {"pi": hidden, "vf": hidden}
        own = {
            "n_steps": settings.rollout, "n_epochs": settings.epochs, "gae_lambda": settings.advantage_decay,
            "clip_range": settings.clip, "ent_coef": settings.entropy,
        }  # fmt: skip
    if isinstance(settings, OffPolicy):
        own = {
            "buffer_size": settings.memory, "learning_starts": settings.warm_up,
            "train_freq": settings.learn_every, "gradient_steps": settings.gradient_steps,
        }  # fmt: skip
    if isinstance(settings, Dqn):
        own |= {
            "target_update_interval": settings.target_period, "exploration_fraction": settings.epsilon_share,
            "exploration_final_eps": settings.epsilon_end,
        }  # fmt: skip
    if isinstance(settings, Sac):
        own |= {"tau": settings.tau, "ent_coef": f"auto_{settings.entropy_start}"}
    if isinstance(settings, OffPolicy) and learns_by_goal(settings):
        own |= {
            "replay_buffer_class": stable_baselines3().HerReplayBuffer,
            "replay_buffer_kwargs": {"n_sampled_goal": settings.hindsight, "goal_selection_strategy": "future"},
        }
    kind = _policy_of(robots.observation_space)
    return algorithm_class(algorithm)(kind, robots, policy_kwargs={"net_arch": arch}, **common, **own)


def _policy_of(observations: gym.Space[Any]) -> str:
    return "MultiInputPolicy" if isinstance(observations, gym.spaces.Dict) else "MlpPolicy"


def empty(algorithm: str, net_arch: Any, observations: gym.Space[Any], actions: gym.Space[Any]) -> Any:
    """A model that knows nothing and does not learn: for weights that are to be played.

    Args:
        algorithm: "dqn", "ppo" or "sac".
        net_arch: hidden layers, as stable-baselines3 has them.
        observations, actions: that its networks are made for.
    """
    small: dict[str, Any] = {"n_steps": 2, "batch_size": 2} if algorithm == "ppo" else {"buffer_size": 1}
    if algorithm == "sac":
        small["target_entropy"] = 0.0  # by itself it would ask the robots, and there are none
    made = algorithm_class(algorithm)(
        _policy_of(observations),
        None,
        policy_kwargs={"net_arch": net_arch},
        device="cpu",
        _init_setup_model=False,
        **small,
    )
    made.observation_space, made.action_space, made.n_envs = observations, actions, 1
    made._setup_model()
    return made


def _falling(first: float, last: float) -> float | Callable[[float], float]:
    """Learning rate by the share of the run that is left."""
    if first == last:
        return first
    return lambda left: last + (first - last) * max(left, 0.0)
