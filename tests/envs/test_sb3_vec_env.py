# SPDX-License-Identifier: BSD-3-Clause
"""The adapter for stable-baselines3 gives what its DummyVecEnv gives of single environments."""

from __future__ import annotations

import subprocess
import sys

import gymnasium as gym
import numpy as np
import pytest

from sitl.envs import EnvOptionError
from tests.envs.vector_equality import same

CIRCUIT2, ROVER = "GazeboCircuit2TurtlebotLIDAR-v0", "GazeboMazeErleRoverLIDAR-v0"
CASES = {
    "digits": (CIRCUIT2, {"max_episode_steps": 30}),
    "a dict, and a goal": ("sitl/Navigate-v0", {
        "world": "round", "action": "continuous", "observation": "scan+goal", "task": "goal", "start": "random",
        "max_episode_steps": 7,
    }),
    "rover": (ROVER, {"max_episode_steps": 4, "observation": "scan"}),
}  # fmt: skip


def test_without_stable_baselines3_the_extra_is_named():
    code = """
import sys
sys.modules["stable_baselines3"] = None
from sitl.errors import MissingExtra
try:
    import sitl.envs.sb3
except MissingExtra as error:
    print(error)
"""
    said = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True).stdout
    assert "pip install 'gym-sitl[rl]'" in said


@pytest.fixture
def sb3():
    pytest.importorskip("stable_baselines3", reason="the adapter needs the extra 'rl'")
    from sitl.envs import sb3

    return sb3


@pytest.fixture
def both(sb3):
    from stable_baselines3.common.vec_env import DummyVecEnv

    def make(name=CIRCUIT2, count=3, **options):
        return (
            sb3.Sb3VecEnv(name, num_envs=count, **options),
            DummyVecEnv([lambda: gym.make(name, **options) for _ in range(count)]),
        )

    return make


@pytest.mark.parametrize("case", CASES)
def test_it_is_the_dummy_vec_env(both, case):
    name, options = CASES[case]
    ours, theirs = both(name, **options)
    assert ours.observation_space == theirs.observation_space and ours.action_space == theirs.action_space
    assert ours.seed(5) == theirs.seed(5) == [5, 6, 7]
    assert same(ours.reset(), theirs.reset()) and ours.reset_infos == theirs.reset_infos
    ours.action_space.seed(2)
    ended = 0
    for _ in range(12 if name == ROVER else 80):
        actions = np.array([ours.action_space.sample() for _ in range(3)])
        got, expected = ours.step(actions), theirs.step(actions)
        assert same(got, expected)
        assert ours.reset_infos == theirs.reset_infos
        assert [type(info["crashed"]) for info in got[3]] == [bool] * 3
        ended += got[2].sum()
    assert ended > 2
    assert same(ours.reset(), theirs.reset())  # without seeds: the random numbers go on
    ours.close(), theirs.close()


def test_options_of_all_and_of_each(both):
    ours, theirs = both()
    for options in ({"pose": (0.5, 0.0, 0.1)}, [{"pose": (0.5, 0.0, 0.1)}, {}, {"pose": (0.7, 0.0, 0.2)}], {}):
        for vector in (ours, theirs):
            vector.seed(1)
            vector.set_options(options)
        assert same(ours.reset(), theirs.reset())
        places = [np.concatenate([robot.pose for robot in vector.get_attr("robot")]) for vector in (ours, theirs)]
        assert np.array_equal(*places)


def test_attributes_and_methods_of_some(both):
    ours, theirs = both()
    for vector in (ours, theirs):
        vector.seed(1)
        vector.reset()
        vector.set_attr("level", 3, indices=[0, 2])
        assert vector.get_attr("level", indices=[2, 0]) == [3, 3]
        assert not vector.has_attr("level") and vector.has_attr("step_time")
        assert vector.get_attr("step_time", 1) == [0.6]
        assert vector.env_is_wrapped(gym.wrappers.TransformReward) == [False] * 3
        assert len(vector.env_method("snapshot", indices=1)) == 1
    states = [vector.env_method("snapshot", indices=1)[0] for vector in (ours, theirs)]
    assert same(states[0].robot, states[1].robot)


def test_pictures(both):
    pytest.importorskip("pygame", reason="pictures need the extra 'viz'")
    ours, theirs = both(render_mode="rgb_array")
    for vector in (ours, theirs):
        vector.seed(1)
        vector.reset()
    assert np.array_equal(ours.render(), theirs.render())


def test_vector_wrappers_may_be_between(sb3):
    vector = gym.make_vec(CIRCUIT2, num_envs=2, autoreset_mode="SameStep", max_episode_steps=3)
    wrapped = sb3.Sb3VecEnv(gym.wrappers.vector.RecordEpisodeStatistics(vector))
    assert wrapped.env_is_wrapped(gym.wrappers.vector.RecordEpisodeStatistics) == [True, True]
    wrapped.reset()
    infos = [wrapped.step(np.array([0, 1]))[3] for _ in range(3)]
    assert "episode" not in infos[1][0]
    assert [info["episode"]["l"] for info in infos[2]] == [3, 3]
    assert [info["episode"]["r"] for info in infos[2]] == [15.0, 3.0]


def test_other_autoreset_modes_are_refused(sb3):
    with pytest.raises(EnvOptionError, match="SameStep"):
        sb3.Sb3VecEnv(gym.make_vec(CIRCUIT2, num_envs=2))
