# SPDX-License-Identifier: BSD-3-Clause
"""What ``gymnasium.make`` puts around an environment works as for any other."""

from __future__ import annotations

import gymnasium as gym
import pytest
from gymnasium.wrappers import PassiveEnvChecker

ID = "sitl/RoverWaypoint-v1"


def test_the_time_limit_is_the_ids_or_the_given_one():
    assert gym.make(ID).spec.max_episode_steps == 300
    env = gym.make(ID, max_episode_steps=3)
    assert env.spec.max_episode_steps == 3
    for _ in range(2):
        env.reset(seed=0)
        ends = [env.step(0 * env.action_space.sample())[2:4] for _ in range(3)]
        assert ends == [(False, False), (False, False), (False, True)]


def test_a_step_before_the_first_reset_is_refused():
    env = gym.make(ID)
    for made in (env, env.unwrapped):
        with pytest.raises(gym.error.ResetNeeded):
            made.step(env.action_space.sample())


def test_the_checker_can_be_left_out():
    def wrappers(env):
        while env is not env.unwrapped:
            yield type(env)
            env = env.env

    assert PassiveEnvChecker in wrappers(gym.make(ID))
    assert PassiveEnvChecker not in wrappers(gym.make(ID, disable_env_checker=True))


def test_infos_keep_what_they_were_told():
    env = gym.make(ID).unwrapped
    env.reset(seed=0)
    first = env.step(env.action_space.sample())[4]
    kept = {name: repr(value) for name, value in first.items()}
    env.step(env.action_space.sample())
    assert {name: repr(value) for name, value in first.items()} == kept
    assert type(first["is_success"]) is bool and type(first["reward_progress"]) is float
