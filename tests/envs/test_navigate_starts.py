# SPDX-License-Identifier: BSD-3-Clause
"""Starts with a random heading or out of a few, actions as plain data, and the way to the goal as an observation."""

from __future__ import annotations

import math
import pickle

import gymnasium as gym
import numpy as np
import pytest
from gymnasium.utils.env_checker import check_env

import sitl.envs  # noqa: F401
from sitl import envs
from sitl.envs.options import EnvOptionError
from sitl.envs.tasks import ReachGoal


def test_turned_is_the_start_place_with_any_heading():
    env = gym.make("GazeboMazeTurtlebotLIDAR-v0", start="turned")
    poses = []
    for seed in range(40):
        env.reset(seed=seed)
        poses.append(env.unwrapped.robot.pose[0].copy())
    assert np.abs(np.array(poses)[:, :2]).max() < 1e-9
    yaws = np.array(poses)[:, 3]
    assert yaws.min() < -2.0 and yaws.max() > 2.0 and len(set(yaws.tolist())) == 40


def test_one_of_a_few_random_poses_that_are_always_the_same():
    seen = []
    for _ in range(2):
        env = pickle.loads(pickle.dumps(gym.make("GazeboCircuit2TurtlebotLIDAR-v0", start="random:5").unwrapped))
        found = set()
        for seed in range(60):
            env.reset(seed=seed)
            found.add(tuple(env.robot.pose[0].tolist()))
        seen.append(found)
    assert len(seen[0]) == 5 and seen[0] == seen[1]
    for wrong in ("random:", "random:0", "random:-1", "random:x"):
        with pytest.raises(envs.EnvOptionError, match='must be "random:N"'):
            gym.make("GazeboCircuit2TurtlebotLIDAR-v0", start=wrong)


def test_a_table_of_actions_as_plain_data():
    rows = {"on": (0.3, 0.0), "back": (-0.2, 0.0)}
    env = gym.make("GazeboCircuit2TurtlebotLIDAR-v0", action=rows, task="wander")
    env.reset(seed=0)
    assert env.action_space.n == 2
    env.step(1)
    assert env.unwrapped.robot.pose[0, 0] < -0.05
    with pytest.raises(envs.EnvOptionError, match="'on'"):
        gym.make("GazeboCircuit2TurtlebotLIDAR-v0", action={"on": (0.3,)})


def make(**options):
    return gym.make("sitl/Navigate-v1", world="maze", action="continuous", **options)


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
    robots = gym.make_vec("sitl/Navigate-v1", num_envs=3, vectorization_mode="vector_entry_point", **options)
    seen, _ = robots.reset(seed=5)
    for k in range(3):
        one, _ = gym.make("sitl/Navigate-v1", **options).reset(seed=5 + k)
        assert np.array_equal(seen["goal"][k], one["goal"])


def test_a_task_without_a_goal_is_named() -> None:
    with pytest.raises(EnvOptionError, match="has none"):
        make(task="wander", observation="scan+goal")
