# SPDX-License-Identifier: BSD-3-Clause
"""One episode of learning in any Gymnasium environment with discrete spaces."""

from __future__ import annotations

from typing import Any

import gymnasium as gym

from .learner import Learner
from .outcome import Outcome


def learn_episode(
    env: gym.Env[Any, Any], learner: Learner, seed: int, options: dict[str, Any] | None = None
) -> Outcome:
    """Learn from an episode, after ``learner.begin``.

    Args:
        env: it must truncate its episodes (``gym.make(..., max_episode_steps=...)``).
        learner: the learner.
        seed: seed of the reset.
        options: options of the reset.
    """
    observation, _ = env.reset(seed=seed, options=options)
    key = learner.first_key(observation)
    action, steps, total = learner.choose(key), 0, 0.0
    while True:
        observation, reward, terminated, truncated, _ = env.step(action)
        after = learner.table.key(observation)
        following = learner.learn(key, action, float(reward), after, bool(terminated))
        key, action, steps, total = after, following, steps + 1, total + float(reward)
        if terminated or truncated:
            return Outcome(steps, total, bool(terminated))
