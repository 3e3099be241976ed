# SPDX-License-Identifier: BSD-3-Clause
"""In each of Gymnasium's autoreset modes a vector environment is its SyncVectorEnv over single environments."""

from __future__ import annotations

import gymnasium as gym
import numpy as np
import pytest
from gymnasium.error import ResetNeeded
from gymnasium.vector import AutoresetMode

from sitl.envs import PAPER, EnvOptionError
from sitl.envs.tasks import ReachGoal, Task
from tests.envs.vector_equality import same

CIRCUIT2 = "GazeboCircuit2TurtlebotLIDAR-v0"
ROVER, COPTER = "GazeboMazeErleRoverLIDAR-v0", "GazeboOfficeErleCopterLIDAR-v0"


class Told(Task):
    """Infos of all types of numbers."""

    def info(self, step):
        told = {"narrow": step.scan[:, 0], "count": np.arange(step.robot.count, dtype=np.int8)}
        return {**super().info(step), "places": step.pose[:, :2], **told}


CASES = {
    "digits": (CIRCUIT2, {"max_episode_steps": 40}),
    "noise": ("sitl/Navigate-v1", {"start": "random", "randomise": {"range_noise": (0.0, 0.05)}, "latency": 0.3}),
    "a dict, and a goal": ("sitl/Navigate-v1", {
        "world": "round", "action": "continuous", "observation": "scan+pose+goal", "task": ReachGoal((1.0, 2.0)),
        "start": "random", "max_episode_steps": 6,
    }),
    "rover": (ROVER, {"max_episode_steps": 3, "step_time": 0.2}),
    "copter": (COPTER, {"max_episode_steps": 3, "observation": "scan+pose", "setpoint": "velocity"}),
}  # fmt: skip


def both(name, mode, count=3, **options):
    """Our vector environment, and Gymnasium's over single ones."""
    ours = gym.make_vec(name, num_envs=count, autoreset_mode=mode, **options)
    theirs = gym.make_vec(
        name, num_envs=count, vectorization_mode="sync", vector_kwargs={"autoreset_mode": mode}, **options
    )
    return ours, theirs


def assert_same(got, expected):
    """What ``reset`` or ``step`` gave."""
    for a, b in zip(got, expected, strict=True):
        assert same(a, b), (a, b)


@pytest.mark.parametrize("mode", [*AutoresetMode, "SameStep"])
@pytest.mark.parametrize("case", CASES)
def test_it_is_the_sync_vector_environment(case, mode):
    name, options = CASES[case]
    ours, theirs = both(name, mode, **options)
    assert ours.metadata["autoreset_mode"] is theirs.metadata["autoreset_mode"] is AutoresetMode(mode)
    assert ours.observation_space == theirs.observation_space and ours.action_space == theirs.action_space
    ours.action_space.seed(3)
    assert_same(ours.reset(seed=4), theirs.reset(seed=4))
    ended = 0
    for _ in range(10 if name in (ROVER, COPTER) else 120):
        actions = ours.action_space.sample()
        got, expected = ours.step(actions), theirs.step(actions)
        assert_same(got, expected)
        over = got[2] | got[3]
        ended += over.sum()
        if AutoresetMode(mode) is AutoresetMode.DISABLED and over.any():
            assert_same(ours.reset(options={"reset_mask": over}), theirs.reset(options={"reset_mask": over}))
    assert ended > 3
    ours.close(), theirs.close()


@pytest.mark.parametrize("mode", AutoresetMode)
def test_infos_of_a_tasks_own_have_their_types(mode):
    ours, theirs = both("sitl/Navigate-v1", mode, task=Told(), max_episode_steps=3, count=2)
    assert_same(ours.reset(seed=1), theirs.reset(seed=1))
    for step in range(9):
        got, expected = ours.step(np.array([0, 1])), theirs.step(np.array([0, 1]))
        for infos in (got[4], got[4].get("final_info", {})):
            if "count" in infos:
                assert infos["count"].tolist() == [0, 1]
                infos["count"][:] = 0  # single environments count from 0 each
        assert_same(got, expected)
        if mode is AutoresetMode.DISABLED and step % 3 == 2:
            assert_same(ours.reset(), theirs.reset())


def test_the_last_observation_of_an_episode_is_kept():
    vector = gym.make_vec("sitl/Navigate-v1", num_envs=2, autoreset_mode="SameStep", max_episode_steps=2)
    first, _ = vector.reset(seed=1)
    middle, *_ = vector.step(np.array([0, 0]))
    fresh, _, _, truncated, infos = vector.step(np.array([0, 0]))
    assert truncated.all() and "crashed" not in infos
    assert np.array_equal(fresh, first)  # this world has one start, without noise
    for index in range(2):
        assert not np.array_equal(infos["final_obs"][index], middle[index])
        assert not np.array_equal(infos["final_obs"][index], fresh[index])
    assert infos["final_info"]["crashed"].tolist() == [False, False]


def test_without_autoreset_an_ended_episode_has_to_be_reset():
    vector = gym.make_vec(CIRCUIT2, num_envs=3, autoreset_mode=AutoresetMode.DISABLED, max_episode_steps=2)
    vector.reset(seed=1)
    vector.step(np.zeros(3, np.int64))
    vector.reset(options={"reset_mask": np.array([True, False, True])})
    assert vector.step(np.zeros(3, np.int64))[3].tolist() == [False, True, False]
    with pytest.raises(ResetNeeded, match=r"robots \[1\].*reset_mask"):
        vector.step(np.zeros(3, np.int64))
    vector.reset(options={"reset_mask": np.array([False, True, False])})
    assert vector.step(np.zeros(3, np.int64))[3].tolist() == [True, False, True]


def test_no_such_mode():
    with pytest.raises(EnvOptionError, match=r"autoreset_mode 'samestep'.*NextStep, SameStep, Disabled"):
        gym.make_vec(CIRCUIT2, num_envs=2, autoreset_mode="samestep")


def test_a_mask_without_a_robot_is_refused():
    vector = gym.make_vec(CIRCUIT2, num_envs=2)
    with pytest.raises(EnvOptionError, match="one robot at least"):
        vector.reset(options={"reset_mask": np.zeros(2, np.bool_)})


@pytest.mark.parametrize("mode", [None, "vector_entry_point", "sync", "async"])
@pytest.mark.parametrize("name", [*PAPER, "sitl/Navigate-v1"])
def test_every_way_to_make_a_vector_gives_the_same(name, mode):
    vector = gym.make_vec(name, num_envs=2, vectorization_mode=mode, max_episode_steps=2)
    reference = gym.vector.SyncVectorEnv([lambda: gym.make(name, max_episode_steps=2)] * 2)
    assert_same(vector.reset(seed=6), reference.reset(seed=6))
    for _ in range(4):
        assert_same(vector.step(np.array([0, 1])), reference.step(np.array([0, 1])))
    vector.close()
