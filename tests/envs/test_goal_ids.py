# SPDX-License-Identifier: BSD-3-Clause
"""Goal-conditioned ids: ``compute_reward`` is there where libraries look for it, and vectors stay fast ones."""

from __future__ import annotations

import gymnasium as gym
import pytest

from sitl.envs.vector import NavigateVector

IDS = [f"sitl/{robot}ReachGoal{form}-v1" for robot in ("Copter", "Rover") for form in ("", "Discrete")]


@pytest.mark.parametrize("name", IDS)
def test_the_outermost_wrapper_tells_what_goals_are_worth(name):
    env = gym.make(name)
    seen, _ = env.reset(seed=1)
    seen, reward, *_, info = env.step(env.action_space.sample())
    paid = env.compute_reward(seen["achieved_goal"], seen["desired_goal"], info)
    assert paid.shape == () and float(paid) == reward
    env.close()


def test_without_a_goal_in_the_observation_there_is_no_such_attribute():
    env = gym.make(IDS[0], observation=["velocity"])
    assert not hasattr(env, "compute_reward")
    env.close()


@pytest.mark.parametrize(
    ("given", "limit"), [({}, 100), ({"max_episode_steps": 3}, 3), ({"max_episode_steps": -1}, None)]
)
def test_its_spec_makes_the_same_again(given, limit):
    env = gym.make(IDS[0], **given)
    specs = [env.spec, env.spec, gym.envs.registration.EnvSpec.from_json(env.spec.to_json())]
    env.close()
    for spec in specs:
        assert spec.max_episode_steps == limit and len(spec.additional_wrappers[:]) == 1
        again = gym.make(spec)
        assert str(again) == str(env) and hasattr(again, "compute_reward")
        again.close()


def test_vectors_are_made_by_their_own_entry_point():
    env = gym.make(IDS[0])
    for made in (gym.make_vec(IDS[0], num_envs=2), gym.make_vec(env.spec, num_envs=2)):
        assert isinstance(made, NavigateVector) and made.max_episode_steps == 100
        made.close()
    several = gym.make_vec(IDS[0], num_envs=2, vectorization_mode="sync")
    seen, _ = several.reset(seed=1)
    (worth, _) = several.call("compute_reward", seen["desired_goal"][:1], seen["desired_goal"][:1], [{}])
    assert worth.tolist() == [0.0]
    several.close(), env.close()
