# SPDX-License-Identifier: BSD-3-Clause
"""Starts with a random heading, starts out of a few, and a table of actions given as plain data."""

from __future__ import annotations

import pickle

import gymnasium as gym
import numpy as np
import pytest

from sitl import envs


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
