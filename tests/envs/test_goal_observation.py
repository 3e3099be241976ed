# SPDX-License-Identifier: BSD-3-Clause
"""The way to the goal as part of the observation."""

from __future__ import annotations

import math

import gymnasium as gym
import numpy as np
import pytest
from gymnasium.utils.env_checker import check_env

import sitl.envs  # noqa: F401
from sitl.envs.options import EnvOptionError
from sitl.envs.tasks import ReachGoal


def make(**options):
    return gym.make("sitl/Navigate-v0", world="maze", action="continuous", **options)


@pytest.mark.parametrize("observation", ["digits+goal", "scan+goal", "scan+pose+goal"])
def test_spaces_are_kept(observation: str) -> None:
    check_env(make(task="goal", observation=observation).unwrapped, skip_render_check=True)


def test_distance_and_bearing() -> None:
    env = make(task=ReachGoal((0.0, 1.0)), observation="scan+goal", start=(0.0, 0.0, 0.0))
    observation, _ = env.reset(seed=1)
    assert observation["goal"] == pytest.approx([1.0, math.pi / 2])  # to the left
    observation, _ = env.reset(options={"pose": (0.0, 0.0, math.pi / 2)})
    assert observation["goal"] == pytest.approx([1.0, 0.0], abs=1e-6)
    after = env.step(np.array([0.2, 0.0], np.float32))[0]
    assert 0.8 < after["goal"][0] < 1.0


def test_a_vector_sees_each_robots_goal() -> None:
    options = {"world": "maze", "task": "goal", "observation": "scan+goal"}
    robots = gym.make_vec("sitl/Navigate-v0", num_envs=3, vectorization_mode="vector_entry_point", **options)
    seen, _ = robots.reset(seed=5)
    for k in range(3):
        one, _ = gym.make("sitl/Navigate-v0", **options).reset(seed=5 + k)
        assert np.array_equal(seen["goal"][k], one["goal"])


def test_a_task_without_a_goal_is_named() -> None:
    with pytest.raises(EnvOptionError, match="has none"):
        make(task="wander", observation="scan+goal")
