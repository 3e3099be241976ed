# SPDX-License-Identifier: BSD-3-Clause
"""What a deep agent learns by: what all algorithms have, and what each has of its own."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import asdict, dataclass, fields
from typing import Any

from ..errors import AgentError, check_names


@dataclass(frozen=True)
class Settings:
    """Settings of all algorithms.

    Raises:
        AgentError: a setting outside its limits.
    """

    robots: int = 16
    """Number of robots that learn at once, in one vector environment."""
    sectors: int = 48
    """Number of sectors that a scan is divided into; the nearest reading of each counts. 0: all readings."""
    frames: int = 3
    """Number of successive observations that the network gets, the newest first."""
    reward_scale: float = 0.05
    """Factor of rewards for learning; the run's log has the unscaled ones."""
    gamma: float = 0.99
    """Discount of a step, 0 .. 1."""
    learning_rate: float = 3e-4
    learning_rate_end: float = 3e-4
    """Learning rate at the end of the run; it falls linearly."""
    batch: int = 256
    """Samples of a gradient step."""
    width: int = 64
    """Units of each hidden layer."""
    layers: int = 2
    """Number of hidden layers."""
    threads: int = 1
    """Threads of torch; with more than one, sums can differ in their last bits between machines."""
    check_every: int = 100_000
    """Steps between two greedy evaluations of the network; the best network is kept for playing. 0: no checks."""
    check_episodes: int = 20
    """Number of episodes that a check plays."""
    check_by: str = "reward"
    """Criterion of the best network: "reward", the highest mean reward; "crashes", the fewest episodes that ended by
    themselves (the highest mean reward decides between equals)."""
    enough: int = 0
    """The run ends after so many checks in a row in which every episode solved the task. 0: never."""

    def __post_init__(self) -> None:
        for field in fields(self):
            value, kind = getattr(self, field.name), str(field.type)
            if kind == "str":
                if value not in _CHOICES[field.name]:
                    allowed = ", ".join(_CHOICES[field.name])
                    raise AgentError(f"{field.name} = {value!r}; it must be one of {allowed}")
                continue
            low, high = _LIMITS.get(field.name, (1, math.inf) if kind == "int" else (0.0, 1.0))
            number = isinstance(value, int if kind == "int" else int | float) and not isinstance(value, bool)
            if not number or not low <= value <= high:
                what = "whole number" if kind == "int" else "number"
                limits = f"from {low:g} on" if high == math.inf else f"from {low:g} to {high:g}"
                raise AgentError(f"{field.name} = {value!r}; it must be a {what} {limits}")


@dataclass(frozen=True)
class Ppo(Settings):
    """PPO. Source: Schulman et al., "Proximal Policy Optimization Algorithms", arXiv:1707.06347."""

    robots: int = 32
    batch: int = 512
    learning_rate: float = 7e-4
    rollout: int = 128
    """Steps of each robot between two updates."""
    epochs: int = 8
    """Number of passes over each sample."""
    advantage_decay: float = 0.95
    """Lambda of the generalised advantage estimate."""
    clip: float = 0.2
    """Clipping range: how far the probability ratio of an action may differ from 1."""
    entropy: float = 0.01
    """Weight of the policy's entropy: exploration."""
    learning_rate_end: float = 3e-5


@dataclass(frozen=True)
class OffPolicy(Settings):
    """DQN and SAC: both learn from a memory of past steps."""

    memory: int = 200_000
    """Capacity of the replay memory: steps of all robots together."""
    warm_up: int = 5_000
    """Steps of random actions before learning begins."""
    learn_every: int = 1
    """Steps of each robot between two rounds of learning."""
    gradient_steps: int = 2
    """Number of gradient steps in each round."""
    hindsight: int = 0
    """Of goal-conditioned environments: for each step that is replayed as it was, so many are replayed with a goal that
    was reached later in the episode. 0: none. Source: Andrychowicz et al., "Hindsight Experience Replay",
    arXiv:1707.01495."""


@dataclass(frozen=True)
class Dqn(OffPolicy):
    """DQN. Source: Mnih et al., "Human-level control through deep reinforcement learning", Nature 518, 2015."""

    target_period: int = 2_000
    """Steps between two copies of the network that targets are computed with."""
    epsilon_end: float = 0.05
    """Probability of a random action, once it has fallen from 1."""
    epsilon_share: float = 0.3
    """Fraction of the run in which it falls."""


@dataclass(frozen=True)
class Sac(OffPolicy):
    """SAC. Source: Haarnoja et al., "Soft Actor-Critic Algorithms and Applications", arXiv:1812.05905."""

    tau: float = 0.005
    """Fraction by which target networks approach the network in a gradient step."""
    entropy_start: float = 1.0
    """Weight of exploration at first; learning adjusts it."""


_CHOICES = {"check_by": ("reward", "crashes")}
_LIMITS: dict[str, tuple[float, float]] = {
    "sectors": (0, math.inf),
    "frames": (1, 64),
    "reward_scale": (1e-9, math.inf),
    "learning_rate": (1e-9, 1.0),
    "warm_up": (0, math.inf),
    "entropy_start": (1e-6, 10.0),
    "hindsight": (0, 64),
    "check_every": (0, math.inf),
    "enough": (0, math.inf),
}
_OF = {"dqn": Dqn, "ppo": Ppo, "sac": Sac}


def settings_of(algorithm: str, given: Mapping[str, Any]) -> Settings:
    """Settings of an algorithm: the given ones, the others as usual.

    Raises:
        AgentError: no such setting, or a value that cannot be.
    """
    kind = _OF[algorithm]
    check_names(given, [field.name for field in fields(kind)], f"setting {{!r}} of {algorithm}")
    return kind(**given)


def as_dict(settings: Settings) -> dict[str, Any]:
    """Names and values."""
    return asdict(settings)


def learns_by_goal(settings: Settings) -> bool:
    """Whether steps are replayed with other goals."""
    return isinstance(settings, OffPolicy) and settings.hindsight > 0
