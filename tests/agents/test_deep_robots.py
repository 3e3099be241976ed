# SPDX-License-Identifier: BSD-3-Clause
"""The vector environments as stable-baselines3 sees them."""

from __future__ import annotations

import gymnasium as gym
import numpy as np
import pytest

pytest.importorskip("stable_baselines3", reason="deep agents need the extra 'rl'")

from sitl.agents.deep.actions import Actions
from sitl.agents.deep.features import Features
from sitl.agents.deep.robots import Robots
from sitl.agents.deep.training import Tally
from tests.agents.deep_runs import CIRCUIT2

SEEDS = [11, 12, 13]


def robots(start="random", steps=20):
    env = gym.make_vec(CIRCUIT2, num_envs=3, observation="scan", start=start, max_episode_steps=steps)
    features = Features(env.single_observation_space, 0)
    return Robots(env, features, 2, Actions(env.single_action_space, "ppo"), 0.1, Tally(3, 0.6), SEEDS)


def test_each_robot_is_a_single_environment_reset_in_the_step_that_ends_its_episode():
    many = robots()
    singles = [gym.make(CIRCUIT2, observation="scan", start="random", max_episode_steps=20) for _ in SEEDS]
    features = Features(singles[0].observation_space, 0)
    width, rng = features.width, np.random.default_rng(0)
    seen = many.reset()
    alone = [env.reset(seed=seed)[0] for env, seed in zip(singles, SEEDS)]
    assert np.array_equal(seen[:, :width], features(np.array(alone)))
    assert np.array_equal(seen[:, width:], seen[:, :width])
    ends = 0
    for _ in range(120):
        actions = rng.integers(3, size=3)
        before = seen
        seen, rewards, dones, infos = many.step(actions)
        for k, env in enumerate(singles):
            observation, reward, terminated, truncated, _ = env.step(int(actions[k]))
            row = features(observation[None])[0]
            assert rewards[k] == pytest.approx(0.1 * reward) and dones[k] == (terminated or truncated)
            if dones[k]:
                ends += 1
                assert np.array_equal(infos[k]["terminal_observation"], np.concatenate([row, before[k, :width]]))
                assert infos[k]["TimeLimit.truncated"] == (truncated and not terminated)
                row = features(env.reset()[0][None])[0]
                assert np.array_equal(seen[k], np.tile(row, 2))
            else:
                assert np.array_equal(seen[k], np.concatenate([row, before[k, :width]])) and infos[k] == {}
    assert ends > 6


def test_they_go_on_from_a_memory_bit_for_bit():
    one, other = robots(), robots()
    one.reset()
    rng = np.random.default_rng(1)
    for _ in range(30):
        one.step(rng.integers(3, size=3))
    other.recall(one.memory())
    for _ in range(40):
        actions = rng.integers(3, size=3)
        for a, b in zip(one.step(actions)[:3], other.step(actions)[:3]):
            assert np.array_equal(a, b)


def test_stable_baselines3_takes_them():
    from stable_baselines3.common.env_util import is_wrapped  # noqa: F401
    from stable_baselines3.common.vec_env import VecMonitor

    wrapped = VecMonitor(robots())
    assert wrapped.reset().shape == (3, 40) and wrapped.get_attr("num_envs") == [3, 3, 3]
    with pytest.raises(NotImplementedError):
        wrapped.set_attr("x", 1)
    wrapped.close()
