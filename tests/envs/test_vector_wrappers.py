# SPDX-License-Identifier: BSD-3-Clause
"""Gymnasium's vector wrappers give around our vectors what they give around its own, and refuse the same modes."""

from __future__ import annotations

import gymnasium as gym
import numpy as np
import pytest
from gymnasium.wrappers import vector as wrappers

from sitl.envs import EnvOptionError
from tests.envs.vector_equality import same

HOVER, STEPS = "sitl/CopterHover-v1", 9
BOX = {
    "RecordEpisodeStatistics": {}, "NormalizeObservation": {}, "NormalizeReward": {}, "ClipAction": {},
    "RescaleAction": {"min_action": -2.0, "max_action": 2.0}, "ClipReward": {"min_reward": -1.0, "max_reward": 1.0},
    "DictInfoToList": {}, "DtypeObservation": {"dtype": np.float64}, "FlattenObservation": {},
    "TransformReward": {"func": np.negative}, "TransformAction": {"func": np.negative},
    "TransformObservation": {"func": np.negative},
}  # fmt: skip
CASES = [
    *[(name, given, "box") for name, given in BOX.items()],
    ("FilterObservation", {"filter_keys": ["velocity"]}, "dict"), ("FlattenObservation", {}, "dict"),
    ("RecordEpisodeStatistics", {}, "dict"), ("GrayscaleObservation", {}, "camera"),
]  # fmt: skip
SMALL = {"num_envs": 2, "max_episode_steps": 4, "boots": 1}
OBSERVATIONS = {"box": {}, "dict": {"observation": "goal+velocity"}, "camera": {"observation": "camera"}}


def played(robots, wrapper, given):
    """All that a wrapped vector tells, over ends of episodes; why it refuses the vector."""
    actions = np.random.default_rng(0).uniform(-1.0, 1.0, (STEPS, *robots.action_space.shape)).astype(np.float32)
    try:
        env = wrapper(robots, **given)
    except (ValueError, AssertionError) as error:  # before Gymnasium 1.4 without words
        robots.close()
        return str(error)
    told = [env.reset(seed=3), *(env.step(action.copy()) for action in actions)]
    env.close()
    return [tuple(without_wall_time(part) for part in parts) for parts in told]


def without_wall_time(part):
    if isinstance(part, dict) and "episode" in part:
        return {**part, "episode": {name: value for name, value in part["episode"].items() if name not in ("t", "_t")}}
    if isinstance(part, list):
        return {str(index): without_wall_time(value) for index, value in enumerate(part)}
    return part


@pytest.mark.parametrize("mode", ["NextStep", "SameStep"])
@pytest.mark.parametrize(("name", "given", "seen"), CASES)
def test_wrappers_take_our_vectors_as_gymnasiums(name, given, seen, mode):
    wrapper, options = getattr(wrappers, name), {**SMALL, **OBSERVATIONS[seen]}
    ours = gym.make_vec(HOVER, autoreset_mode=mode, **options)
    theirs = gym.make_vec(HOVER, vectorization_mode="sync", vector_kwargs={"autoreset_mode": mode}, **options)
    assert same(played(ours, wrapper, given), played(theirs, wrapper, given))


def test_vector_kwargs_are_of_gymnasiums_vectors_alone():
    """Gymnasium refuses them for every id that has a vector environment of its own, CartPole's, too."""
    for name in ("CartPole-v1", HOVER):
        with pytest.raises(gym.error.Error, match="can be passed arguments only through kwargs"):
            gym.make_vec(name, vectorization_mode="vector_entry_point", vector_kwargs={"autoreset_mode": "SameStep"})
    with pytest.raises(EnvOptionError, match=r"autoreset_mode = 'SameStep': .* takes the mode in vector_kwargs"):
        gym.make_vec(HOVER, vectorization_mode="sync", autoreset_mode="SameStep")
