# SPDX-License-Identifier: BSD-3-Clause
"""Vehicles without a lidar are in all environments that read none; others name who reads it."""

from __future__ import annotations

import gymnasium as gym
import numpy as np
import pytest

from sitl.envs import EnvOptionError


@pytest.mark.parametrize(
    ("name", "frame"),
    [
        ("CopterHover", "ardupilot_quad"),
        ("CopterGates", "ardupilot_x"),
        ("CopterLand", "ardupilot_hexa"),
        ("RoverWaypoint", "ardupilot_rover"),
        ("RoverSlalom", "skid_rover"),
    ],
)
def test_they_are_driven(name, frame) -> None:
    with gym.make(f"sitl/{name}-v1", frame=frame) as env:
        first, _ = env.reset(seed=1)
        for _ in range(20):
            observation, reward, terminated, _, _ = env.step(np.ones(env.action_space.shape, np.float32))
        assert env.unwrapped.robot.name == frame and not terminated
        assert np.isfinite(observation).all() and np.isfinite(reward) and not np.array_equal(first, observation)


def test_many_at_once_are_as_each_alone() -> None:
    with gym.make("sitl/CopterHover-v1", frame="ardupilot_quad") as alone:
        alone.reset(seed=5)
        expected = alone.step(np.zeros(alone.action_space.shape, np.float32))[0]
    many = gym.make_vec("sitl/CopterHover-v1", num_envs=2, frame="ardupilot_quad")
    many.reset(seed=4)
    assert np.array_equal(many.step(np.zeros(many.action_space.shape, np.float32))[0][1], expected)
    many.close()


@pytest.mark.parametrize(
    ("env_id", "options", "who"),
    [
        ("sitl/CopterForest-v1", {"frame": "ardupilot_quad"}, "observation"),
        (
            "sitl/Navigate-v1",
            {"robot": "autopilot", "frame": "ardupilot_rover", "world": "maze"},
            "observation and task",
        ),
    ],
)
def test_who_reads_the_lidar_is_named(env_id, options, who) -> None:
    with pytest.raises(EnvOptionError, match=f"^{who}: lidar readings are needed, and '{options['frame']}' has no"):
        gym.make(env_id, **options)
