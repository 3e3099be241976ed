# SPDX-License-Identifier: BSD-3-Clause
"""The vector environment gives what as many single ones give, through resets and time limits."""

from __future__ import annotations

import pickle

import gymnasium as gym
import numpy as np
import pytest
from gymnasium.error import InvalidAction, ResetNeeded

from sitl.envs import EnvOptionError
from sitl.envs.tasks import ReachGoal
from tests.envs.vector_equality import same

CIRCUIT2 = "GazeboCircuit2TurtlebotLIDAR-v0"
CASES = [
    (CIRCUIT2, {}),
    (
        "GazeboMazeTurtlebotLIDAR-v0",
        {"observation": "scan", "start": "random", "randomise": {"range_noise": (0.0, 0.05)}},
    ),
    ("sitl/Navigate-v1", {"world": "round", "action": "continuous", "observation": "scan+pose", "task": "goal"}),
]


@pytest.mark.parametrize(("name", "options"), CASES)
def test_vector_equals_singles(name, options):
    vector = gym.make_vec(name, num_envs=5, vectorization_mode="vector_entry_point", **options)
    singles = gym.make_vec(name, num_envs=5, vectorization_mode="sync", **options)
    assert vector.unwrapped.robot.count == 5
    assert vector.observation_space == singles.observation_space
    assert vector.action_space == singles.action_space
    vector.action_space.seed(2)
    assert same(vector.reset(seed=8)[0], singles.reset(seed=8)[0])
    ended = 0
    for _ in range(150):
        actions = vector.action_space.sample()
        got, expected = vector.step(actions), singles.step(actions)
        assert same(got[0], expected[0])
        for a, b in zip(got[1:4], expected[1:4]):
            assert same(a, b)
        assert got[4].keys() == expected[4].keys()
        for key in got[4]:
            assert np.array_equal(got[4][key], expected[4][key]), key
        ended += int(got[2].sum())
    assert ended > 0


def test_it_is_what_make_vec_gives():
    vector = gym.make_vec(CIRCUIT2, num_envs=3)
    assert type(vector.unwrapped).__name__ == "PresetNavigateVector"
    assert vector.metadata["autoreset_mode"] == gym.vector.AutoresetMode.NEXT_STEP
    assert vector.unwrapped.max_episode_steps == 1500


def test_episodes_are_truncated_and_begin_anew():
    vector = gym.make_vec(CIRCUIT2, num_envs=2, max_episode_steps=4)
    vector.reset(seed=0)
    truncated = [vector.step([1, 1])[3].tolist() for _ in range(10)]
    assert truncated == [[k in (3, 8)] * 2 for k in range(10)]


def test_some_robots_are_reset_and_the_others_go_on():
    vector = gym.make_vec("sitl/Navigate-v1", num_envs=3, randomise={"range_noise": (0.01, 0.02)})
    vector.reset(seed=0)
    before = vector.step([0, 0, 0])[0]
    after, _ = vector.reset(options={"reset_mask": np.array([False, True, False])})
    assert np.array_equal(after[[0, 2]], before[[0, 2]])
    assert vector.unwrapped.robot.time.tolist() == [0.6, 0.0, 0.6]
    with pytest.raises(EnvOptionError, match="reset_mask"):
        vector.reset(options={"reset_mask": [True]})


def test_seeds_one_by_one():
    vector = gym.make_vec("sitl/Navigate-v1", num_envs=2, start="random")
    a, _ = vector.reset(seed=[5, 5])
    assert np.array_equal(a[0], a[1])
    with pytest.raises(ValueError, match="3 seeds"):
        vector.reset(seed=[1, 2, 3])


def test_snapshot_and_pickle_go_on_bit_for_bit():
    vector = gym.make_vec("sitl/Navigate-v1", num_envs=3, start="random", randomise={"range_noise": (0.01, 0.02)})
    vector.reset(seed=0)
    vector.step([0, 1, 2])
    kept, copy = vector.unwrapped.snapshot(), pickle.loads(pickle.dumps(vector))
    first = vector.step([1, 1, 0])[0]
    assert np.array_equal(copy.step([1, 1, 0])[0], first)
    vector.unwrapped.restore(kept)
    assert np.array_equal(vector.step([1, 1, 0])[0], first)
    with pytest.raises(EnvOptionError, match="2 snapshots"):
        vector.unwrapped.restore(kept[:2])


@pytest.mark.parametrize("actions", [[0, 1], 3, [0, 1, 3], np.array([0.5, 0.0, 0.0]), [0, 1, None]])
def test_wrong_actions_are_refused(actions):
    vector = gym.make_vec(CIRCUIT2, num_envs=3)
    vector.reset(seed=0)
    with pytest.raises(InvalidAction):
        vector.step(actions)


def test_step_needs_a_reset():
    with pytest.raises(ResetNeeded):
        gym.make_vec(CIRCUIT2, num_envs=2).step([0, 0])


@pytest.mark.parametrize("options", [{"num_envs": 0}, {"num_envs": 2, "max_episode_steps": 0}])
def test_wrong_counts_are_refused(options):
    with pytest.raises(EnvOptionError, match=r"must be 1 or more"):
        gym.make_vec(CIRCUIT2, **options)


def test_goals_and_their_rewards_are_those_of_single_ones_to_the_last_bit():
    options = {"task": "goal", "start": "random", "max_episode_steps": 9}
    vector = gym.make_vec("sitl/Navigate-v1", num_envs=4, **options)
    singles = gym.vector.SyncVectorEnv([lambda: gym.make("sitl/Navigate-v1", **options) for _ in range(4)])
    vector.reset(seed=5), singles.reset(seed=5)
    for step in range(60):
        actions = np.arange(step, step + 4) % 3
        ours, theirs = vector.step(actions), singles.step(actions)
        for a, b in zip(ours[:4], theirs[:4]):
            assert np.array_equal(a, b), step


def test_snapshots_keep_who_has_ended_and_the_step_count():
    vector = gym.make_vec("GazeboCircuit2TurtlebotLIDAR-v0", num_envs=2, max_episode_steps=30).unwrapped
    vector.reset(seed=1)
    while not vector.step(np.array([0, 1]))[2].any():
        pass
    kept = vector.snapshot()
    first = [vector.step(np.array([0, 1]))[:4] for _ in range(30)]
    other = gym.make_vec("GazeboCircuit2TurtlebotLIDAR-v0", num_envs=2, max_episode_steps=30).unwrapped
    for again in (vector, other):  # the other was never reset
        again.restore(kept)
        for a in first:
            assert all(np.array_equal(x, y) for x, y in zip(a, again.step(np.array([0, 1]))[:4]))


def test_a_tasks_own_arrays_stay_as_they_are():
    class Told(ReachGoal):
        def info(self, step):
            return {"goal": self.goals}

    vector = gym.make_vec("sitl/Navigate-v1", num_envs=2, task=Told((1.0, 2.0)), max_episode_steps=1).unwrapped
    vector.reset(seed=1)
    vector.step(np.array([1, 1]))
    vector.step(np.array([1, 1]))
    assert vector._session.task.goals.tolist() == [[1.0, 2.0]] * 2
